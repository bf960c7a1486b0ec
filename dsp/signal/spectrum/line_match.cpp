// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/line_match.hpp"

#include "dsp/signal/spectrum/above_noise.hpp"
#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/decibels.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr double deepest_db = 60.0, missing_db = 6.0, order_snr_db = 6.0, order_depth_db = 40.0;
constexpr int fewest_orders = 2, highest_order = 10;

double tolerance(const Spectrum& density, double hz) { return std::max(0.003 * hz, 2.0 * density.df); }

const SpectralLine* nearest(const std::vector<SpectralLine>& lines, double hz, double within) {
    const SpectralLine* best = nullptr;
    for (const SpectralLine& line : lines)
        if (std::abs(line.frequency - hz) <= within &&
            (!best || std::abs(line.frequency - hz) < std::abs(best->frequency - hz)))
            best = &line;
    return best;
}

/// Power of an order: within 1 % of its frequency, and at least three bins to each side.
double order_power(const Spectrum& density, double hz) {
    const double reach = std::max(0.01 * hz, 3.0 * density.df);
    return band_power(density, hz - reach, hz + reach);
}

/// Level of the spectrum around a frequency, taken as one line, dB of amplitude.
double level_near(const Spectrum& density, double hz) {
    const double within = tolerance(density, hz);
    return decibels(2.0 * band_power(density, hz - within, hz + within));
}

std::vector<SpectralLine> strong_lines(const Spectrum& density, double lowest, double highest) {
    std::vector<SpectralLine> lines = find_lines(density, lowest, highest);
    double strongest = 0.0;
    for (const SpectralLine& line : lines) strongest = std::max(strongest, line.power);
    std::erase_if(lines,
                  [&](const SpectralLine& line) { return line.power < strongest * std::pow(10.0, -0.1 * deepest_db); });
    return lines;
}

constexpr double stands_out_db = 6.0, relevant_db = 20.0;
constexpr std::size_t octave = 3;  // bands

double density_db(const Band& band) { return 10.0 * std::log10(std::max(band.power / (band.high - band.low), 1e-300)); }

}  // namespace

double level_db(const SpectralLine& line) { return decibels(2.0 * line.power); }
double rms_db(const SpectralLine& line) { return decibels(line.power); }

std::optional<double> harmonic_error(const Spectrum& reference, double reference_hz, const Spectrum& output,
                                     double output_hz, double highest) {
    if (!(reference_hz > 0.0 && output_hz > 0.0)) return std::nullopt;
    std::vector<double> levels, differences;
    double strongest = -300.0;
    for (int k = 1; k <= highest_order && k * reference_hz <= highest; ++k) {
        const SpectralLine line = line_near(reference, k * reference_hz, reference.df);
        if (!(line.power > 0.0)) break;
        levels.push_back(line.snr_db < order_snr_db ? -300.0 : decibels(order_power(reference, k * reference_hz)));
        strongest = std::max(strongest, levels.back());
    }
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (levels[i] > -300.0 && levels[i] >= strongest - order_depth_db)
            differences.push_back(decibels(order_power(output, static_cast<double>(i + 1) * output_hz)) - levels[i]);
    if (differences.size() < fewest_orders) return std::nullopt;
    double mean = 0.0, worst = 0.0;
    for (const double difference : differences) mean += difference / static_cast<double>(differences.size());
    for (const double difference : differences) worst = std::max(worst, std::abs(difference - mean));
    return worst;
}

MatchedLines match_lines(const Spectrum& reference, const Spectrum& output, double gain, double speed_ratio,
                         double lowest, double highest) {
    const std::vector<SpectralLine> r = strong_lines(reference, lowest, highest),
                                    d = strong_lines(output, lowest, highest);
    const double gain_db = 20.0 * std::log10(gain);
    MatchedLines matched;
    for (const SpectralLine& line : r) {
        const double within = tolerance(reference, line.frequency), moved = line.frequency * speed_ratio;
        if (nearest(d, line.frequency, within) || nearest(d, moved, within)) matched.in_both.push_back(line);
        else if (std::max(level_near(output, line.frequency), level_near(output, moved)) + gain_db <
                 level_db(line) - missing_db)
            matched.only_in_reference.push_back(line);
    }
    for (const SpectralLine& line : d) {
        const double within = tolerance(output, line.frequency), moved = line.frequency / speed_ratio;
        if (nearest(r, line.frequency, within) || nearest(r, moved, within)) continue;
        if (std::max(level_near(reference, line.frequency), level_near(reference, moved)) <
            level_db(line) + gain_db - missing_db)
            matched.only_in_output.push_back(line);
    }
    return matched;
}

std::vector<Band> bands_above_noise(const Spectrum& density, double lowest, double highest) {
    std::vector<Band> bands = third_octaves(density), standing;
    std::erase_if(bands, [&](const Band& band) { return band.low < 0.9 * lowest || band.high > 1.001 * highest; });
    if (bands.size() < 3) return standing;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const Band& below = bands[i < octave ? 0 : i - octave];
        const Band& above = bands[std::min(i + octave, bands.size() - 1)];
        // At the ends, one of the two is the band itself: the other decides alone.
        const bool first = i == 0, last = i + 1 == bands.size();
        const double around = first  ? density_db(above)
                              : last ? density_db(below)
                                     : 0.5 * (density_db(below) + density_db(above));
        if (density_db(bands[i]) >= around + stands_out_db) standing.push_back(bands[i]);
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
