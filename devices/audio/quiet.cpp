// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/quiet.hpp"

#include "dsp/core/error.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace tactus::audio {

QuietStderr::QuietStderr() {
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    saved_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    if (saved_ >= 0) ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
}

QuietStderr::~QuietStderr() {
    if (saved_ < 0) return;
    std::fflush(stderr);
    ::dup2(saved_, STDERR_FILENO);
    ::close(saved_);
}

void require_alsa_default() {
    // PortAudio has loaded the library when it was built for ALSA; otherwise there is nothing to check.
    void* const library = ::dlopen("libasound.so.2", RTLD_NOW | RTLD_NOLOAD);
    if (library == nullptr) return;
    using Update = int (*)();
    using Search = int (*)(void*, const char*, void**);
    const auto update = reinterpret_cast<Update>(::dlsym(library, "snd_config_update"));
    const auto search = reinterpret_cast<Search>(::dlsym(library, "snd_config_search"));
    void** const top = static_cast<void**>(::dlsym(library, "snd_config"));
    bool found = true;
    if (update != nullptr && search != nullptr && top != nullptr) {
        void* node = nullptr;
        found = update() >= 0 && *top != nullptr && search(*top, "pcm", &node) >= 0 &&
                search(*top, "pcm.default", &node) >= 0;
    }
    ::dlclose(library);
    if (!found)
        throw Error(
            "the ALSA configuration has no default device (pcm.default); correct ALSA_CONFIG_PATH or "
            "/usr/share/alsa/alsa.conf");
}

}  // namespace tactus::audio
