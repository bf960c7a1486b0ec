// SPDX-License-Identifier: Apache-2.0
// Identifies a system in a patch or behind a sound card with a sine sweep.
#pragma once

#include "assets/sound/response_file.hpp"
#include "devices/audio/duplex.hpp"
#include "tools/run/patch_choice.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct MeasureSettings {
    run::PatchChoice patch;                      ///< for a sweep through a patch
    std::string in, out_port;                        ///< its ports, NODE.PORT
    std::string device;                              ///< a sound card instead: substring of its name, or "default"
    std::string actuator, sensor;  ///< entries of the patch, instead of its ports: measured through their card
    double first = 20.0, last = 2000.0;  ///< Hz
    double duration = 8.0, pause = 1.0;  ///< s
    double amplitude = 1.0;  ///< in the unit of the fed port or of the actuator; card alone: fraction of full scale
    int repeats = 1;
    double fit_lowest = 30.0, fit_highest = 400.0;  ///< Hz: search range of the resonance
    double rate = 48000.0;  ///< of the sound card, Hz
    int output_channel = 1, input_channel = 1;  ///< of the sound card, from 1
};

/// One order of harmonic distortion: rms over the frequencies, and maximum; relative to the fundamental.
struct DistortionOrder {
    int order = 2;
    double rms = 0.0, worst = 0.0, worst_hz = 0.0;
};

struct Measurement {
    sound::ResponseFile response;
    std::optional<audio::Captured> card;  ///< for a sound card
    vibration::Resonance resonance;  ///< 0 Hz: none found
    double lowest = 0.0, highest = 0.0;  ///< Hz: range of coherence and distortion
    double fit_highest = 0.0;  ///< Hz, upper limit of the search for the resonance
    double coherence = 0.0;  ///< mean
    std::vector<DistortionOrder> orders;
    std::size_t clipped = 0;  ///< samples of a card's input at full scale; if above 0, the response is unreliable
};

using Progress = std::function<void(double share)>;

/// Plays the sweep and identifies the system. Prints all problems of a patch except the last on standard error. Throws
/// Error.
Measurement measure(const MeasureSettings& settings, const Progress& progress);

}  // namespace tactus::analysis
