// SPDX-License-Identifier: Apache-2.0
// Workarounds for sound libraries that write to stderr or abort the process when a machine has no card.
#pragma once

namespace tactus::audio {

/// Redirects stderr of the whole process to /dev/null during its lifetime. ALSA and JACK print about sixty lines when
/// they search for missing cards.
class QuietStderr {
public:
    QuietStderr();
    ~QuietStderr();
    QuietStderr(const QuietStderr&) = delete;
    QuietStderr& operator=(const QuietStderr&) = delete;

private:
    int saved_ = -1;
};

/// Throws Error when ALSA's configuration lacks the default device, on which PortAudio would abort the process.
void require_alsa_default();

}  // namespace tactus::audio
