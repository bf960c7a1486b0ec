// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/above_noise.hpp"

#include "dsp/signal/spectrum/bands.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr double stands_out_db = 6.0, relevant_db = 20.0;
constexpr std::size_t octave = 3;  // bands

double level(const Band& band) { return 10.0 * std::log10(std::max(band.power / (band.high - band.low), 1e-300)); }

}  // namespace

std::vector<Band> bands_above_noise(const Spectrum& density, double lowest, double highest) {
    std::vector<Band> bands = third_octaves(density), standing;
    std::erase_if(bands, [&](const Band& band) { return band.low < 0.9 * lowest || band.high > 1.001 * highest; });
    if (bands.size() < 3) return standing;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const Band& below = bands[i < octave ? 0 : i - octave];
        const Band& above = bands[std::min(i + octave, bands.size() - 1)];
        // At the ends, one of the two is the band itself: the other decides alone.
        const bool first = i == 0, last = i + 1 == bands.size();
        const double around = first ? level(above) : last ? level(below) : 0.5 * (level(below) + level(above));
        if (level(bands[i]) >= around + stands_out_db) standing.push_back(bands[i]);
    }
    return standing;
}

AboveNoise above_noise(const Spectrum& reference, const Spectrum& output, const MatchedLines& lines, double lowest,
                       double highest) {
    const std::vector<Band> r = bands_above_noise(reference, lowest, highest),
                            d = bands_above_noise(output, lowest, highest);
    AboveNoise out;
    out.in_reference = r.size() + lines.in_both.size() + lines.only_in_reference.size();
    out.in_output = d.size() + lines.in_both.size() + lines.only_in_output.size();
    double strongest = 0.0;
    for (const Band& band : r) strongest = std::max(strongest, band.power);
    for (const auto* list : {&lines.in_both, &lines.only_in_reference})
        for (const SpectralLine& line : *list) strongest = std::max(strongest, line.power);
    const double least = strongest * std::pow(10.0, -0.1 * relevant_db);
    for (const SpectralLine& line : lines.in_both)
        if (line.power >= least) out.in_both.push_back(line.frequency);
    for (const Band& band : r)
        if (band.power >= least &&
            std::ranges::any_of(d, [&](const Band& other) { return other.centre == band.centre; }))
            out.in_both.push_back(band.centre);
    std::ranges::sort(out.in_both);
    return out;
}

}  // namespace tactus::signal
