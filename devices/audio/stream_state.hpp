// SPDX-License-Identifier: Apache-2.0
// What the engine's thread and the card's callback share.
#pragma once

#include "dsp/core/ring.hpp"
#include "graph/device.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tactus {

/// Interleaved frames on their way to a card, and what happened to them.
class StreamState {
    static_assert(std::atomic<std::int64_t>::is_always_lock_free);

public:
    StreamState(int channels, std::size_t frames)
        : channels_(static_cast<std::size_t>(channels)), ring_(std::max<std::size_t>(frames, 1) * channels_) {}

    /// Accepts whole frames as far as there is room. One writing thread; wait-free.
    std::size_t write(const float* interleaved, std::size_t frames) noexcept {
        const std::size_t accepted = std::min(frames, writable());
        ring_.push(interleaved, accepted * channels_);
        add(written_, accepted);
        add(dropped_, frames - accepted);
        return accepted;
    }
    std::size_t writable() const noexcept { return ring_.space() / channels_; }

    /// Fills what the card asks for at `steady_ns`, with silence where nothing is there. Silence before the first
    /// frame was written is no underflow. The card's thread; wait-free.
    void feed(float* output, std::size_t frames, std::int64_t steady_ns) noexcept {
        const std::size_t wanted = frames * channels_, got = ring_.pop(output, wanted);
        std::fill(output + got, output + wanted, 0.0F);
        if (got < wanted && written_.load(std::memory_order_relaxed) > 0) {
            add(underflows_, 1);
            add(underflowed_, (wanted - got) / channels_);
        }
        // Readers take the pair only between two equal even versions.
        const std::uint64_t version = version_.load(std::memory_order_relaxed);
        version_.store(version + 1, std::memory_order_relaxed);
        frames_.store(frames_.load(std::memory_order_relaxed) + static_cast<std::int64_t>(frames),
                      std::memory_order_release);
        steady_ns_.store(steady_ns, std::memory_order_release);
        version_.store(version + 2, std::memory_order_release);
    }

    /// Any thread. Lock-free: repeats only when a callback came in between.
    AudioProgress progress() const noexcept {
        for (;;) {
            const std::uint64_t version = version_.load(std::memory_order_acquire);
            const AudioProgress now{frames_.load(std::memory_order_acquire),
                                    steady_ns_.load(std::memory_order_acquire)};
            if (version % 2 == 0 && version_.load(std::memory_order_relaxed) == version) return now;
        }
    }

    /// Any thread; wait-free.
    AudioStatistics statistics() const noexcept {
        return {written_.load(std::memory_order_relaxed), dropped_.load(std::memory_order_relaxed),
                underflowed_.load(std::memory_order_relaxed), underflows_.load(std::memory_order_relaxed)};
    }

private:
    using Count = std::atomic<std::uint64_t>;

    /// Each count has one writer, so a plain load and store suffice.
    static void add(Count& count, std::uint64_t more) noexcept {
        count.store(count.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
    }

    std::size_t channels_;
    Ring<float> ring_;
    Count written_{0}, dropped_{0}, underflowed_{0}, underflows_{0}, version_{0};
    std::atomic<std::int64_t> frames_{0}, steady_ns_{0};
};

}  // namespace tactus
