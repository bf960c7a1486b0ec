// SPDX-License-Identifier: Apache-2.0
#include "tools/command/batch.hpp"
#include "tools/command/vibration/validation_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tactus::command {

using analysis::Validation;
using analysis::ValidationRun;

namespace {

std::string shown(const std::optional<double>& value, const char* format) {
    return value ? fmt::format(fmt::runtime(format), *value) : std::string();
}

}  // namespace

std::string validation_rows(const Validation& validation) {
    std::string out = fmt::format(
        "{:<8}  {:>6}  {:>5}  {:>5}  {:>7}  {:>7}  {:<7}  {:>6}  {:>7}  {:>6}  {:>7}  {:>9}  {}\n", "state", "Hz", "N",
        "dB", "drive,V", "peak,V", "verdict", "LSD,dB", "cosine", "orders", "band,dB", "softer,dB", "fails by");
    for (const ValidationRun& run : validation.runs) {
        out += fmt::format("{:<8}  {:>6.4g}  {:>5}  {:>+5g}  {:>7}  {:>7}  ",
                           run.recording->cutting ? "cutting" : "free air", run.recording->rate,
                           run.recording->cutting ? fmt::format("{:g}", run.recording->load) : "", run.level_db,
                           shown(run.drive_rms, "{:.3f}"), shown(run.drive_peak, "{:.3f}"));
        if (!run.failure.empty()) {
            out += "not compared\n";
            continue;
        }
        const signal::Comparison& c = run.pair.comparison;
        out += fmt::format("{:<7}  {:>6.2f}  {:>7.4f}  {:>6}  {:>7.2f}  {:>9.1f}  {}\n",
                           run.pair.verdict.passed() ? "pass" : "FAIL", c.lsd_db, c.cosine_500,
                           shown(c.harmonic_error_db, "{:.2f}"), c.third_octave_max_db, c.gain_db,
                           fmt::join(run.pair.verdict.failed(), " "));
    }
    return out;
}

std::string validation_csv(const Validation& validation) {
    std::string out =
        "file,state,rate_hz,load_N,level_db,drive_rms_v,drive_peak_v,verdict,failed,lsd_db,cosine_40_500,"
        "cosine_40_1000,harmonic_error_db,third_octave_max_db,spectrogram_similarity,st_sim,spqi,coherence_mean,"
        "gain_db,lines_added,lines_missing,error\n";
    for (const ValidationRun& run : validation.runs) {
        const sound::Recording& r = *run.recording;
        out += fmt::format("{},{},{},{},{},{},{},", csv_field(r.file.string()), r.cutting ? "cutting" : "free_air",
                           r.rate, r.load, run.level_db, shown(run.drive_rms, "{}"), shown(run.drive_peak, "{}"));
        if (!run.failure.empty()) {
            out += std::string(14, ',') + csv_field(run.failure) + "\n";
            continue;
        }
        const signal::Comparison& c = run.pair.comparison;
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},\n", run.pair.verdict.passed() ? "pass" : "fail",
                           fmt::join(run.pair.verdict.failed(), " "), c.lsd_db, c.cosine_500, c.cosine_1000,
                           shown(c.harmonic_error_db, "{}"), c.third_octave_max_db, c.spectrogram_similarity,
                           shown(c.st_sim, "{}"), shown(c.spqi, "{}"), shown(c.coherence_mean, "{}"), c.gain_db,
                           run.pair.verdict.added.size(), run.pair.verdict.missing.size());
    }
    return out;
}

}  // namespace tactus::command
