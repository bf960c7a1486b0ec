// SPDX-License-Identifier: Apache-2.0
// Synchronous playback and recording.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tactus::audio {

struct Duplex {
    std::string device;  ///< part of a name from `list_audio_cards`; the device must also have inputs; "": the default
    double rate = 48000.0;  ///< Hz
    int output_channel = 0;  ///< from 0
    int input_channel = 0;
};

struct Captured {
    std::string device;  ///< name of the device used
    std::vector<float> samples;  ///< one per sample played, captured in the same callback
    double output_latency = 0.0, input_latency = 0.0;  ///< as reported by the driver, s
    int underflows = 0;  ///< underflows and overflows of the card
};

/// Plays `samples` (within ±1) once and returns the simultaneous recording, sample for sample. Blocks; calls `progress`
/// with the fraction done. Throws Error if there is no such device or it stops responding.
Captured play_and_capture(const Duplex& duplex, const std::vector<float>& samples,
                          const std::function<void(double)>& progress = {});

}  // namespace tactus::audio
