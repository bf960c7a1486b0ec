// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/validation.hpp"

#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/spectrum/alignment.hpp"
#include "engine/run/engine.hpp"
#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace tactus::analysis {

namespace {

/// Samples of a sound from `from` seconds on.
std::vector<float> after(const std::filesystem::path& file, double from, double& rate) {
    const sound::Sound sound = sound::load_sound(file);
    rate = sound.rate;
    const auto first = std::min(sound.samples.size(), static_cast<std::size_t>(std::llround(from * rate)));
    return {sound.samples.begin() + static_cast<std::ptrdiff_t>(first), sound.samples.end()};
}

/// The played part of a recording, in m/s² if calibrated.
std::vector<float> reference_of(const sound::Recording& recording) {
    const vibration::SawRecording played = sound::saw_recording(recording);
    const std::span<const float> part = played.part();
    std::vector<float> samples(part.begin(), part.end());
    for (float& x : samples) x *= static_cast<float>(played.gain);
    return samples;
}

/// The stretch of the recording that was played: the take is of a part of it, and a saw does not sound alike all along.
std::vector<float> played_stretch(const std::vector<float>& recording, double recording_rate,
                                  const std::vector<float>& output, double output_rate) {
    constexpr double rate = 4000.0;
    const auto length = static_cast<std::size_t>(static_cast<double>(output.size()) / output_rate * recording_rate);
    if (length >= recording.size()) return recording;
    const std::vector<double> loop = signal::resample(recording, recording_rate, rate),
                              part = signal::resample(output, output_rate, rate);
    const std::size_t begin = static_cast<std::size_t>(
        static_cast<double>(signal::stretch_of_loop(loop, part, rate, 40.0, 1000.0)) / rate * recording_rate);
    std::vector<float> stretch(length);
    for (std::size_t i = 0; i < length; ++i) stretch[i] = recording[(begin + i) % recording.size()];
    return stretch;
}

/// Says when half of the time would give another verdict.
void judge_half(ComparedPair& pair, const std::vector<float>& reference, double reference_rate,
                const std::vector<float>& output, double output_rate, signal::ThresholdUnit touch) {
    const double seconds = static_cast<double>(output.size()) / output_rate;
    if (seconds < 2.0) return;
    const std::span<const float> half(output.data(), output.size() / 2);
    const std::vector<float> stretch =
        played_stretch(reference, reference_rate, {half.begin(), half.end()}, output_rate);
    signal::ComparisonOptions options;
    options.touch = touch;
    const signal::Comparison c = signal::compare(signal::Take(std::span<const float>(stretch), reference_rate),
                                                 signal::Take(half, output_rate), options);
    const Verdict verdict = judge(c, c.gain_db, pair.thresholds);
    if (verdict.passed() != pair.verdict.passed())
        pair.notes.push_back(fmt::format("the verdict depends on the length: the first {:.3g} s {}", 0.5 * seconds,
                                         verdict.passed() ? "pass" : "fail"));
}

}  // namespace

std::string ValidationRun::name() const {
    return fmt::format("{}, {:.4g} Hz{}, {:+g} dB", recording->cutting ? "cutting" : "free air", recording->rate,
                       recording->cutting ? fmt::format(", {:g} N", recording->load) : "", level_db);
}

std::string ValidationRun::file_name() const {
    return fmt::format("{}_{:.4g}Hz{}_{:+g}dB", recording->cutting ? "cutting" : "free_air", recording->rate,
                       recording->cutting ? fmt::format("_{:g}N", recording->load) : "", level_db);
}

Validation plan_validation(const ValidateSettings& settings) {
    Validation validation;
    const run::PatchChoice& choice = settings.patch;
    validation.patch = choice.patch;
    validation.thresholds = settings.thresholds;
    patch::Problems problems;
    validation.source = patch::load_patch(run::find_patch(choice.patch), problems);
    patch::apply_overrides(validation.source, choice.overrides, problems);
    patch::flatten(validation.source, problems);
    run::throw_problems(problems);
    if (choice.seed) validation.source.seed = *choice.seed;
    validation.path = find_saw_path(validation.source, settings.saw, settings.out_port, nodes::catalogue());
    validation.set = std::make_shared<const sound::RecordingSet>(sound::load_recording_set(settings.set));
    if (validation.set->model)
        throw Error(settings.set.string() + " holds a model of a saw; give the recording set that it was made from");
    for (const sound::Recording& recording : validation.set->recordings)
        for (const double level : settings.levels) {
            ValidationRun& run = validation.runs.emplace_back();
            run.recording = &recording;
            run.level_db = level;
        }
    return validation;
}

void validate(Validation& validation, std::size_t index, const ValidateSettings& settings, bool pictures) {
    ValidationRun& run = validation.runs[index];
    const sound::Recording& recording = *run.recording;
    const SteadyPatch steady =
        steady_patch(validation.source, validation.path,
                     {validation.set->path, recording.rate, recording.load, std::pow(10.0, run.level_db / 20.0)},
                     nodes::catalogue());
    patch::Problems problems;
    compile::AssetCache assets;
    std::optional<compile::Schedule> plan = run::plan_of(steady.patch, {}, std::nullopt, &assets, problems);
    if (!problems.empty()) throw problems.list.front();
    const run::ScratchFolder folder;
    run::EngineOptions options;
    options.seconds = settings.from + settings.seconds;
    options.folder = folder.path();
    options.hash = false;
    options.time_nodes = false;
    run::Engine engine(std::move(*plan), options);
    engine.render(1);
    engine.finish();

    double rate = 0.0;
    const std::vector<float> output = after(folder.path() / steady.out_file, settings.from, rate);
    if (!steady.drive_file.empty()) {
        double drive_rate = 0.0, square = 0.0, peak = 0.0;
        const std::vector<float> drive = after(folder.path() / steady.drive_file, settings.from, drive_rate);
        for (const float v : drive) {
            square += static_cast<double>(v) * static_cast<double>(v);
            peak = std::max(peak, std::abs(static_cast<double>(v)));
        }
        run.drive_rms = std::sqrt(square / static_cast<double>(std::max<std::size_t>(1, drive.size())));
        run.drive_peak = peak;
    }
    const std::vector<float> whole = reference_of(recording);
    const std::vector<float> reference = played_stretch(whole, recording.sample_rate, output, rate);
    ComparedPair& pair = run.pair;
    pair.reference = recording.file;
    pair.output = run.name();
    pair.thresholds = validation.thresholds;
    if (!recording.full_scale) pair.notes.push_back("the recording is not calibrated: its level cannot be compared");
    if (!recording.file_note.empty()) pair.notes.push_back(recording.file_note);
    if (recording.rate_estimated) pair.notes.push_back("the rate of the saw was estimated from the recording");
    try {
        compare_takes(pair, signal::Take(std::span<const float>(reference), recording.sample_rate),
                      signal::Take(std::span<const float>(output), rate), {.touch = settings.touch}, pictures);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", run.name(), error.message()));
    }
    pair.level_gap_db = pair.comparison.gain_db;
    pair.verdict = judge(pair.comparison, pair.level_gap_db, validation.thresholds);
    judge_half(pair, whole, recording.sample_rate, output, rate, settings.touch);
}

}  // namespace tactus::analysis
