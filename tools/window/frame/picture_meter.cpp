// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/picture_meter.hpp"

#include <time.h>
#include <unistd.h>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>

namespace tactus::window {

namespace {

/// Processor time of a thread of this process, s. The clock's number is part of Linux' interface (see clock_getres(2)).
double processor_time(pid_t thread) {
    const auto clock = static_cast<clockid_t>((~static_cast<unsigned>(thread) << 3) | 6u);
    timespec t{};
    if (clock_gettime(clock, &t) != 0) return 0.0;  // it has ended
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Mesa names its threads; those of a run have the name of the program.
bool draws(pid_t thread) {
    if (thread == gettid()) return true;
    std::string name;
    std::getline(std::ifstream("/proc/self/task/" + std::to_string(thread) + "/comm"), name);
    return name.starts_with("llvmpipe");
}

}  // namespace

double PictureMeter::spend() {
    double sum = 0.0;
    std::error_code ignored;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", ignored)) {
        const std::string number = task.path().filename().string();
        pid_t thread = 0;
        std::from_chars(number.data(), number.data() + number.size(), thread);
        auto known = draws_.find(thread);
        if (known == draws_.end()) known = draws_.emplace(thread, draws(thread)).first;
        if (!known->second) continue;
        const double now = processor_time(thread);
        const auto [before, is_new] = spent_.emplace(thread, now);
        if (!is_new) sum += now - before->second;
        before->second = now;
    }
    return sum;
}

void PictureMeter::add(std::int64_t scenes) {
    const bool draws_scene = scenes != scenes_;
    const auto now = Clock::now();
    if (draws_scene && scenes_ == 0) first_ = now;
    scenes_ = scenes;
    const double at = scenes_ > 0 ? std::chrono::duration<double>(now - first_).count() : -1.0;
    costs_.push_back({at, spend(), draws_scene});
}

}  // namespace tactus::window
