// SPDX-License-Identifier: Apache-2.0
// Runs points of a sweep on this machine: a parent that hands out points and watches, and worker processes.
#pragma once

#include "dsp/core/error.hpp"
#include "tools/analysis/sweep/run_point.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

/// One of several runners that divide the points between them: those whose index is `index` modulo `count`.
struct Share {
    std::size_t index = 0, count = 1;
};

struct LocalRun {
    int jobs = 0;  ///< workers; 0: one per core
    Share share;
    std::string runner = "local";  ///< as it is noted in the rows
    std::string version;           ///< of this program, as it is noted in the rows
    std::filesystem::path program;
    RunVerb run_verb;              ///< null: each verb in a process of its own
    const std::atomic<bool>* stop = nullptr;
    std::function<void(const struct RunProgress& progress)> tell;
    bool writes_tables = true;     ///< results.csv and results.sqlite, from time to time
};

/// The log cannot be written: a full disk, or a folder without permission. What it has so far stays.
class LogFailure : public Error {
public:
    using Error::Error;
};

struct RunProgress {
    std::size_t points = 0;    ///< of the share
    std::size_t before = 0;    ///< of these, finished when the run began
    std::size_t finished = 0, failed = 0, retried = 0;  ///< in this run; finished includes failed
    double elapsed = 0.0;      ///< s
    /// Time to completion, s, low and high: 95 % interval if the points that are left are like those that were run. They
    /// are, because points run in random order. Nothing before the fifth point.
    std::optional<std::pair<double, double>> left;
    bool is_waiting_for_memory = false;
};

/// True if a point that needs `need` bytes may be handed out. `available`: bytes that new memory may use; `busy`: resident
/// bytes of each worker that has a point, which may still grow to the need; `idle`: those of the worker that gets it, 0 for
/// a new one. A tenth of the need stays free.
bool fits_in_memory(double available, double need, std::span<const double> busy, double idle);

/// Runs all points of the share that have no successful row. Workers live for many points, so that what they loaded stays
/// loaded; one that exceeds a limit, crashes or grows too large is replaced. A point that fails is tried again as often
/// as the sweep states, unless a verb of Tactus rejected its input (exit code 2): that would fail again. Another worker
/// is only started, and a point only handed out, while the memory that a point needed so far is available, minus the
/// memory that running points may still allocate. Ends early, without rows for the points that are running, when `stop`
/// is set. Throws LogFailure.
RunProgress run_locally(const SweepFolder& folder, const LocalRun& options);

/// The share that the environment assigns: Open MPI, PMI (MPICH, Intel) or Slurm. Nothing: this process is alone.
std::optional<Share> share_of_environment();
/// "3/8" → {2, 8}. Throws Error.
Share parse_share(const std::string& text);

}  // namespace tactus::analysis
