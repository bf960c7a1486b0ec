// SPDX-License-Identifier: Apache-2.0
// Progress of long work on standard error.
#pragma once

#include "tools/terminal.hpp"

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace tactus::command {

/// From two seconds on: a bar on a terminal, otherwise a line for each 10 % that work reaches. May be called from several
/// threads, as often as work advances: a line is written ten times per second at most.
class Progress {
public:
    explicit Progress(bool is_quiet = false) : is_quiet_(is_quiet) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `done`: from 0 to 1; `doing`: the present step, such as "3 of 20 files".
    void show(double done, std::string_view doing = {});
    /// Removes the bar.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    bool is_quiet_;
    std::mutex showing_;
    LiveLine line_;
    Clock::time_point begun_ = Clock::now(), shown_{};
    int tenths_ = 0;  ///< that have a line
};

/// "[######    ]  60 %  doing"
std::string progress_bar(double done, std::string_view doing);

/// The line of a stream that is no terminal, if `done` has reached a tenth after `tenths`, which is set to it; or "".
std::string progress_line(double done, std::string_view doing, double seconds, int& tenths);

}  // namespace tactus::command
