// SPDX-License-Identifier: Apache-2.0
#include "tools/patch_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>

namespace tactus {

constexpr auto settling = std::chrono::milliseconds(100);

PatchWatch::PatchWatch(const std::filesystem::path& file)
    : name_(file.filename()), descriptor_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    if (descriptor_ < 0) return;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (inotify_add_watch(descriptor_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO) >= 0) return;
    ::close(descriptor_);
    descriptor_ = -1;
}

PatchWatch::~PatchWatch() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

bool PatchWatch::was_saved() {
    if (descriptor_ < 0) return false;
    alignas(inotify_event) char buffer[4096];
    for (ssize_t size; (size = ::read(descriptor_, buffer, sizeof buffer)) > 0;)
        for (ssize_t at = 0; at < size;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            if (event->len > 0 && name_ == event->name) touched_ = std::chrono::steady_clock::now();
            at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
        }
    if (!touched_ || std::chrono::steady_clock::now() - *touched_ < settling) return false;
    touched_.reset();
    return true;
}

}  // namespace tactus
