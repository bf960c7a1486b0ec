// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

constexpr double coherent = 0.5;
constexpr double max_course_db = 3.0;  // rms of the level difference over time of what are copies

constexpr double line_deviation = 0.05;  // Hz, standard deviation of the frequency of a line

/// Order of a fundamental; 0: none.
int order_of(double hz, double fundamental_hz) {
    const double order = std::round(hz / fundamental_hz);
    return order >= 1.0 && std::abs(hz - order * fundamental_hz) < std::max(0.003 * hz, 1.0) ? static_cast<int>(order)
                                                                                             : 0;
}

std::vector<signal::SpectralLine> stronger_than(const std::vector<signal::SpectralLine>& lines, double min_db) {
    std::vector<signal::SpectralLine> out;
    for (const signal::SpectralLine& line : lines)
        if (signal::level_db(line) >= min_db) out.push_back(line);
    return out;
}

}  // namespace

bool Verdict::passed() const { return failed().empty(); }

std::vector<std::string> Verdict::failed() const {
    std::vector<std::string> names;
    for (const Judged& score : scores)
        if (!score.passed) names.push_back(score.name);
    return names;
}

bool Verdict::is_judged() const { return failed() != std::vector<std::string>{"above_noise"}; }

std::string Verdict::words() const {
    const std::string band = fmt::format("{:.0f} to {:.0f} Hz", lowest, highest);
    if (!is_judged()) return fmt::format("Cannot be judged, {}: no line or band stands above the noise of both", band);
    if (!passed()) return fmt::format("Not the same vibration, {}", band);
    if (time.empty()) return fmt::format("Same mean spectrum, {}; time is not judged", band);
    return fmt::format("Same mean spectrum and {}, {}{}", time, band,
                       time == "statistics" ? "; order in time is not judged" : "");
}

Verdict judge(const signal::Comparison& c, double level_gap_db, const table::Thresholds& limits) {
    Verdict verdict;
    const auto add = [&](const char* name, std::optional<double> value, const std::optional<double>& limit,
                         bool at_least, const char* about, double highest) {
        if (!limit) return;
        if (!value || !std::isfinite(*value)) {
            verdict.not_judged.emplace_back(name);
            return;
        }
        verdict.scores.push_back({name, *value, *limit, at_least, at_least ? *value >= *limit : *value <= *limit,
                                  fmt::format("{}, {:.0f} to {:.0f} Hz", about, c.lowest, highest), c.lowest, highest});
    };
    const double touched = c.touched(), high = c.highest;
    // Two takes of one event share more than noise.
    const double shared = c.alignment.significant && c.coherence_mean.value_or(0.0) > coherent
                              ? std::max(1.0, static_cast<double>(c.above_noise.in_both.size()))
                              : static_cast<double>(c.above_noise.in_both.size());
    add("above_noise", shared, 1.0, true, "lines or bands above the noise in both", high);
    add("lsd_db", c.lsd_db, limits.lsd_db, false, "rms of the level difference, dB", touched);
    add("cosine_40_500", c.cosine_500, limits.cosine_40_500, true, "shape of the spectrum", touched);
    add("cosine_40_1000", high > touched ? std::optional(c.cosine_1000) : std::nullopt, limits.cosine_40_1000, true,
        "shape of the spectrum", high);
    add("harmonic_error_db", c.harmonic_error_db, limits.harmonic_error_db, false, "worst order of the saw, dB", high);
    add("third_octave_max_db", c.third_octave_max_db, limits.third_octave_max_db, false, "worst third-octave band, dB",
        high);
    add("spectrogram_similarity", c.spectrogram_similarity, limits.spectrogram_similarity, true,
        "correlation of the spectrograms", high);
    add("st_sim", c.st_sim, limits.st_sim, true, "ST-SIM", high);
    add("spqi", c.spqi, limits.spqi, true, "SPQI", high);
    add("coherence_mean", c.coherence_mean, limits.coherence_mean, true, "coherence", high);
    verdict.lowest = c.lowest;
    verdict.highest = high;
    if (c.course_db) {
        add("course_db", c.course_db, max_course_db, false, "rms of the level difference over time, dB", high);
        verdict.time = "course over time";
    } else if (c.statistics) {
        add("statistics", c.statistics->deviation, 1.0, false,
            fmt::format("worst statistic over time ({}), in units of its tolerance", c.statistics->worst).c_str(),
            high);
        verdict.time = "statistics";
    }
    add("level_gap_db", level_gap_db, limits.level_gap_db, false, "softer than the reference, dB", high);

    double strongest = -1e9;
    for (const auto* lines : {&c.lines.in_both, &c.lines.only_in_reference})
        for (const signal::SpectralLine& line : *lines) strongest = std::max(strongest, signal::level_db(line));
    // Without a line in the reference, its total power is the reference level.
    if (strongest < -1e8) strongest = 20.0 * std::log10(std::sqrt(2.0) * c.reference_rms);
    if (limits.added_line_db) {
        verdict.added = stronger_than(c.lines.only_in_output, strongest + *limits.added_line_db - c.gain_db);
        add("only_in_output", static_cast<double>(verdict.added.size()), 0.0, false, "lines that the output adds",
            high);
    }
    if (limits.missing_line_db) {
        verdict.missing = stronger_than(c.lines.only_in_reference, strongest + *limits.missing_line_db);
        add("only_in_reference", static_cast<double>(verdict.missing.size()), 0.0, false, "lines missing in the output",
            high);
    }
    return verdict;
}

