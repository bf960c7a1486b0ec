// SPDX-License-Identifier: Apache-2.0
// Whether what the actuator plays is what the saw did.
#include "assets/sound/sound.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/headroom.hpp"
#include "tools/comparison_figure.hpp"
#include "tools/verbs.hpp"
#include "tools/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

struct LoadedTake {
    std::filesystem::path file;
    std::vector<float> samples;
    double rate = 0.0, peak = 0.0;
    std::vector<std::string> notes;
};

/// Share of the samples in runs of three or more that stand at the record's extremes: what a limiter leaves.
double clipped_share(const std::vector<float>& samples, double peak) {
    std::size_t clipped = 0, run = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool at_peak = std::abs(static_cast<double>(samples[i])) >= 0.99999 * peak;
        run = at_peak && i > 0 && samples[i] == samples[i - 1] ? run + 1 : at_peak ? 1 : 0;
        if (run >= 3) clipped += run == 3 ? 3 : 1;
    }
    return samples.empty() ? 0.0 : static_cast<double>(clipped) / static_cast<double>(samples.size());
}

LoadedTake load_take(const std::filesystem::path& file, const char* role, double scale, int channel) {
    if (!(scale > 0.0) || !std::isfinite(scale)) throw Error(fmt::format("the scale of the {} must be above 0", role));
    const Sound sound = load_sound(file);
    LoadedTake take{file, {}, static_cast<double>(sound.rate), 0.0, {}};
    if (channel == 0) take.samples = mix_to_mono(sound);
    else {
        if (channel > sound.channels)
            throw Error(
                fmt::format("{}: has {} channels; channel {} does not exist", file.string(), sound.channels, channel));
        const auto channels = static_cast<std::size_t>(sound.channels);
        for (std::size_t i = 0; i < sound.frames; ++i)
            take.samples.push_back(sound.samples[i * channels + static_cast<std::size_t>(channel) - 1]);
    }
    for (float& x : take.samples) {
        x = static_cast<float>(x * scale);
        take.peak = std::max(take.peak, std::abs(static_cast<double>(x)));
    }
    if (channel == 0 && sound.channels > 1)
        take.notes.push_back(fmt::format("the {} is the mean of {} channels", role, sound.channels));
    if (const double share = clipped_share(take.samples, take.peak); take.peak > 0.0 && share > 1e-4)
        take.notes.push_back(
            fmt::format("the {} is clipped: {:.2g} % of its samples stand at its peak", role, 100.0 * share));
    return take;
}

/// How much of the level stays missing, dB: of the reference's spectrum, what the actuator at its limit cannot reach;
/// without an actuator, what was missing as it was played.
double level_gap(const CompareChoice& choice, const Comparison& c, const LoadedTake& reference) {
    if (choice.actuator.empty()) return c.gain_db;
    const ActuatorModel& model = find_actuator(choice.actuator);
    const Actuator actuator(model, choice.mass, 48000.0);
    double square = 0.0;
    for (std::size_t k = 0; k < c.reference_density.size(); ++k) {
        const double f = static_cast<double>(k) * c.step;
        if (f < c.lowest || f > c.highest) continue;
        square += c.reference_density[k] * c.step / std::pow(actuator.gain(f), 2);
    }
    // As peaked as the reference itself.
    const double needed = std::sqrt(square) * reference.peak / c.reference_rms;
    const double limit = voltage_within(model.voltage_limit, model.current_limit, model.resistance);
    return std::max(0.0, 20.0 * std::log10(needed / limit));
}

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json lines_json(const std::vector<SpectralLine>& lines, double fundamental) {
    Json list = Json::array();
    for (const SpectralLine& line : lines) {
        Json entry{{"hz", line.frequency}, {"db", level_db(line)}, {"snr_db", line.snr_db}};
        if (const std::string name = name_of_line(line.frequency, fundamental); !name.empty()) entry["name"] = name;
        list.push_back(std::move(entry));
    }
    return list;
}

const char* touch_unit(ThresholdUnit unit) {
    return unit == ThresholdUnit::displacement   ? "displacement"
           : unit == ThresholdUnit::acceleration ? "acceleration"
                                                 : "none";
}

struct Outcome {
    LoadedTake reference, output;
    Comparison comparison;
    Verdict verdict;
    ThresholdUnit touch;
    double level_gap_db;
    std::vector<std::string> notes;
};

