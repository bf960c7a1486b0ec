// SPDX-License-Identifier: Apache-2.0
// Sound card output through PortAudio.
#pragma once

#include "graph/node/device.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::audio {

/// An output device of this machine.
struct AudioOutput {
    std::string name;  ///< "JACK Audio Connection Kit: system"
    int channels = 0;
    double rate = 0.0;     ///< Hz, the one it prefers
    double latency = 0.0;  ///< of its smallest buffers, as the driver states it, s
    bool is_default = false;
};

/// All outputs there are; empty on a machine without any. Throws Error when the sound system cannot be asked.
std::vector<AudioOutput> list_audio_outputs();

/// An output that is opened by `prepare`. `device` is part of a name from `list_audio_outputs`, "" the default: JACK
/// when it runs, otherwise the system's. Playing begins when `lead_s` of sound more than the card asks for is there.
///
/// The card's callback copies from a ring and does nothing else, except that it waits for sound while JACK freewheels.
/// `write` and `writable` are wait-free and belong to one thread; `statistics` and `progress` may be called by any.
/// `prepare` throws Error when there is no such output, so that the caller can go on without sound.
std::unique_ptr<AudioSink> make_portaudio_sink(std::string device = {}, double lead_s = 0.0);

}  // namespace tactus::audio
