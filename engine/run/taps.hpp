// SPDX-License-Identifier: Apache-2.0
// The streams that record every value of every output, one for each group, while values are recorded.
#pragma once

#include "engine/run/losses.hpp"
#include "engine/run/options.hpp"

#include <list>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

namespace tactus::run {

/// Control thread, except for `drain`.
class Taps {
public:
    explicit Taps(TapMaker make) : make_(std::move(make)) {}

    /// Returns the stream of a group with that layout of outputs; creates it if needed. Returns null if the maker
    /// returns none. For the thread that builds a plan.
    RecordStream* get(const io::FrameLayout& layout, const GroupRuntime& group);
    /// Publishes the streams that `get` has added to the other functions.
    void update();
    /// Sets the logical time from which, or until which, the streams record. The latter ends their stretch.
    void begin_at(Flicks from);
    void end_at(Flicks until);
    /// Completes the streams whose stretch is over.
    void finish_past();
    /// Completes the streams whose group has ended, and those without a writer because an edit changed the outputs.
    void finish_ended(const std::unordered_set<const RecordStream*>& in_use);
    /// Completes all streams. After the run.
    void finish();

    /// Any thread, outside of the ticks.
    void drain();
    void drain_full();

    void note_losses(Losses& losses) const;
    /// Reports the values lost to a slow disk. After `finish`.
    void note_drops(Losses& losses) const;

private:
    struct Tap {
        std::unique_ptr<io::Stream> stream;
        const GroupRuntime* group;
        io::FrameLayout layout;
    };
    TapMaker make_;
    std::list<Tap> taps_;  // one writing thread each
    std::vector<Tap> ending_;  // of stretches that are over
    std::vector<io::Stream*> open_;  // those that may still be written
};

}  // namespace tactus::run
