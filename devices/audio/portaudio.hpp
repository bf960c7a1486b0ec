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
    double rate = 0.0;     ///< preferred rate, Hz
    double latency = 0.0;  ///< with its smallest buffers, as reported by the driver, s
    bool is_default = false;  ///< used when no name is given
};

/// Lists all cards; empty if there are none. Throws Error if the sound system cannot be used.
std::vector<AudioCard> list_audio_cards();

/// An output that `prepare` opens. `device`: substring of a name from `list_audio_cards`; "": the default (JACK when it
/// runs, otherwise the system's). Playback starts when the buffer holds `lead_s` more than the card requests.
///
/// The card's callback only copies from a ring buffer; in JACK's freewheel mode it also waits for sound. `write` and
/// `writable` are wait-free and for one thread; `statistics` and `progress` are for any thread. `prepare` throws Error
/// when there is no such output, so that the caller can continue without sound.
///
/// With `heard`, the same callback writes the device's inputs to its ring, as many channels as it has. A card that is
/// not played may have no outputs; frames written to it are then discarded at the card's pace.
struct HeardChannels {
    std::shared_ptr<InputRing> ring;
    std::vector<std::string> names;  ///< shown by patch bays
    bool is_played = true;  ///< false: the card is used for input only
};
std::unique_ptr<AudioSink> make_portaudio_sink(std::string device = {}, double lead_s = 0.0, HeardChannels heard = {});

}  // namespace tactus::audio
