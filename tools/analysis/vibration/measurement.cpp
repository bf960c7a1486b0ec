// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/measurement.hpp"

#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/engine.hpp"
#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/analysis/patch_measure.hpp"
#include "tools/analysis/vibration/card_channels.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

/// The recorded response to the sweep, and its source.
struct Answer {
    std::vector<float> samples;
    double rate = 48000.0;
    std::string title, unit;
    std::optional<audio::Captured> card;
    std::size_t clipped = 0;
};

vibration::SweepRun sweep_of(const MeasureSettings& settings) {
    vibration::SweepRun run;
    run.sweep = {settings.first, settings.last, settings.duration, std::min(0.02, 0.1 * settings.duration)};
    run.amplitude = settings.amplitude;
    run.pause = settings.pause;
    run.repeats = settings.repeats;
    return run;
}

patch::Patch flat_patch(const MeasureSettings& settings) {
    patch::Problems problems;
    patch::Patch patch = patch::load_patch(run::find_patch(settings.patch.patch), problems);
    patch::apply_overrides(patch, settings.patch.overrides, problems);
    patch::flatten(patch, problems);
    run::throw_problems(problems);
    return patch;
}

Answer through_patch(const MeasureSettings& settings, const Progress& progress) {
    if (settings.in.empty() || settings.out_port.empty())
        throw Error(
            "name the ports: --in NODE.PORT --probe NODE.PORT, as in --in actuator.drive --probe actuator.signal; or "
            "an "
            "actuator and a sensor of the patch: --actuator NAME --sensor NAME");
    patch::Problems problems;
    patch::Patch patch = flat_patch(settings);
    if (settings.patch.seed) patch.seed = *settings.patch.seed;
    const auto setting = [](const char* name, double value, const char* unit) {
        return OptionText{name, fmt::format("{}{}{}", value, *unit ? " " : "", unit), {"--" + std::string(name), 0, 0}};
    };
    const MeasuredPath path{settings.in,
                            settings.out_port,
                            {setting("first", settings.first, "Hz"), setting("last", settings.last, "Hz"),
                             setting("duration", settings.duration, "s"), setting("pause", settings.pause, "s"),
                             setting("repeats", settings.repeats, ""), setting("amplitude", settings.amplitude, "")}};
    const MeasuredPatch measured = measured_patch(patch, path, nodes::catalogue());
    std::optional<compile::Schedule> plan = compile::compile(measured.patch, nodes::catalogue(), problems);
    run::throw_problems(problems);
    compile::AssetCache assets;
    assets.load(*plan, problems);
    run::throw_problems(problems);

    const run::ScratchFolder folder;
    run::EngineOptions options;
    options.seconds = settings.repeats * (settings.duration + settings.pause);
    options.folder = folder.path();
    run::Engine engine(std::move(*plan), options);
    engine.render(1, progress);
    engine.finish();
    const sound::Sound sound = sound::load_sound(folder.path() / measured.file);
    std::string unit = measured.out_unit;
    if (!unit.empty() && !measured.in_unit.empty()) unit += " per " + measured.in_unit;
    return {sound.samples, static_cast<double>(sound.rate),
            fmt::format("{}: {} to {}", std::filesystem::path(settings.patch.patch).stem().string(), settings.in,
                        settings.out_port),
            unit, std::nullopt};
}

/// Silence for cards that connect shortly after the start, then the sweeps, in shares of full scale.
std::vector<float> played(const vibration::SweepRun& run, double rate, std::size_t lead, double full_scale) {
    const auto period = static_cast<std::size_t>(std::llround((run.sweep.duration + run.pause) * rate));
    std::vector<float> samples(lead + period * static_cast<std::size_t>(run.repeats));
    for (std::size_t i = lead; i < samples.size(); ++i)
        samples[i] =
            static_cast<float>(run.amplitude / full_scale * run.sweep(static_cast<double>((i - lead) % period) / rate));
    return samples;
}

