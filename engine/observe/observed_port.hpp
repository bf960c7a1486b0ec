// SPDX-License-Identifier: Apache-2.0
// The run's side of an observer: the buffer into which the group's thread copies the values of one output. The writer
// never waits, never allocates and keeps no references; a reader that is too slow loses values.
#pragma once

#include "dsp/core/ring.hpp"
#include "dsp/core/time.hpp"
#include "engine/observe/seen_values.hpp"
#include "graph/node/value.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::observe {

/// Level of detail at which an output is observed.
enum class Watch : std::uint8_t {
    nothing,
    latest,  ///< the newest value; for a bone, all changes
    every,  ///< every value as well, if they are fetched in time
};

/// The newest value of an output: one writer, any number of readers; nobody waits. Wait-free for the
/// writer, lock-free for readers.
class LatestValue {
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

public:
    explicit LatestValue(std::size_t words) : words_(words) {}

    void write(const std::uint64_t* words) noexcept {
        const std::uint64_t before = sequence_.load(std::memory_order_relaxed);
        sequence_.store(before + 1, std::memory_order_relaxed);
        // Each word is released: a reader that loads a new word also loads the odd sequence number.
        for (std::size_t i = 0; i < words_.size(); ++i) words_[i].store(words[i], std::memory_order_release);
        sequence_.store(before + 2, std::memory_order_release);
    }
    /// Returns false if nothing was ever written, or if the writer interfered in every attempt.
    bool read(std::uint64_t* words) const noexcept;

private:
    std::atomic<std::uint64_t> sequence_{0};
    std::vector<std::atomic<std::uint64_t>> words_;
};

/// Detects the changed bricks of a bone and sends them through a ring. Bricks that do not fit are sent later.
class BoneFeed {
public:
    explicit BoneFeed(const volume::BoneSnapshot& initial);

    /// For the writer, once per activation. Wait-free. Returns false if the ring was full.
    bool see(std::int64_t index, const volume::BoneSnapshot& now, bool was_watched, Ring<std::byte>& ring) noexcept;

    /// An entry of the ring: a brick (`brick` ≥ 0), followed by its samples, or −1: all bricks of this version have
    /// been sent.
    struct Piece {
        std::int64_t index = 0, version = 0, brick = -1;
    };
    struct Brick {
        Piece piece;
        float samples[volume::brick_samples];
        float unused = 0.0f;  // makes the size a multiple of 8
    };

private:
    void mark(std::uint32_t brick) noexcept;

    // Largest number of bricks per activation for resending everything, in addition to those that just changed.
    static constexpr std::size_t catching_up = 64;

    std::vector<const float*> sent_;  // compared, never dereferenced
    std::vector<std::uint8_t> is_waiting_;
    std::vector<std::uint32_t> waiting_;
    std::size_t first_waiting_ = 0;
    std::int64_t version_;
    bool is_complete_ = false;
};

/// One output of one node of a run. Lives as long as the node; observers only hold a reference.
class ObservedPort {
public:
    struct Identity {
        std::string name;  ///< "node.port"
        Flicks period = 0;
        int max_frames = 1;
    };

    /// `initial`: the value that prepare set. `lossless`: nothing is lost if the reader drains whenever `pressing` is
    /// set.
    ObservedPort(Identity identity, const ValueType& type, const std::byte* initial, bool lossless,
                 std::atomic<bool>* pressing);

    const Identity identity;
    const ValueType& type;

    /// For the group's thread: adds the values of activations first, first + 1, …, `stride` bytes apart. Wait-free.
    void see(std::int64_t first, const std::byte* values, std::size_t count, std::ptrdiff_t stride) noexcept;

    // For any other thread:
    /// True after the first activation of its node.
    bool has_run() const noexcept { return has_run_.load(std::memory_order_acquire); }
    std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
    /// Bytes of a stored value, see `encode`; 0 if it is not stored as a value.
    std::size_t value_size() const { return value_size_; }
    /// Copies the newest value into `value` (value_size bytes) and its activation into `index`. Returns false if there
    /// is none yet.
    bool latest(std::byte* value, std::int64_t& index) const noexcept;

    // One at a time, guarded by the observer:
    void watch(Watch how);
    Watch watched() const { return static_cast<Watch>(watch_.load(std::memory_order_relaxed)); }

    /// An entry that the reader has taken out of the ring.
    struct Piece {
        std::int64_t index = 0;  ///< of the first value
        std::size_t count = 1;
        std::vector<std::byte> values;  ///< encoded
        std::int64_t version = 0, brick = -1;  ///< of a bone
        std::unique_ptr<float[]> samples;  ///< of a brick
    };
    /// Appends the entries that are in the ring.
    template <class Queue>
    void drain(Queue& into) {
        Piece piece;
        while (pop(piece)) into.push_back(std::move(piece));
    }

    std::unique_ptr<SeenBone> initial_bone;  ///< until an observer takes it
    /// The shape of a body; for a scene, the shapes of its initial bodies, such as a plan's fragments.
    std::vector<std::shared_ptr<const SeenBody>> bodies;
    std::vector<std::byte> initial_value;  ///< encoded

private:
    struct Head {
        std::int64_t first;
        std::uint64_t count;
    };

    void encode(const std::byte* value, std::byte* into) const noexcept;
    void send(std::int64_t first, const std::byte* values, std::size_t count, std::ptrdiff_t stride) noexcept;
    bool pop(Piece& piece);
    void make_ring();

    std::size_t value_size_ = 0;
    const bool lossless_;
    std::atomic<bool>* pressing_;
    std::atomic<std::uint8_t> watch_{0};
    std::atomic<bool> has_run_{false};
    std::atomic<std::uint64_t> lost_{0};
    std::unique_ptr<LatestValue> latest_;
    std::unique_ptr<BoneFeed> feed_;
    bool was_watched_ = true;  // group's thread: every version so far was compared
    std::unique_ptr<Ring<std::byte>> owned_ring_;
    std::atomic<Ring<std::byte>*> ring_{nullptr};
    std::vector<std::byte> packed_;
    std::vector<std::uint64_t> words_;
};

}  // namespace tactus::observe
