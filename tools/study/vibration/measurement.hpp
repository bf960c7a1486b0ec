// SPDX-License-Identifier: Apache-2.0
// A sweep through a patch or a sound card, and what it tells of what it went through.
#pragma once

#include "assets/sound/response_file.hpp"
#include "devices/audio/duplex.hpp"
#include "tools/session/patch_choice.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

struct MeasureSettings {
    session::PatchChoice patch;                      ///< of a sweep through a patch
    std::string in, out_port;                        ///< its ports, NODE.PORT
    std::string device;                              ///< a sound card instead: part of its name, or "default"
    double first = 20.0, last = 2000.0;              ///< Hz
    double duration = 8.0, pause = 1.0;              ///< s
    double amplitude = 1.0;                          ///< in the unit of what it feeds; card: of full scale
    int repeats = 1;
    double fit_lowest = 30.0, fit_highest = 400.0;   ///< Hz: where the resonance is looked for
    double rate = 48000.0;                           ///< of the sound card, Hz
    int output_channel = 1, input_channel = 1;       ///< of the sound card, from 1
};

/// One order of distortion: rms over the exciting frequencies, and the worst; as shares of the fundamental.
struct DistortionOrder {
    int order = 2;
    double rms = 0.0, worst = 0.0, worst_hz = 0.0;
};

struct Measurement {
    sound::ResponseFile response;
    std::optional<audio::Captured> card;         ///< when it went through one
    vibration::Resonance resonance;                  ///< 0 Hz: none was found
    double lowest = 0.0, highest = 0.0;   ///< Hz: where coherence and distortion are stated
    double fit_highest = 0.0;             ///< Hz, up to where the resonance was looked for
    double coherence = 0.0;               ///< mean
    std::vector<DistortionOrder> orders;
};

using Progress = std::function<void(double share)>;

/// Plays the sweep and identifies what it went through. Problems of a patch but the last go to standard error. Throws
/// Error.
Measurement measure(const MeasureSettings& settings, const Progress& progress);

}  // namespace tactus::study
