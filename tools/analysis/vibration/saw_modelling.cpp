// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/saw_modelling.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/spectrum/similarity.hpp"
#include "dsp/signal/spectrum/welch.hpp"
#include "dsp/vibration/modelled_saw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

constexpr double output_rate = 48000.0;     // Hz
constexpr double settling = 0.5, heard = 4.0;  // s

/// Samples at the model's rate, beyond which it says nothing.
signal::Spectrum spectrum_of(std::span<const float> samples, double rate, double gain) {
    constexpr double model_rate = vibration::SawModelSize::residual_rate;
    std::vector<double> resampled = signal::resample(samples, rate, model_rate);
    for (double& x : resampled) x *= gain;
    return signal::welch<double>(resampled, signal::WelchSettings::hann(model_rate, 2048, 1024));
}

std::vector<float> play(const vibration::SawModel& model, const vibration::SawRecording& recording) {
    // Whatever cuts, cuts at any load.
    const vibration::SawBehaviour behaviour{
        .spin_up_time = 0.0, .spin_down_time = 0.0, .load_on = 0.0, .load_off = 0.0, .fade_time = 0.0};
    vibration::ModelledSaw saw;
    saw.prepare(output_rate, model, behaviour);
    const double load = recording.cutting ? recording.load : 0.0;
    const auto next = [&] { return saw.tick(load, recording.density, true, recording.reciprocation_rate); };
    for (int i = 0; i < static_cast<int>(settling * output_rate); ++i) next();
    std::vector<float> out(static_cast<std::size_t>(heard * output_rate));
    for (float& y : out) y = next();
    return out;
}

double level_db(const signal::Spectrum& spectrum, const SawModelSettings& settings) {
    double power = 0.0;
    for (std::size_t k = 0; k < spectrum.power.size(); ++k)
        if (const double f = spectrum.frequency(k); f >= settings.lowest && f <= settings.highest)
            power += spectrum.power[k];
    return 10.0 * std::log10(std::max(power, 1e-300));
}

ModelDistance distance(const vibration::SawModel& model, const vibration::SawRecording& recording,
                       const SawModelSettings& settings) {
    const signal::Spectrum reference = spectrum_of(recording.part(), recording.sample_rate, recording.gain);
    const signal::Spectrum output = spectrum_of(play(model, recording), output_rate, 1.0);
    return {
        signal::log_spectral_distance({reference.power, output.power, reference.df}, settings.lowest, settings.highest),
        level_db(output, settings) - level_db(reference, settings)};
}

}  // namespace

SawModelling model_saw(const SawModelSettings& settings) {
    SawModelling out;
    out.set = sound::load_recording_set(settings.recordings);
    const std::string name = settings.recordings.string();
    if (out.set.model) throw Error(name + " holds a model already; give the recording set");
    if (settings.recordings.extension() != ".toml")
        throw Error(name +
                    " is one sound of unknown thrust; a model needs a recording set (TOML) that states the rate "
                    "and the thrust of each recording");
    for (const sound::Recording& recording : out.set.recordings)
        if (recording.rate_estimated)
            throw Error(
                fmt::format("{}: '{}' does not state its rate of reciprocation; a model is only as good as its "
                            "conditions, so measure it and state it, as in rate = \"233 Hz\"",
                            name, recording.file.filename().string()));
    for (sound::Recording& recording : out.set.recordings) cut(recording, settings.stretch);
    out.texts = {out.set.title, out.set.note, out.set.licence, out.set.synthesised, out.set.calibrated()};
    std::vector<vibration::SawRecording> recordings = sound::saw_recordings(out.set);
    out.model = vibration::fit_saw_model(recordings);
    // What the model plays is compared at the rate that was found in the sound.
    for (std::size_t i = 0; i < recordings.size(); ++i) recordings[i].reciprocation_rate = out.model.conditions[i].rate;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
        ModelledRecording& row = out.recordings.emplace_back();
        row.recording = &out.set.recordings[i];
        row.fitted = distance(out.model, recordings[i], settings);
        std::vector<vibration::SawRecording> others = recordings;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        if (std::ranges::none_of(others, [&](const auto& other) { return other.cutting == recordings[i].cutting; }))
            continue;
        const vibration::SawModel rest = vibration::fit_saw_model(others);
        row.left_out = distance(rest, recordings[i], settings);
        row.inner =
            vibration::SawSounds(rest).covers(recordings[i].cutting, recordings[i].reciprocation_rate,
                                              recordings[i].cutting ? recordings[i].load : 0.0, recordings[i].density);
    }
    return out;
}

}  // namespace tactus::analysis
