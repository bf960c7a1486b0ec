// SPDX-License-Identifier: Apache-2.0
#include "tools/command/progress.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::command {

namespace {

constexpr double quiet_seconds = 2.0;  // shorter work shows nothing
constexpr std::chrono::milliseconds between{100};

std::string_view gap_before(std::string_view doing) { return doing.empty() ? "" : "  "; }

}  // namespace

std::string progress_bar(double done, std::string_view doing) {
    constexpr double width = 30.0;
    const auto filled = static_cast<std::size_t>(width * std::clamp(done, 0.0, 1.0));
    return fmt::format("[{:<30}] {:3.0f} %{}{}", std::string(filled, '#'), 100.0 * done, gap_before(doing), doing);
}

std::string progress_line(double done, std::string_view doing, double seconds, int& tenths) {
    // Of rounding: 0.3 is three tenths.
    const int reached = static_cast<int>(10.0 * std::clamp(done, 0.0, 1.0) + 1e-9);
    if (seconds < quiet_seconds || reached <= tenths || reached == 10) return {};
    tenths = reached;
    return fmt::format("{} %{}{}\n", 10 * reached, gap_before(doing), doing);
}

void Progress::show(double done, std::string_view doing) {
    if (is_quiet_) return;
    const std::lock_guard lock(showing_);
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - begun_).count();
    if (!line_.is_terminal()) {
        if (const std::string line = progress_line(done, doing, seconds, tenths_); !line.empty()) say(stderr, line);
    } else if (seconds >= quiet_seconds && now - shown_ >= between) {
        line_.show(progress_bar(done, doing));
        shown_ = now;
    }
}

void Progress::clear() {
    const std::lock_guard lock(showing_);
    line_.clear();
}

}  // namespace tactus::command
