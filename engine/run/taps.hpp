// SPDX-License-Identifier: Apache-2.0
// The streams that keep every value of every output, one for each group, while values are recorded.
#pragma once

#include "engine/run/losses.hpp"
#include "engine/run/options.hpp"

#include <list>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

namespace tactus::run {

/// Control thread, `drain` apart.
class Taps {
public:
    explicit Taps(TapMaker make) : make_(std::move(make)) {}

    /// The stream of a group whose outputs have that layout; made when there is none. Null: the maker wants none.
    /// Whoever builds a plan calls it.
    RecordStream* get(const io::FrameLayout& layout, const GroupRuntime& group);
    /// Makes what `get` has added known to the other functions.
    void update();
    /// The streams keep values from a logical time on, or until one; then they belong to a stretch that ends.
    void begin_at(Flicks from);
    void end_at(Flicks until);
    /// Completes those whose stretch is over.
    void finish_past();
    /// Completes those whose group is over, and those that no program writes to any more: an edit changed the outputs.
    void finish_ended(const std::unordered_set<const RecordStream*>& in_use);
    /// Completes all. After the run.
    void finish();

    /// Any thread, outside of the ticks.
    void drain();
    void drain_full();

    void note_losses(Losses& losses) const;
    /// Values that a slow disk lost. After `finish`.
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
