// SPDX-License-Identifier: Apache-2.0
// Playing and listening at the same time, in step.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tactus::audio {

struct Duplex {
    std::string device;      ///< part of a name from `list_audio_outputs` that also listens; "" the default
    double rate = 48000.0;   ///< Hz
    int output_channel = 0;  ///< from 0
    int input_channel = 0;
};

struct Captured {
    std::string device;          ///< what it really was
    std::vector<float> samples;  ///< one per sample played, captured in the same callback
    double output_latency = 0.0, input_latency = 0.0;  ///< as the driver reports them, s
    int underflows = 0;          ///< times the card lost sound in either direction
};

/// Plays `samples` (within ±1) once and returns what came in meanwhile, sample for sample. Blocks; `progress` is told
/// the fraction done. Throws Error when there is no such device or it stops answering.
Captured play_and_capture(const Duplex& duplex, const std::vector<float>& samples,
                          const std::function<void(double)>& progress = {});

}  // namespace tactus::audio
