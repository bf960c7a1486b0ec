// SPDX-License-Identifier: Apache-2.0
// The wires from one group to another: rings of slots, guarded by the progress counters of both groups. When a plan
// replaces another, a link may continue one of the previous plan: values published before the switch are still read
// from there.
#pragma once

#include "graph/compile/schedule.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace tactus::run {

class GroupRuntime;

/// One wire between two groups. Both groups use its ring; all other members belong to the consumer.
struct LinkWire {
    const ValueType* type = nullptr;
    const Output* source = nullptr;
    Input* target = nullptr;   ///< or null; then:
    Param* param = nullptr;
    patch::WireMode mode = patch::WireMode::hold;
    LinkWire* before = nullptr;                ///< the same wire in the link that this one continues
    bool starts_from_output = true;            ///< index −1 is the value from prepare; otherwise the type's default
    std::vector<std::byte> ring;               ///< depth values
    std::vector<std::byte> current, previous;  ///< values of the used index and of the one before it
    std::vector<std::byte> glide;  ///< one value per activation of a call, if it may change within a call
    std::vector<std::byte> batch;  ///< for `batch`: the values of a call and their times
    std::vector<Flicks> batch_times;
    int batch_count = 0;           ///< in `batch`
    std::vector<int> batch_counts;  ///< per activation of a call; for values that come within a call, and for events
    std::string name;  ///< for events: name of the output
    int delay = 0;     ///< for events: activations of the producer
    /// For events: `end` events of publications that did not fit, and the number of other events dropped with them.
    /// They are sent with the next publication that fits. Used by the producer.
    std::unique_ptr<Events> carried;

    bool brings_events() const noexcept { return carried != nullptr; }
    /// Points an input to the values.
    void point(Input& input, Flicks producer_period) const;

    std::byte* slot(std::int64_t index, std::int64_t depth) {
        return ring.data() + static_cast<std::size_t>(index % depth) * type->size;
    }
};

/// All wires of equal latency from one group to another. They are published and read together.
class Link {
public:
    const GroupRuntime *producer = nullptr, *consumer = nullptr;
    int id = 0;
    Flicks producer_period = 0, consumer_period = 0, latency = 0;
    /// True if values change so often that one call of the consumer, an audio group, reads several. Otherwise calls are
    /// split where a new value is due.
    bool changes_within_calls = false;
    std::vector<LinkWire> wires;
    /// The link of the previous plan that this one continues. It must live until `settled` and one call of the
    /// producer.
    Link* continued = nullptr;

    /// The longest calls of both groups, in activations.
    struct CallLengths {
        int producer = 1, consumer = 1;
    };
    /// Fixes the depth of the rings and takes the outputs' present values as index −1. `slack` is how late, in flicks,
    /// the consumer may run before publications are dropped; `live` are the calls of a live run, `here` those of this one;
    /// `first` the first index that will be published, `unknown` if the producer sets it by `begin_at`.
    ///
    /// The depth is a multiple of that in a live run: two indices that share a slot then share one in the live run, too. So
    /// a repetition in longer calls has room wherever the live run had, also after publications that were dropped.
    void prepare(Flicks slack, CallLengths live, CallLengths here, std::int64_t first = 0);

    /// Index that consumer activation `j` reads when nothing is late.
    std::int64_t wanted(std::int64_t j) const {
        return compile::source_index(j, consumer_period, latency, producer_period);
    }
    /// First activation after `j` that reads another index.
    std::int64_t window_end(std::int64_t j) const { return first_after(wanted(j)); }
    /// First activation that reads an index after `index`.
    std::int64_t first_after(std::int64_t index) const {
        return ceil_div((index + 1) * producer_period + latency, consumer_period);
    }
    /// In live runs: largest number of activations per call of the consumer, so that the producer has time to compute
    /// the last one's value.
    std::int64_t longest_call() const { return longest_call_; }

    // Producer's side.
    /// Publications here start at `index`. Wait-free.
    void begin_at(std::int64_t index) noexcept;
    /// True when the slots of indices first … first + count − 1 are released. Wait-free.
    bool has_room(std::int64_t first, int count) const noexcept {
        const std::int64_t oldest = oldest_.load(std::memory_order_acquire);
        // Without gaps, slots are used in turn.
        if (first + count - 1 - depth_ < std::max(oldest, first_.load(std::memory_order_relaxed) - 1)) return true;
        for (int i = 0; i < count; ++i)
            if (const std::int64_t there = stamp(first + i).load(std::memory_order_relaxed);
                there >= 0 && there >= oldest)
                return false;
        return true;
    }
    /// Copies the outputs' values into the slots. The group's progress counter publishes them. Returns the number of
    /// dropped events. Wait-free.
    std::int64_t publish(std::int64_t first, int count) noexcept;
    /// Instead of `publish`: publishes nothing, but keeps the `end` events for the next time. Returns the number of
    /// dropped events. Wait-free.
    std::int64_t drop(int count) noexcept;
    /// Smallest version of `output` that the consumer may still use, or INT64_MAX if this link carries none.
    std::int64_t oldest_version(const Output* output) const noexcept;

