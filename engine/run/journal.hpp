// SPDX-License-Identifier: Apache-2.0
// Collects what timing decided in each group and writes it to a take, to a log file, or to both.
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

/// One thread at a time.
class Journal {
public:
    explicit Journal(take::TakeWriter* take) : take_(take) {}

    /// Writes a log file from now on, beside the take. Throws Error.
    void open(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds);
    /// Logs the decisions of a group, if anything is written. Before its thread starts.
    void attach(GroupRuntime& group);
    /// The group is over: its ring is given back.
    void detach(GroupRuntime& group);
    /// Writes what the groups have decided by now.
    void drain(const std::vector<std::shared_ptr<GroupRuntime>>& groups);
    /// Completes the log file.
    void close();
    /// The log file stays as a part; its end is missing.
    void abandon() { file_.reset(); }
    /// Nothing more goes to the take.
    void forget_take() { take_ = nullptr; }
    bool is_used() const { return !rings_.empty(); }
    /// Why the log file is not complete; empty: it is.
    const std::string& loss() const { return loss_; }

private:
    void write(const take::TimingRecord& record);

    take::TakeWriter* take_;
    std::vector<std::unique_ptr<Ring<take::TimingRecord>>> rings_;
    std::unique_ptr<take::TimingLogWriter> file_;
    std::string loss_;
};

}  // namespace tactus::run
