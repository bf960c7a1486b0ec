// SPDX-License-Identifier: Apache-2.0
// PortAudio while somebody uses it. Included by the drivers only.
#pragma once

#include <string>

namespace tactus::audio {

/// PortAudio in use; it counts its users itself. Throws Error when the sound system cannot be used.
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
