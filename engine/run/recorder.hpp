// SPDX-License-Identifier: Apache-2.0
// Records a run: what timing decided from the beginning, values while they are wanted.
#pragma once

#include "engine/run/journal.hpp"
#include "engine/run/taps.hpp"

#include <mutex>
#include <string>

namespace tactus::run {

class Timeline;

/// Control thread, where nothing else is said.
class Recorder {
public:
    Recorder(const EngineOptions& options, io::EngineHost& host, Losses& losses);

    take::TakeWriter* take() const { return take_; }
    /// Where a new plan records the outputs of a group, or null. Whoever builds the plan.
    RecordStream* stream_for(const io::FrameLayout& layout, const GroupRuntime& group);
    /// What the nodes of a new plan opened belongs to the run from now on.
    void keep_opened();

    // Values.
    /// From a moment a little ahead on, the same for all groups, values are kept, or no more. Throws Error when the
    /// take was given up.
    void want(bool wanted);
    bool is_recording() const { return take_ && wants_ && !take_->is_lost(); }
    bool was_recorded() const { return was_recorded_; }
    /// Begins and ends recording. `is_building`: a plan is being built, which makes streams. `now`: logical time.
    void service(Timeline& timeline, bool is_building, Flicks now);

    // Decisions.
    /// Writes a log file from now on, beside the take. Throws Error.
    void open_log(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds);
    void close_log();
    /// Logs the decisions of a group, if anything is written. Before its thread starts.
    void attach(GroupRuntime& group) { journal_.attach(group); }
    /// Any thread, outside of the ticks.
    void drain_journal(const std::vector<std::shared_ptr<GroupRuntime>>& groups);
    void detach(GroupRuntime& group);
    /// The journal is not whole, so that the run cannot be repeated.
    void lose_journal(const std::string& why, bool is_asked_for);

    // Streams of nodes and of outputs.
    /// Any thread, outside of the ticks.
    void drain();
    void drain_full();
    /// Completes what only groups that are over wrote, and streams of nodes that are not in the plan.
    void finish_ended(const Timeline& timeline);
    /// Completes everything. After the run.
    void finish(const PortHashes& hashes);
    void note_losses();

private:
    void begin(Timeline& timeline, Flicks time);
    void end(Flicks now);
    void give_up(const std::string& why);

    io::EngineHost& host_;
    Losses& losses_;
    take::TakeWriter* take_;
    const std::uint64_t longest_journal_;
    std::mutex journal_lock_;
    Journal journal_;  // under it
    Taps taps_;
    bool wants_ = false, records_ = true, was_recorded_ = false;
};

}  // namespace tactus::run