    /// Checks the values of these wires (`bits`: a set of `bit_of`) from the next publication on. Wires to parameters
    /// are exempt, because a parameter keeps its last value when the new one is not finite. Any thread; wait-free.
    void watch(std::uint64_t bits) noexcept { watched_.fetch_or(bits, std::memory_order_relaxed); }
    /// True if one of the watched wires has a value that is not finite and that the consumer may still read. Any
    /// thread; wait-free.
    bool is_unusable(std::uint64_t bits) const noexcept {
        return (unusable_.load(std::memory_order_relaxed) & bits) != 0;
    }
    /// Wires from the 63rd on have a common bit.
    static constexpr std::uint64_t bit_of(std::size_t wire) {
        return std::uint64_t{1} << std::min<std::size_t>(wire, 63);
    }

    /// True if a wire of this link, or of one that it continues, carries values of `output`. Call before the producer
    /// uses the link.
    bool may_hold(const Output* output) const noexcept;

    // Consumer's side.
    /// The consumer reads from this link from now on. Wait-free.
    void take_over() noexcept;
    /// The consumer will not read from this link again. Wait-free.
    void abandon() noexcept;
    /// True if reading an older index than `want` counts as a miss; false before the first publication of a link that
    /// continues none.
    bool misses(std::int64_t want) const noexcept {
        const std::int64_t first = first_.load(std::memory_order_acquire);
        return continues_ || first == unknown || want >= first;
    }
    /// Newest index ≤ `want` and < `done` that was published and not dropped, or the one in use. Wait-free.
    std::int64_t newest_available(std::int64_t want, std::int64_t done) const noexcept;
    /// Moves to the values of `index` (≥ the current one) and releases older ones. Wait-free.
    void read(std::int64_t index) noexcept;
    /// Points inputs to the values for the call of activations j … j + frames − 1. Wait-free.
    void deliver(std::int64_t j, int frames) noexcept;
    /// The same for a part of a call, which reads `index`: activations from … from + frames − 1 of the call, the first
    /// of which has number j. Values read by the first part are kept until `end_call`. Wait-free.
    void deliver_part(std::int64_t index, std::int64_t j, int from, int frames) noexcept;
    /// Ends a call in parts: only the current value is kept. So the room for the producer depends on the activations
    /// that ran, not on their division into calls. Wait-free.
    void end_call() noexcept { hold_from(used_); }

    std::int64_t used() const { return used_; }
    std::int64_t depth() const { return depth_; }
    /// True when `continued` is no longer read. Any thread.
    bool settled() const noexcept { return settled_.load(std::memory_order_acquire); }

    /// Removes the reference to the previous plan, which is being destroyed; only when settled. Control thread.
    void forget_continued() { continued = nullptr; }

    static constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();

private:
    bool holds(std::int64_t index) const noexcept;
    std::int64_t newest_held(std::int64_t newest) const noexcept;
    std::atomic<std::int64_t>& stamp(std::int64_t index) { return stamp_[static_cast<std::size_t>(index % depth_)]; }
    const std::atomic<std::int64_t>& stamp(std::int64_t index) const {
        return stamp_[static_cast<std::size_t>(index % depth_)];
    }
    const std::byte* value(const LinkWire& wire, std::int64_t index) const noexcept;
    void hold_from(std::int64_t index) noexcept;
    void take_values(std::int64_t index) noexcept;
    void note_unusable(std::int64_t first, int count) noexcept;
    std::int64_t publish_events(LinkWire& wire, std::int64_t first, int count) noexcept;
    void interpolate(LinkWire& wire, std::int64_t j, int from, int frames) const noexcept;
    /// Lists the indices between the current one and `newest`, in order.
    void list_held(std::int64_t newest) noexcept;
    /// Appends the listed values.
    void gather_batch(LinkWire& wire) noexcept;

    std::int64_t depth_ = 0, longest_call_ = 1;
    /// Index whose values are in each slot, −1: none. The producer's progress counter publishes them to the reader.
    std::vector<std::atomic<std::int64_t>> stamp_;
    std::vector<std::int64_t> held_;  ///< consumer's list of indices; empty if no wire is a batch
    std::size_t held_count_ = 0;
    std::int64_t used_ = -1;
    bool fresh_ = false;  ///< `read` was called since the last `deliver`
    bool continues_ = false;  ///< consumer's: values before `first_` are read from `continued`
    std::atomic<std::uint64_t> watched_{0};  ///< wires that lead to a force
    std::atomic<std::uint64_t> unusable_{0};  ///< those of them that `is_unusable` reports
    std::uint64_t last_unusable_ = 0;  // producer's: wires whose last publication is not finite
    std::int64_t unusable_until_ = 0;  // producer's: index from which it is no longer reported
    std::atomic<bool> settled_{true};
    std::atomic<std::int64_t> first_{0};  ///< first index published here; `unknown` before the producer's switch
    alignas(64) std::atomic<std::int64_t> oldest_{-1};  ///< oldest index that the consumer may still read
};

}  // namespace tactus::run