Answer through_card(const MeasureSettings& settings, const vibration::SweepRun& run, const Progress& progress) {
    const bool is_named = !settings.actuator.empty();
    CardChannels at{settings.device, settings.output_channel, settings.input_channel, 1.0, 1.0};
    if (is_named) at = card_channels(flat_patch(settings), settings.actuator, settings.sensor);
    if (is_named && !settings.device.empty()) at.card = settings.device;
    if (!(std::abs(run.amplitude) <= at.full_output))
        throw Error(is_named ? fmt::format("an amplitude of {:g} is more than actuator '{}' has at full scale, {:g}",
                                           run.amplitude, settings.actuator, at.full_output)
                             : "the amplitude of a sweep through a sound card must lie within full scale, 1");
    const auto lead = static_cast<std::size_t>(std::llround(0.25 * settings.rate));
    audio::Captured captured =
        audio::play_and_capture({at.card == "default" ? "" : at.card, settings.rate, at.output - 1, at.input - 1},
                                played(run, settings.rate, lead, at.full_output), progress);
    Answer answer{{captured.samples.begin() + static_cast<std::ptrdiff_t>(lead), captured.samples.end()},
                  settings.rate,
                  is_named ? fmt::format("{} to {}, sound card {}", settings.actuator, settings.sensor, captured.device)
                           : "sound card " + captured.device,
                  "",
                  std::nullopt};
    answer.clipped =
        static_cast<std::size_t>(std::ranges::count_if(answer.samples, [](float x) { return std::abs(x) >= 0.9999F; }));
    for (float& sample : answer.samples) sample *= static_cast<float>(at.full_input);
    answer.card = std::move(captured);
    return answer;
}

std::vector<DistortionOrder> summarise(const vibration::Identified& identified, double lowest, double highest) {
    std::vector<DistortionOrder> summaries;
    for (const vibration::Distortion& distortion : identified.distortions) {
        DistortionOrder summary{distortion.order};
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

double mean_coherence(const vibration::FrequencyResponse& response, double lowest, double highest) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < response.hz.size(); ++i)
        if (response.hz[i] >= lowest && response.hz[i] <= highest) sum += response.coherence[i], count += 1.0;
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

Measurement measure(const MeasureSettings& settings, const Progress& progress) {
    const bool is_named = !settings.actuator.empty() || !settings.sensor.empty();
    if (is_named && (settings.actuator.empty() || settings.sensor.empty() || settings.patch.patch.empty()))
        throw Error("a sweep from an actuator to a sensor takes a patch, --actuator NAME and --sensor NAME");
    if (is_named && (!settings.in.empty() || !settings.out_port.empty()))
        throw Error(
            "--actuator and --sensor go through a sound card, --in and --probe through the patch: give one pair");
    if (!is_named && settings.patch.patch.empty() == settings.device.empty())
        throw Error(
            "measure takes a patch with --in and --probe or with --actuator and --sensor, or --device for a sound "
            "card");
    const vibration::SweepRun run = sweep_of(settings);
    Answer answer = settings.device.empty() && !is_named ? through_patch(settings, progress)
                                                         : through_card(settings, run, progress);
    Measurement found;
    found.response = {answer.title, answer.unit, vibration::identify(run, answer.samples, answer.rate)};
    found.card = std::move(answer.card);
    found.clipped = answer.clipped;
    const vibration::FrequencyResponse& response = found.response.identified.response;
    found.lowest = std::max(2.0 * settings.first, response.hz.front());
    found.highest = std::min(0.5 * settings.last, response.hz.back());
    found.fit_highest = std::min(settings.fit_highest, response.hz.back());
    found.resonance =
        vibration::fit_resonance(response, std::max(settings.fit_lowest, response.hz.front()), found.fit_highest);
    // The mode of the resonance has the resolution of the record, which the fit of the level has not.
    const vibration::Mode* strongest = nullptr;
    for (const vibration::Mode& mode : found.response.identified.modes)
        if (mode.hz >= settings.fit_lowest && mode.hz <= found.fit_highest &&
            (!strongest || mode.peak > strongest->peak))
            strongest = &mode;
    if (strongest && (!(found.resonance.hz > 0.0) || std::abs(strongest->hz / found.resonance.hz - 1.0) < 0.03)) {
        found.resonance.hz = strongest->hz;
        found.resonance.damping = strongest->damping;
    }
    found.orders = summarise(found.response.identified, found.lowest, found.highest);
    found.coherence = mean_coherence(response, found.lowest, found.highest);
    return found;
}

}  // namespace tactus::analysis
