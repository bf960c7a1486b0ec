// SPDX-License-Identifier: Apache-2.0
// Sound libraries that write to stderr, or end the process, when a machine has no card.
#pragma once

namespace tactus::audio {

/// Sends stderr of the whole process to nowhere while it lives. ALSA and JACK print some sixty lines when asked for
/// cards that are not there.
class QuietStderr {
public:
    QuietStderr();
    ~QuietStderr();
    QuietStderr(const QuietStderr&) = delete;
    QuietStderr& operator=(const QuietStderr&) = delete;

private:
    int saved_ = -1;
};

/// Throws Error when ALSA's configuration lacks the default device: PortAudio would abort the process on it.
void require_alsa_default();

}  // namespace tactus::audio