std::string uncertain_order(int order, double hz) {
    return fmt::format("order {} of {:.4g} Hz, or mains hum", order, hz);
}

std::optional<signal::MainsComb> mains_of(std::span<const signal::SpectralLine> lines, double fundamental_hz) {
    std::vector<signal::MainsLine> others;
    for (const signal::SpectralLine& line : lines)
        if (!(fundamental_hz > 0.0) || order_of(line.frequency, fundamental_hz) == 0)
            others.push_back({line.frequency, line_deviation, line.power});
    std::ranges::sort(others, {}, &signal::MainsLine::frequency);
    std::optional<signal::MainsComb> found;
    for (const int nominal : signal::mains_frequencies)
        if (const auto mains = signal::fit_mains(others, nominal); mains && (!found || mains->lines > found->lines))
            found = mains;
    return found;
}

std::string RecordRates::name_of(double hz) const {
    if (fundamental_hz > 0.0)
        if (const int order = order_of(hz, fundamental_hz); order > 0) return fmt::format("order {}", order);
    if (hum_hz > 0.0)
        if (const int order = order_of(hz, hum_hz); order > 0) return uncertain_order(order, hum_hz);
    const int order = mains ? mains->order_of(hz, line_deviation) : 0;
    if (order == 0) return "";
    if (!(fundamental_hz > 0.0)) return uncertain_order(order, mains->nominal);
    return order == 1 ? fmt::format("mains hum, {} Hz", mains->nominal)
                      : fmt::format("mains hum, {} × {} Hz", order, mains->nominal);
}

LineNames::LineNames(const signal::Comparison& c)
    : reference_{c.reference_hz, c.reference_hum_hz, {}},
      output_{c.output_hz > 0.0 || c.output_hum_hz > 0.0 ? c.output_hz : c.reference_hz, c.output_hum_hz, {}} {
    const auto set_mains = [&](RecordRates& rates, const std::vector<signal::SpectralLine>& own) {
        std::vector<signal::SpectralLine> all = c.lines.in_both;
        all.insert(all.end(), own.begin(), own.end());
        rates.mains = mains_of(all, rates.fundamental_hz);
    };
    set_mains(reference_, c.lines.only_in_reference);
    set_mains(output_, c.lines.only_in_output);
}

}  // namespace tactus::analysis
