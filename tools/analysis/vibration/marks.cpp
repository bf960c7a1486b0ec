// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/marks.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace tactus::analysis {

namespace {

double frequency_of(const std::string& text) {
    const Quantity quantity = parse_quantity(text);
    return quantity.dimension.is_bare() ? quantity.value : parse_as(text, "Hz");
}

}  // namespace

Mark parse_mark(const std::string& text) {
    const auto fail = [&](const std::string& why) -> Error {
        return Error(
            fmt::format("--mark takes FREQUENCY:LABEL or FREQUENCY:LABEL:HARMONICS, as in 118.9:BPFI or \"118.9 "
                        "Hz:BPFI:5\", not '{}': {}",
                        text, why));
    };
    Mark mark;
    const std::size_t first = text.find(':');
    if (first == std::string::npos) throw fail("the label is missing");
    try {
        mark.frequency = frequency_of(text.substr(0, first));
    } catch (const Error& error) {
        throw fail(error.message());
    }
    if (!(mark.frequency > 0.0)) throw fail("the frequency must be above 0 Hz");
    mark.label = text.substr(first + 1);
    if (const std::size_t second = mark.label.find(':'); second != std::string::npos) {
        const std::string count = mark.label.substr(second + 1);
        mark.label.resize(second);
        const auto [end, failure] = std::from_chars(count.data(), count.data() + count.size(), mark.harmonics);
        if (failure != std::errc{} || end != count.data() + count.size() || mark.harmonics < 1 ||
            mark.harmonics > Mark::max_harmonics)
            throw fail(fmt::format("the number of harmonics must be 1 to {}", Mark::max_harmonics));
    }
    if (mark.label.empty()) throw fail("the label is missing");
    return mark;
}

std::string MarkPlace::name() const { return harmonic == 1 ? label : fmt::format("{} ×{}", label, harmonic); }

std::vector<MarkPlace> places_of(std::span<const Mark> marks) {
    std::vector<MarkPlace> places;
    for (const Mark& mark : marks)
        for (int k = 1; k <= mark.harmonics; ++k) places.push_back({mark.label, k, k * mark.frequency});
    return places;
}

std::vector<MarkLevel> levels_at(const signal::Spectrum& spectrum, std::span<const MarkPlace> places) {
    std::vector<MarkLevel> levels;
    if (places.empty() || spectrum.power.size() < 8) return levels;
    const double end = spectrum.frequency(spectrum.power.size() - 1);
    const std::vector<signal::SpectralLine> lines = signal::find_lines(spectrum, 2.0 * spectrum.df, end, 0.0);
    const double threshold = signal::detection_threshold_db(spectrum);
    for (const MarkPlace& place : places) {
        MarkLevel level{place, 1.5 * spectrum.df, {}, false, {}};
        if (place.frequency + level.within > end || place.frequency < 2.0 * spectrum.df) continue;
        level.line = signal::line_near(spectrum, place.frequency, level.within);
        const auto bin = static_cast<std::size_t>(level.line.frequency / spectrum.df);  // or the next one
        level.is_line =
            (signal::is_top(spectrum, bin) || signal::is_top(spectrum, bin + 1)) && level.line.snr_db >= threshold;
        double distance = std::numeric_limits<double>::infinity();
        for (const signal::SpectralLine& line : lines)
            if (const double away = std::abs(line.frequency - place.frequency); away < distance) {
                distance = away;
                level.nearest = line;
            }
        levels.push_back(level);
    }
    return levels;
}

}  // namespace tactus::analysis
