// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/portaudio_session.hpp"

#include "devices/audio/quiet.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <pa_jack.h>
#include <portaudio.h>

namespace tactus::audio {

PortAudioSession::PortAudioSession() {
    const QuietStderr quiet;
    require_alsa_default();
    // What programs that connect sound show.
    PaJack_SetClientName("tactus");
    if (const PaError error = Pa_Initialize(); error != paNoError)
        throw Error(fmt::format("the sound system cannot be used: {}", Pa_GetErrorText(error)));
}

PortAudioSession::~PortAudioSession() { Pa_Terminate(); }

std::string audio_device_name(int device) {
    const PaDeviceInfo& info = *Pa_GetDeviceInfo(device);
    return fmt::format("{}: {}", Pa_GetHostApiInfo(info.hostApi)->name, info.name);
}

}  // namespace tactus::audio
