// SPDX-License-Identifier: Apache-2.0
// Sound card output through PortAudio.
#pragma once

#include "graph/device.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus {

/// An output device of this machine.
struct AudioOutput {
    std::string name;  ///< "JACK Audio Connection Kit: system"
    int channels = 0;
    double rate = 0.0;  ///< Hz, the one it prefers
};

/// All outputs there are; empty on a machine without any. Throws Error when the sound system cannot be asked.
std::vector<AudioOutput> list_audio_outputs();

/// An output that is opened by `prepare`. `device` is part of a name from `list_audio_outputs`, "" the default: JACK
/// when it runs, otherwise the system's. `buffer_s` is how much sound `write` can put ahead of the card, in s.
///
/// The card's callback copies from a ring and does nothing else. `write` and `writable` are wait-free and belong to one
/// thread; `statistics` and `progress` may be called by any. `prepare` throws Error when there is no such output, so that
/// the caller can go on without sound. `close` never waits for a card that is gone.
std::unique_ptr<AudioSink> make_portaudio_sink(std::string device = {}, double buffer_s = 0.1);

}  // namespace tactus
