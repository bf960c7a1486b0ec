// SPDX-License-Identifier: Apache-2.0
#include "tools/run/patch_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>

namespace tactus::run {

constexpr auto settling = std::chrono::milliseconds(100);

PatchWatch::PatchWatch(const std::filesystem::path& file) : descriptor_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    watch(file);
}

PatchWatch::~PatchWatch() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void PatchWatch::watch(const std::filesystem::path& file) {
    if (descriptor_ < 0) return;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    // inotify returns the same number for the same folder.
    const int number = inotify_add_watch(descriptor_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO);
    if (number >= 0) files_.push_back({number, file.filename()});
}

void PatchWatch::move_to(const std::filesystem::path& file) {
    files_.clear();
    touched_.reset();
    watch(file);
}

void PatchWatch::follow(const std::vector<std::filesystem::path>& files) {
    if (!is_working()) return;
    files_.resize(1);
    for (const std::filesystem::path& file : files) watch(file);
}

bool PatchWatch::was_saved() {
    if (!is_working()) return false;
    alignas(inotify_event) char buffer[4096];
    for (ssize_t size; (size = ::read(descriptor_, buffer, sizeof buffer)) > 0;)
        for (ssize_t at = 0; at < size;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            const bool is_ours = event->len > 0 && std::ranges::any_of(files_, [event](const Watched& file) {
                                     return file.folder == event->wd && file.name == event->name;
                                 });
            if (is_ours) touched_ = std::chrono::steady_clock::now();
            at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
        }
    if (!touched_ || std::chrono::steady_clock::now() - *touched_ < settling) return false;
    touched_.reset();
    return true;
}

}  // namespace tactus::run
