// SPDX-License-Identifier: Apache-2.0
// Records a run: timing decisions from the beginning, values while recording is on.
#pragma once

#include "engine/run/journal.hpp"
#include "engine/run/taps.hpp"

#include <mutex>
#include <string>

namespace tactus::run {

class Timeline;

/// Control thread, unless stated otherwise.
class Recorder {
public:
    Recorder(const EngineOptions& options, io::EngineHost& host, Losses& losses);

    take::TakeWriter* take() const { return take_; }
    /// Returns the stream for the outputs of a group in a new plan, or null. For the thread that builds the plan.
    RecordStream* stream_for(const io::FrameLayout& layout, const GroupRuntime& group);
    /// Adds the streams that the nodes of a new plan have opened to the run.
    void keep_opened();

    // Values.
    /// Starts or stops recording values, at a time slightly ahead that is the same for all groups. Throws Error if the
    /// take was abandoned.
    void want(bool wanted);
    bool is_recording() const { return take_ && wants_ && !take_->is_lost(); }
    /// True if a recording was requested.
    bool was_recorded() const { return was_recorded_; }
    /// Begins and ends recording. `is_building`: a plan is being built, which creates streams. `now`: logical time.
    void service(Timeline& timeline, bool is_building, Flicks now);

    // Decisions.
    /// Starts a log file in addition to the take. Throws Error.
    void open_log(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds);
    void close_log();
    /// Logs the decisions of a group, if a take or a log file is written. Before its thread starts.
    void attach(GroupRuntime& group) { journal_.attach(group); }
    /// Any thread, outside of the ticks.
    void drain_journal(const std::vector<std::shared_ptr<GroupRuntime>>& groups);
    void detach(GroupRuntime& group);
    /// Marks the journal as incomplete, so that the run cannot be repeated.
    void lose_journal(const std::string& why, bool is_asked_for);

    // Streams of nodes and of outputs.
    /// Any thread, outside of the ticks.
    void drain();
    void drain_full();
    /// Completes streams whose groups have all ended, and streams of nodes that are not in the plan.
    void finish_ended(const Timeline& timeline);
    /// Completes everything. After the run.
    void finish(const PortHashes& hashes);
    void note_losses();

private:
    void begin(Timeline& timeline, Flicks time);
    void end(Flicks now);
    void give_up(const std::string& why);
    /// Notes once that values ended by their limit.
    void note_limit();

    io::EngineHost& host_;
    Losses& losses_;
    take::TakeWriter* take_;
    const std::uint64_t longest_journal_;
    std::mutex journal_lock_;
    Journal journal_;  // under it
    Taps taps_;
    bool wants_ = false, records_ = true, was_recorded_ = false, has_noted_limit_ = false;
};

}  // namespace tactus::run
