// SPDX-License-Identifier: Apache-2.0
// A sweep through a patch or a sound card, and what it tells of what it went through.
#include "assets/response/response_file.hpp"
#include "assets/sound/sound.hpp"
#include "devices/audio/duplex.hpp"
#include "engine/engine.hpp"
#include "graph/patch_measure.hpp"
#include "graph/sub_patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/session/scratch_folder.hpp"
#include "tools/session/summary.hpp"
#include "tools/command/terminal.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

/// What came back of the sweep, and from where.
struct Answer {
    std::vector<float> samples;
    double rate = 48000.0;
    std::string title, unit;
    std::optional<Captured> card;
};

SweepRun sweep_of(const MeasureChoice& choice) {
    SweepRun run;
    run.sweep = {choice.first, choice.last, choice.duration, std::min(0.02, 0.1 * choice.duration)};
    run.amplitude = choice.amplitude;
    run.pause = choice.pause;
    run.repeats = choice.repeats;
    return run;
}

Answer through_patch(const MeasureChoice& choice) {
    if (choice.in.empty() || choice.out_port.empty())
        throw Error(
            "say what to measure: --in NODE.PORT --out NODE.PORT, as in --in actuator.drive "
            "--out actuator.signal");
    Problems problems;
    Patch patch = load_patch(find_patch(choice.patch), problems);
    apply_overrides(patch, choice.overrides, problems);
    flatten(patch, problems);
    throw_problems(problems);
    if (choice.seed) patch.seed = *choice.seed;
    const auto setting = [](const char* name, double value, const char* unit) {
        return OptionText{name, fmt::format("{}{}{}", value, *unit ? " " : "", unit), {"--" + std::string(name), 0, 0}};
    };
    const MeasuredPath path{choice.in,
                            choice.out_port,
                            {setting("first", choice.first, "Hz"), setting("last", choice.last, "Hz"),
                             setting("duration", choice.duration, "s"), setting("pause", choice.pause, "s"),
                             setting("repeats", choice.repeats, ""), setting("amplitude", choice.amplitude, "")}};
    const MeasuredPatch measured = measured_patch(patch, path, catalogue());
    std::optional<Plan> plan = compile(measured.patch, catalogue(), problems);
    throw_problems(problems);
    AssetCache assets;
    assets.load(*plan, problems);
    throw_problems(problems);

    const ScratchFolder folder;
    EngineOptions options;
    options.seconds = choice.repeats * (choice.duration + choice.pause);
    options.folder = folder.path();
    Engine engine(std::move(*plan), options);
    LiveLine line;
    engine.render(1, [&](double done) { line.show(fmt::format("{:3.0f} % of the sweep", 100.0 * done)); });
    engine.finish();
    const Sound sound = load_sound(folder.path() / measured.file);
    std::string unit = measured.out_unit;
    if (!unit.empty() && !measured.in_unit.empty()) unit += " per " + measured.in_unit;
    return {
        sound.samples, static_cast<double>(sound.rate),
        fmt::format("{}: {} to {}", std::filesystem::path(choice.patch).stem().string(), choice.in, choice.out_port),
        unit, std::nullopt};
}

Answer through_card(const MeasureChoice& choice, const SweepRun& run) {
    if (!(std::abs(run.amplitude) <= 1.0))
        throw Error("the amplitude of a sweep through a sound card must lie within full scale, 1");
    const auto period = static_cast<std::size_t>(std::llround((run.sweep.duration + run.pause) * choice.rate));
    // A card may connect a moment after it has started: silence first, taken off again from what came back.
    const auto lead = static_cast<std::size_t>(std::llround(0.25 * choice.rate));
    std::vector<float> samples(lead + period * static_cast<std::size_t>(run.repeats));
    for (std::size_t i = lead; i < samples.size(); ++i)
        samples[i] =
            static_cast<float>(run.amplitude * run.sweep(static_cast<double>((i - lead) % period) / choice.rate));
    LiveLine line;
    Captured captured =
        play_and_capture({choice.device == "default" ? "" : choice.device, choice.rate, choice.output_channel - 1,
                          choice.input_channel - 1},
                         samples, [&](double done) { line.show(fmt::format("{:3.0f} % of the sweep", 100.0 * done)); });
    Answer answer{{captured.samples.begin() + static_cast<std::ptrdiff_t>(lead), captured.samples.end()},
                  choice.rate,
                  "sound card " + captured.device,
                  "",
                  std::nullopt};
    answer.card = std::move(captured);
    return answer;
}

