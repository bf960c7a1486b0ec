// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/response_result.hpp"

#include "dsp/core/constants.hpp"
#include "tools/report/figures/response_figure.hpp"
#include "tools/report/vibration/record_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

namespace {

using analysis::ResponsePeak;
using analysis::TwoChannels;

std::string estimator_of(const TwoChannels& t) {
    constexpr const char* names[] = {"H1", "H2", "Hv"};
    return names[static_cast<int>(t.estimator)];
}

/// Fraction of the bins with a coherence of at least 0.9.
double coherent_fraction(const TwoChannels& t) {
    double coherent = 0.0, bins = 0.0;
    for (std::size_t k = 1; k < t.coherence.size() && t.spectra.frequency(k) <= t.usable; ++k) {
        coherent += t.coherence[k] >= 0.9;
        bins += 1.0;
    }
    return coherent / std::max(1.0, bins);
}

const Fields<ResponsePeak>& peak_fields() {
    static const Fields<ResponsePeak> all =
        Fields<ResponsePeak>("peak of a response")
            .number("hz", "frequency", fixed(2, "Hz"), &ResponsePeak::hz)
            .number("level_db", "level", fixed(2, "dB"),
                    [](const ResponsePeak& p) {
                        Number level = p.level_db;
                        level.uncertainty = p.deviation_db;
                        return level;
                    })
            .number("phase_deg", "phase", fixed(0, "°"), [](const ResponsePeak& p) { return p.phase * 180.0 / pi; })
            .number("coherence", "coherence", fixed(3), &ResponsePeak::coherence)
            .number("deviation_db", "", fixed(2, "dB"), &ResponsePeak::deviation_db)
            .number("width_bins", "", fixed(1),
                    [](const ResponsePeak& p) { return p.bins > 0.0 ? std::optional(p.bins) : std::nullopt; });
    return all;
}

/// The uncertainty of a level covers noise, not what segments do that are too short.
std::vector<std::string> smeared(const TwoChannels& t) {
    std::vector<std::string> texts;
    for (const ResponsePeak& p : t.peaks)
        if (p.is_smeared)
            texts.push_back(
                fmt::format("the peak at {:.2f} Hz is {:.1f} bins wide with a coherence of {:.3f}: its level may be "
                            "too low by more "
                            "than the stated uncertainty; choose a longer --segment than {}",
                            p.hz, p.bins, p.coherence, t.welch.segment));
    return texts;
}

const Fields<TwoChannels>& channels_fields() {
    using T = TwoChannels;
    static const Fields<T> all =
        Fields<T>("response between two channels")
            .warnings("warnings", smeared)
            .text("input", "input", &T::input)
            .text("output", "output", &T::output)
            .text("estimator", "estimator", estimator_of)
            .number("sample_rate_hz", "", prefixed(6, "Hz"), &T::rate)
            .number("duration_s", "", fixed(3, "s"), &T::duration)
            .number("usable_hz", "", significant(4, "Hz"), &T::usable)
            .part(record_fields(), record_of<T>)
            .integer("segment", "", [](const T& t) { return t.welch.segment; })
            .integer("segments", "segments", [](const T& t) { return t.spectra.segments; })
            .number("effective_segments", "", significant(4), [](const T& t) { return t.spectra.effective_segments; })
            .number("df_hz", "bin spacing", significant(4, "Hz"), [](const T& t) { return t.spectra.df; })
            .number("coherence_of_noise", "coherence of unrelated noise", fixed(3), &T::noise_coherence)
            .number("", "bins with a coherence of at least 0.9", fixed(0, "%", "1"), coherent_fraction)
            .number("delay_s", "", fixed(3, "ms", "s"), &T::delay)
            .number("", "delay (mean slope of the phase, with that of resonances)", fixed(3, "ms", "s"),
                    [](const T& t) { return coherent_fraction(t) > 0.0 ? std::optional(t.delay) : std::nullopt; })
            .text("", "phase",
                  [](const T&) { return "with the delay, here and in --csv; -o keeps the delay apart as latency_s"; })
            .rows("peaks", "peaks with a coherence of at least 0.8 at or beside them", peak_fields(),
                  [](const T& t) -> const auto& { return t.peaks; })
            .text("", "peaks", [](const T& t) {
                return t.peaks.empty() ? "none with a coherence of at least 0.8 at or beside it" : std::string();
            });
    return all;
}

}  // namespace

const Fields<FileResponse>& response_fields() {
    static const Fields<FileResponse> all =
        Fields<FileResponse>("response between two channels of a record")
            .titled([](const FileResponse& f) {
                return fmt::format("{}: from {} to {}, {}", f.file.string(), f.found->input, f.found->output,
                                   estimator_of(*f.found));
            })
            .text("file", "", [](const FileResponse& f) { return f.file.string(); })
            .figure(
                "level, phase and coherence", [](const FileResponse&) { return true; },
                [](const FileResponse& f, const FigureStyle& style) { return draw_response(*f.found, f.file, style); })
            .part(channels_fields(), [](const FileResponse& f) -> const TwoChannels& { return *f.found; });
    return all;
}

}  // namespace tactus::report
