// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/comparison_text.hpp"

#include "assets/file/json.hpp"
#include "tools/command/vibration/stretch_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace tactus::command {

using analysis::ComparedPair;
using analysis::Judged;
using analysis::name_of_line;
using analysis::touch_unit;
using file::Json;

namespace {

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json lines_json(const std::vector<signal::SpectralLine>& lines, double fundamental) {
    Json list = Json::array();
    for (const signal::SpectralLine& line : lines) {
        // "db" is of the amplitude, as before; it goes with the next release.
        Json entry{{"hz", line.frequency},
                   {"rms", std::sqrt(line.power)},
                   {"rms_db", signal::rms_db(line)},
                   {"db", signal::level_db(line)},
                   {"snr_db", line.snr_db}};
        if (const std::string name = name_of_line(line.frequency, fundamental); !name.empty()) entry["name"] = name;
        list.push_back(std::move(entry));
    }
    return list;
}

Json to_json(const ComparedPair& o) {
    const bool actuator_known = o.actuator_known;
    const signal::Comparison& c = o.comparison;
    const bool aligned = c.alignment.significant;
    const double order_base = c.output_hz > 0.0 ? c.output_hz : c.reference_hz;
    Json json{{"alignment", aligned ? "correlation" : "none"},
              {"delay_s", aligned ? Json(c.alignment.delay) : Json()},
              {"gain_db", c.gain_db},
              {"lsd_db", c.lsd_db},
              {"cosine_40_500", c.cosine_500},
              {"cosine_40_1000", c.highest >= 999.0 ? Json(c.cosine_1000) : Json()},
              {"harmonic_error_db", or_null(c.harmonic_error_db)},
              {"third_octave", Json::array()},
              {"third_octave_max_db", c.third_octave_max_db},
              {"spectrogram_similarity", c.spectrogram_similarity},
              {"st_sim", or_null(c.st_sim)},
              {"spqi", or_null(c.spqi)},
              {"coherence_mean", or_null(c.coherence_mean)},
              {"only_in_reference", lines_json(c.lines.only_in_reference, c.reference_hz)},
              {"only_in_output", lines_json(c.lines.only_in_output, order_base)},
              {"level_gap_db", o.level_gap_db},
              {"verdict", o.verdict.passed() ? "pass" : "fail"},
              {"verdict_scope", o.verdict.words()},
              {"failed", o.verdict.failed()},
              {"course_db", or_null(c.course_db)},
              {"statistics",
               c.statistics ? Json{{"deviation", c.statistics->deviation}, {"worst", c.statistics->worst}} : Json()},
              {"kurtosis", {{"reference", c.reference_kurtosis}, {"output", c.output_kurtosis}}},
              {"power_in_band", {{"reference", c.reference_inside}, {"output", c.output_inside}}},
              {"not_judged", o.verdict.not_judged},
              {"in_both", lines_json(c.lines.in_both, c.reference_hz)},
              {"third_octave_rms_db", c.third_octave_rms_db},
              {"snr_db", or_null(c.signal_to_noise_db)},
              {"correlation", aligned ? Json(c.alignment.correlation) : Json()},
              {"fundamental_hz",
               {{"reference", c.reference_hz > 0.0 ? Json(c.reference_hz) : Json()},
                {"output", c.output_hz > 0.0 ? Json(c.output_hz) : Json()}}},
              {"speed_ratio", c.speed_ratio},
              {"level_gap_of", actuator_known ? "the actuator at its limit" : "the output as it was played"},
              {"touch",
               {{"threshold_of", touch_unit(o.touch)}, {"cosine_40_1000", c.touch_cosine}, {"gap_db", c.touch_gap_db}}},
              {"band_hz", {c.lowest, c.highest}},
              {"stretch", {{"reference", stretch_json(o.stretches[0])}, {"output", stretch_json(o.stretches[1])}}},
              {"rms", {{"reference", c.reference_rms}, {"output", c.output_rms}}},
              {"db_re", "1 of the record's unit, rms"},
              {"above_noise",
               {{"reference", c.above_noise.in_reference},
                {"output", c.above_noise.in_output},
                {"both_hz", c.above_noise.in_both}}},
              {"scores", Json::array()},
              {"notes", o.notes}};
    for (const Judged& score : o.verdict.scores)
        json["scores"].push_back({{"name", score.name},
                                  {"value", score.value},
                                  {score.at_least ? "at_least" : "at_most", score.limit},
                                  {"passed", score.passed},
                                  {"band_hz", {score.lowest, score.highest}}});
    for (const signal::BandError& band : c.third_octaves)
        json["third_octave"].push_back({{"hz", band.hz}, {"error_db", band.error_db}});
    return json;
}

void print_lines(const char* what, const std::vector<signal::SpectralLine>& lines, double fundamental) {
    if (lines.empty()) return;
    std::vector<std::string> names;
    for (const signal::SpectralLine& line : lines) {
        const std::string name = name_of_line(line.frequency, fundamental);
        names.push_back(fmt::format("{:.1f} Hz{}", line.frequency, name.empty() ? "" : " (" + name + ")"));
        if (names.size() == 8 && lines.size() > 8) {
            names.push_back(fmt::format("and {} more", lines.size() - 8));
            break;
        }
    }
    fmt::print("  {:<18} {}\n", what, fmt::join(names, ", "));
}

}  // namespace

