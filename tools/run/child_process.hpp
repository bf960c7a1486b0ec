// SPDX-License-Identifier: Apache-2.0
// A program that is run to its end, with its output captured.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::run {

/// A file in memory that a process writes to.
class Capture {
public:
    /// `name` is shown in /proc only. Throws Error.
    explicit Capture(const char* name);
    ~Capture();
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    int handle() const { return handle_; }
    /// All that was written. Throws Error above 256 MiB.
    std::string text() const;

private:
    int handle_;
};

struct Finished {
    int code = 0;  ///< exit code; 0 if it was killed; 127 with a message if it cannot be run
    int signal = 0;  ///< 0: it was not killed
    bool is_late = false;  ///< killed here, because it took too long
    double peak = 0.0;  ///< largest resident memory, bytes
    double seconds = 0.0;  ///< processor time, with that of the processes for which it waited
};

struct ProcessLimits {
    double seconds = 0.0;  ///< wall time; 0: none
    const std::atomic<bool>* stop = nullptr;  ///< ends it when set
};

/// Runs a program, found by PATH, in `folder` (empty: the current one), with no standard input. It is killed when this
/// process ends. With limits it has a process group of its own, which is killed as a whole. Throws Error if no process can be
/// made.
Finished run_process(const std::vector<std::string>& words, const std::filesystem::path& folder, const Capture& out,
                     const Capture& err, const ProcessLimits& limits = {});

}  // namespace tactus::run
