// SPDX-License-Identifier: Apache-2.0
// RAII for the initialisation of PortAudio. Included by the drivers only.
#pragma once

#include <string>

namespace tactus::audio {

/// Initialises PortAudio, which counts its users. Throws Error when the sound system cannot be used.
class PortAudioSession {
public:
    PortAudioSession();
    ~PortAudioSession();
    PortAudioSession(const PortAudioSession&) = delete;
    PortAudioSession& operator=(const PortAudioSession&) = delete;
};

/// "JACK Audio Connection Kit: system". `device` is PortAudio's index.
std::string audio_device_name(int device);

}  // namespace tactus::audio