void print(const ComparedPair& o) {
    const bool actuator_known = o.actuator_known;
    const signal::Comparison& c = o.comparison;
    fmt::print("{}: {} {} the vibration of {}{}\n", o.verdict.passed() ? "PASS" : "FAIL", o.output.string(),
               o.verdict.passed() ? "has" : "does not have", o.reference.string(),
               std::abs(c.gain_db) < 0.5
                   ? ""
                   : fmt::format(", {:.1f} dB {}", std::abs(c.gain_db), c.gain_db > 0.0 ? "softer" : "louder"));
    fmt::print("  {}\n", o.verdict.words());
    for (const bool passed : {false, true})
        for (const Judged& score : o.verdict.scores)
            if (score.passed == passed)
                fmt::print("  {} {:<24} {:>8.3f}  {} {:<6g} {}\n", passed ? "ok  " : "FAIL", score.name, score.value,
                           score.at_least ? "at least" : "at most ", score.limit, score.about);
    if (!o.verdict.not_judged.empty()) fmt::print("  not judged: {}\n", fmt::join(o.verdict.not_judged, ", "));
    fmt::print("\n");
    if (c.alignment.significant)
        fmt::print("  one recording      the output is {:.3f} ms {}{}; {}coherence {:.3f}\n",
                   1e3 * std::abs(c.alignment.delay), c.alignment.delay < 0.0 ? "early" : "late",
                   c.alignment.correlation < 0.0 ? " and inverted" : "",
                   c.st_sim ? fmt::format("ST-SIM {:.3f}, SPQI {:.3f}, ", *c.st_sim, *c.spqi) : "", *c.coherence_mean);
    else
        fmt::print(
            "  two recordings     nothing shows that they were made together: ST-SIM, SPQI and coherence do not "
            "apply\n");
    if (c.reference_hz > 0.0)
        fmt::print("  saw                {:.2f} Hz in the reference, {}{}\n", c.reference_hz,
                   c.output_hz > 0.0 ? fmt::format("{:.2f} Hz in the output", c.output_hz) : "not found in the output",
                   c.speed_ratio != 1.0 ? "; compared at equal orders" : "");
    fmt::print("  over time          spectrograms correlate by {:.3f}\n", c.spectrogram_similarity);
    fmt::print("  as touched         shape {:.3f}; feels {:.1f} dB {} at equal power (threshold of {})\n",
               c.touch_cosine, std::abs(c.touch_gap_db), c.touch_gap_db < 0.0 ? "weaker" : "stronger",
               touch_unit(o.touch));
    const char* lacks = actuator_known ? "the actuator at its limit lacks" : "the output as it was played lacks";
    if (o.level_gap_db > 0.0) fmt::print("  level              {} {:.1f} dB\n", lacks, o.level_gap_db);
    else
        fmt::print("  level              {}\n",
                   actuator_known ? "the actuator can reach it" : "the output lacks nothing");
    print_lines("in both", c.lines.in_both, c.reference_hz);
    print_lines("only in reference", c.lines.only_in_reference, c.reference_hz);
    print_lines("only in output", c.lines.only_in_output, c.output_hz > 0.0 ? c.output_hz : c.reference_hz);
    for (const std::string& note : o.notes) fmt::print("  note               {}\n", note);
}

std::string comparison_json(const ComparedPair& pair) { return to_json(pair).dump(2) + "\n"; }

}  // namespace tactus::command
