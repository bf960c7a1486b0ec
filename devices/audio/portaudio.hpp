// SPDX-License-Identifier: Apache-2.0
// Sound card output through PortAudio.
#pragma once

#include "devices/audio/input_ring.hpp"
#include "graph/node/device.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::audio {

/// A sound card of this machine.
struct AudioCard {
    std::string name;  ///< "JACK Audio Connection Kit: system"
    int outputs = 0, inputs = 0;  ///< channels
    double rate = 0.0;     ///< Hz, the one it prefers
    double latency = 0.0;  ///< with its smallest buffers, as the driver reports it, s
    bool is_default = false;  ///< what is played without a name
};

/// All cards; empty when there is none. Throws Error when the sound system cannot be used.
std::vector<AudioCard> list_audio_cards();

/// An output that `prepare` opens. `device`: part of a name from `list_audio_cards`; "": the default (JACK when it
/// runs, otherwise the system's). Playback starts when the buffer holds `lead_s` more than the card requests.
///
/// The card's callback only copies from a ring buffer; in JACK's freewheel mode it also waits for sound. `write` and
/// `writable` are wait-free and for one thread; `statistics` and `progress` are for any thread. `prepare` throws Error
/// when there is no such output, so that the caller can continue without sound.
///
/// With `heard`, the same callback writes what the device hears to its ring, as many channels as it has. A card that
/// nothing is played on may have no outputs: then what is written is thrown away at the card's pace.
struct HeardChannels {
    std::shared_ptr<InputRing> ring;
    std::vector<std::string> names;  ///< for programs that connect sound
    bool is_played = true;           ///< false: the card is only heard
};
std::unique_ptr<AudioSink> make_portaudio_sink(std::string device = {}, double lead_s = 0.0, HeardChannels heard = {});

}  // namespace tactus::audio
