// SPDX-License-Identifier: Apache-2.0
#include "tools/command/batch.hpp"
#include "tools/command/vibration/comparison_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tactus::command {

using analysis::ComparedPair;
using analysis::pair_name;

namespace {

const std::string& failure_of(const std::vector<std::string>& failures, std::size_t i) {
    static const std::string none;
    return i < failures.size() ? failures[i] : none;
}

}  // namespace

signal::ThresholdUnit touch_of(const std::string& name) {
    return name == "none"           ? signal::ThresholdUnit::none
           : name == "acceleration" ? signal::ThresholdUnit::acceleration
                                    : signal::ThresholdUnit::displacement;
}

std::string comparison_rows(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures) {
    std::size_t width = 6;
    for (const ComparedPair& pair : pairs) width = std::max(width, pair_name(pair, pairs).size());
    std::string out =
        fmt::format("{:<{}}  {:<7}  {:>6}  {:>7}  {:>6}  {:>7}  {:>7}  {:>5}  {:>5}  {}\n", "output", width, "verdict",
                    "LSD,dB", "cosine", "orders", "band,dB", "gain,dB", "added", "lost", "fails by");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const ComparedPair& pair = pairs[i];
        if (!failure_of(failures, i).empty()) {
            out += fmt::format("{:<{}}  unread\n", pair_name(pair, pairs), width);
            continue;
        }
        const signal::Comparison& c = pair.comparison;
        // A dash takes three bytes but one column.
        const std::string orders = c.harmonic_error_db ? fmt::format("{:>6.2f}", *c.harmonic_error_db) : "     –";
        out += fmt::format("{:<{}}  {:<7}  {:>6.2f}  {:>7.4f}  {}  {:>7.2f}  {:>+7.1f}  {:>5}  {:>5}  {}\n",
                           pair_name(pair, pairs), width, pair.verdict.passed() ? "pass" : "FAIL", c.lsd_db,
                           c.cosine_500, orders, c.third_octave_max_db, c.gain_db, pair.verdict.added.size(),
                           pair.verdict.missing.size(), fmt::join(pair.verdict.failed(), " "));
    }
    return out;
}

std::string comparison_table(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures) {
    std::string out =
        "reference,output,verdict,failed,alignment,delay_s,gain_db,lsd_db,cosine_40_500,cosine_40_1000,"
        "harmonic_error_db,third_octave_max_db,third_octave_rms_db,spectrogram_similarity,st_sim,spqi,coherence_mean,"
        "level_gap_db,reference_hz,output_hz,lines_added,lines_missing,error\n";
    const auto optional = [](const std::optional<double>& value) {
        return value ? fmt::format("{}", *value) : std::string();
    };
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const ComparedPair& pair = pairs[i];
        out += csv_field(pair.reference.string()) + "," + csv_field(pair.output.string()) + ",";
        if (const std::string& failure = failure_of(failures, i); !failure.empty()) {
            out += std::string(20, ',') + csv_field(failure) + "\n";
            continue;
        }
        const signal::Comparison& c = pair.comparison;
        const bool aligned = c.alignment.significant;
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},\n",
                           pair.verdict.passed() ? "pass" : "fail", fmt::join(pair.verdict.failed(), " "),
                           aligned ? "correlation" : "none", aligned ? fmt::format("{}", c.alignment.delay) : "",
                           c.gain_db, c.lsd_db, c.cosine_500, c.cosine_1000, optional(c.harmonic_error_db),
                           c.third_octave_max_db, c.third_octave_rms_db, c.spectrogram_similarity, optional(c.st_sim),
                           optional(c.spqi), optional(c.coherence_mean), pair.level_gap_db, c.reference_hz, c.output_hz,
                           pair.verdict.added.size(), pair.verdict.missing.size());
    }
    return out;
}

}  // namespace tactus::command