Json to_json(const Outcome& o, bool actuator_known) {
    const Comparison& c = o.comparison;
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
              {"failed", o.verdict.failed()},
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
              {"notes", o.notes}};
    for (const BandError& band : c.third_octaves)
        json["third_octave"].push_back({{"hz", band.hz}, {"error_db", band.error_db}});
    return json;
}

void print_lines(const char* what, const std::vector<SpectralLine>& lines, double fundamental) {
    if (lines.empty()) return;
    std::vector<std::string> names;
    for (const SpectralLine& line : lines) {
        const std::string name = name_of_line(line.frequency, fundamental);
        names.push_back(fmt::format("{:.1f} Hz{}", line.frequency, name.empty() ? "" : " (" + name + ")"));
        if (names.size() == 8 && lines.size() > 8) {
            names.push_back(fmt::format("and {} more", lines.size() - 8));
            break;
        }
    }
    fmt::print("  {:<18} {}\n", what, fmt::join(names, ", "));
}

void print(const Outcome& o, bool actuator_known) {
    const Comparison& c = o.comparison;
    fmt::print("{}: {} {} the vibration of {}{}\n", o.verdict.passed() ? "PASS" : "FAIL", o.output.file.string(),
               o.verdict.passed() ? "has" : "does not have", o.reference.file.string(),
               std::abs(c.gain_db) < 0.5
                   ? ""
                   : fmt::format(", {:.1f} dB {}", std::abs(c.gain_db), c.gain_db > 0.0 ? "softer" : "louder"));
    for (const bool passed : {false, true})
        for (const Judged& score : o.verdict.scores)
            if (score.passed == passed)
                fmt::print("  {} {:<24} {:>8.3f}  {} {:<6g} {}\n", passed ? "ok  " : "FAIL", score.name, score.value,
                           score.at_least ? "at least" : "at most ", score.limit, score.about);
    fmt::print("\n");
    if (c.alignment.significant)
        fmt::print("  one recording      the output is {:.3f} ms {}{}; ST-SIM {:.3f}, SPQI {:.3f}, coherence {:.3f}\n",
                   1e3 * std::abs(c.alignment.delay), c.alignment.delay < 0.0 ? "early" : "late",
                   c.alignment.correlation < 0.0 ? " and inverted" : "", *c.st_sim, *c.spqi, *c.coherence_mean);
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

}  // namespace

int compare_verb(const CompareChoice& choice) {
    const Thresholds thresholds = choice.thresholds.empty() ? Thresholds{} : load_thresholds(choice.thresholds);
    if (!choice.plot.empty() && !choice.plot.ends_with(".svg") && !choice.plot.ends_with(".png"))
        throw Error(choice.plot + ": a figure is written as .svg or .png");
    Outcome o;
    o.touch = choice.touch == "none"           ? ThresholdUnit::none
              : choice.touch == "acceleration" ? ThresholdUnit::acceleration
                                               : ThresholdUnit::displacement;
    o.reference = load_take(choice.reference, "reference", choice.reference_scale, choice.channel);
    o.output = load_take(choice.output, "output", choice.output_scale, choice.channel);
    try {
        o.comparison = compare({o.reference.samples, o.reference.rate}, {o.output.samples, o.output.rate},
                               {.touch = o.touch, .longest_delay = choice.longest_delay});
    } catch (const Error& error) {
        throw Error(fmt::format("{} and {}: {}", choice.reference.string(), choice.output.string(), error.message()));
    }
    for (const LoadedTake* take : {&o.reference, &o.output})
        o.notes.insert(o.notes.end(), take->notes.begin(), take->notes.end());
    if (o.reference.rate != o.output.rate)
        o.notes.push_back(fmt::format("sampled at {:g} and {:g} Hz", o.reference.rate, o.output.rate));
    if (o.comparison.highest < 1000.0)
        o.notes.push_back(fmt::format("the slower recording carries no more than {:.0f} Hz", o.comparison.highest));
    o.level_gap_db = level_gap(choice, o.comparison, o.reference);
    o.verdict = judge(o.comparison, o.level_gap_db, thresholds);
    if (!choice.plot.empty())
        write_figure(draw_comparison(o.comparison, o.verdict, thresholds, choice.reference.filename().string(),
                                     choice.output.filename().string()),
                     choice.plot);
    if (choice.json) fmt::print("{}\n", to_json(o, !choice.actuator.empty()).dump(2));
    else print(o, !choice.actuator.empty());
    return o.verdict.passed() ? done : answer_is_no;
}

}  // namespace tactus
