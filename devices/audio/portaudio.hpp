// SPDX-License-Identifier: Apache-2.0
// Sound card output through PortAudio.
#pragma once

#include "devices/audio/input_ring.hpp"
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
    double latency = 0.0;  ///< with its smallest buffers, as the driver reports it, s
    bool is_default = false;
};

/// All outputs; empty when there is none. Throws Error when the sound system cannot be used.
std::vector<AudioOutput> list_audio_outputs();

/// An output that `prepare` opens. `device`: part of a name from `list_audio_outputs`; "": the default (JACK when it
/// runs, otherwise the system's). Playback starts when the buffer holds `lead_s` more than the card requests.
///
/// The card's callback only copies from a ring buffer; in JACK's freewheel mode it also waits for sound. `write` and
/// `writable` are wait-free and for one thread; `statistics` and `progress` are for any thread. `prepare` throws Error
/// when there is no such output, so that the caller can continue without sound.
///
/// With `inputs`, the same callback writes what the device hears to it, as many channels as it has; `input_names` for
/// programs that connect sound.
std::unique_ptr<AudioSink> make_portaudio_sink(std::string device = {}, double lead_s = 0.0,
                                               std::shared_ptr<InputRing> inputs = {},
                                               std::vector<std::string> input_names = {});

}  // namespace tactus::audio
