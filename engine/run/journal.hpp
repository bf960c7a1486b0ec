// SPDX-License-Identifier: Apache-2.0
// Collects the timing decisions of each group and writes them to a take, to a log file, or to both.
#pragma once

#include "dsp/core/ring.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/take/take_writer.hpp"
#include "engine/take/timing_log.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::run {

/// For one thread at a time.
class Journal {
public:
    explicit Journal(take::TakeWriter* take) : take_(take) {}

    /// Starts a log file in addition to the take. Throws Error.
    void open(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds);
    /// Logs the decisions of a group, if a take or a log file is written. Before its thread starts.
    void attach(GroupRuntime& group);
    /// Frees the ring of a group that has ended.
    void detach(GroupRuntime& group);
    /// Writes the decisions that the groups have made so far.
    void drain(const std::vector<std::shared_ptr<GroupRuntime>>& groups);
    /// Completes the log file.
    void close();
    /// Keeps the log file as incomplete, without its end.
    void abandon() { file_.reset(); }
    /// Stops writing to the take.
    void forget_take() { take_ = nullptr; }
    bool is_used() const { return !rings_.empty(); }
    /// Reason why the log file is incomplete; empty if it is complete.
    const std::string& loss() const { return loss_; }

private:
    void write(const take::TimingRecord& record);

    take::TakeWriter* take_;
    std::vector<std::unique_ptr<Ring<take::TimingRecord>>> rings_;
    std::unique_ptr<take::TimingLogWriter> file_;
    std::string loss_;
};

}  // namespace tactus::run