/// rms over the exciting frequencies, and the worst, of one order.
struct OrderSummary {
    int order = 2;
    double rms = 0.0, worst = 0.0, worst_hz = 0.0;
};

std::vector<OrderSummary> summarise(const Identified& identified, double lowest, double highest) {
    std::vector<OrderSummary> summaries;
    for (const Distortion& distortion : identified.distortions) {
        OrderSummary summary{distortion.order};
        double count = 0.0, square = 0.0;
        for (std::size_t i = 0; i < distortion.ratio.size(); ++i) {
            const double hz = identified.response.hz[i], ratio = distortion.ratio[i];
            if (hz < lowest || hz > highest || !std::isfinite(ratio)) continue;
            square += ratio * ratio;
            count += 1.0;
            if (ratio > summary.worst) summary.worst = ratio, summary.worst_hz = hz;
        }
        summary.rms = count > 0.0 ? std::sqrt(square / count) : 0.0;
        summaries.push_back(summary);
    }
    return summaries;
}

double mean_coherence(const FrequencyResponse& response, double lowest, double highest) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < response.hz.size(); ++i)
        if (response.hz[i] >= lowest && response.hz[i] <= highest) sum += response.coherence[i], count += 1.0;
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

int measure_verb(const MeasureChoice& choice) {
    if (choice.patch.empty() == choice.device.empty())
        throw Error("measure takes a patch with --in and --out, or --device for a sound card");
    const SweepRun run = sweep_of(choice);
    const Answer answer = choice.device.empty() ? through_patch(choice) : through_card(choice, run);
    const ResponseFile file{answer.title, answer.unit, identify(run, answer.samples, answer.rate)};
    const FrequencyResponse& response = file.identified.response;
    const double lowest = std::max(2.0 * choice.first, response.hz.front());
    const double highest = std::min(0.5 * choice.last, response.hz.back());
    const double fit_highest = std::min(choice.fit_highest, response.hz.back());
    const Resonance resonance = fit_resonance(response, std::max(choice.fit_lowest, response.hz.front()), fit_highest);
    const std::vector<OrderSummary> orders = summarise(file.identified, lowest, highest);
    const double coherence = mean_coherence(response, lowest, highest);
    save_response(file, choice.csv);

    constexpr const char* kinds[] = {"displacement", "velocity", "acceleration"};
    if (choice.json) {
        const auto found = [&](const auto& value) { return resonance.hz > 0.0 ? Json(value) : Json(); };
        Json json{{"resonance_hz", found(resonance.hz)},
                  {"damping_ratio", found(resonance.damping)},
                  {"latency_s", response.latency},
                  {"response_csv", choice.csv.string()},
                  {"thd", Json::array()},
                  {"fit", {{"kind", found(kinds[resonance.order])}, {"error_db", found(resonance.error_db)}}},
                  {"coherence_mean", coherence},
                  {"band_hz", {lowest, highest}},
                  {"unit", answer.unit}};
        for (const OrderSummary& order : orders)
            json["thd"].push_back({{"order", order.order},
                                   {"percent", 100.0 * order.rms},
                                   {"worst_percent", 100.0 * order.worst},
                                   {"worst_hz", order.worst_hz}});
        if (answer.card)
            json["device"] = {{"name", answer.card->device},
                              {"output_latency_s", answer.card->output_latency},
                              {"input_latency_s", answer.card->input_latency},
                              {"underflows", answer.card->underflows}};
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print("{}\n", answer.title);
    if (!(resonance.hz > 0.0))
        fmt::print("  resonance   none from {:.0f} to {:.0f} Hz\n", choice.fit_lowest, fit_highest);
    else
        fmt::print("  resonance   {:.1f} Hz, damping ratio {:.3f} ({} response, fit within {:.2f} dB)\n", resonance.hz,
                   resonance.damping, kinds[resonance.order], resonance.error_db);
    fmt::print("  latency     {:.3f} ms\n", 1e3 * response.latency);
    fmt::print("  coherence   {:.4f} on average from {:.0f} to {:.0f} Hz\n", coherence, lowest, highest);
    for (const OrderSummary& order : orders)
        fmt::print("  order {}     {:.3f} % (rms), worst {:.3f} % at {:.0f} Hz\n", order.order, 100.0 * order.rms,
                   100.0 * order.worst, order.worst_hz);
    if (answer.card)
        fmt::print("  sound card  reports {:.3f} ms out and {:.3f} ms in; lost sound {} times\n",
                   1e3 * answer.card->output_latency, 1e3 * answer.card->input_latency, answer.card->underflows);
    fmt::print("  response    {}\n", choice.csv.string());
    return done;
}

}  // namespace tactus
