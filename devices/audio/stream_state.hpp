// SPDX-License-Identifier: Apache-2.0
// State common to the engine's thread and the card's callback.
#pragma once

#include "dsp/core/ring.hpp"
#include "graph/node/device.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tactus::audio {

/// A ring of interleaved frames for a card, with statistics.
class StreamState {
    static_assert(std::atomic<std::int64_t>::is_always_lock_free);

public:
    /// Capacity: at least `frames`. Playback starts when the ring holds `start` frames more than the card requests.
    StreamState(int channels, std::size_t frames, std::size_t start = 0)
        : channels_(static_cast<std::size_t>(channels)),
          start_(start),
          ring_(std::max<std::size_t>(frames, 1) * channels_) {}

    /// Accepts as many whole frames as fit. One writing thread; wait-free.
    std::size_t write(const float* interleaved, std::size_t frames) noexcept {
        const std::size_t accepted = std::min(frames, writable());
        ring_.push(interleaved, accepted * channels_);
        add(written_, accepted);
        add(dropped_, frames - accepted);
        return accepted;
    }
    std::size_t writable() const noexcept { return ring_.space() / channels_; }
    /// Any thread; wait-free.
    void leave_out(std::int64_t frames) noexcept { unwanted_.fetch_add(frames, std::memory_order_relaxed); }
    /// Marks the end of the sound: the rest is played, and silence after it does not count as underflow. Any thread.
    void end() noexcept { ending_.store(true, std::memory_order_release); }
    bool is_ending() const noexcept { return ending_.load(std::memory_order_acquire); }
    bool is_empty() const noexcept { return ring_.size() == 0; }

    /// Returns true if `feed` would find that many frames, or if silence is due. The card's thread; wait-free.
    bool can_feed(std::size_t frames) const noexcept {
        if (is_ending() || written_.load(std::memory_order_relaxed) == 0) return true;
        const auto skipped = static_cast<std::size_t>(unwanted_.load(std::memory_order_relaxed) - left_out_);
        return ring_.size() / channels_ >= enough(frames) + skipped;
    }

    /// Fills the card's buffer at `steady_ns`, with silence for missing frames. Silence before the start of playback is
    /// not an underflow. The card's thread; wait-free.
    void feed(float* output, std::size_t frames, std::int64_t steady_ns) noexcept {
        const std::size_t wanted = frames * channels_;
        is_playing_ = is_playing_ || is_ending() ||
                      (written_.load(std::memory_order_relaxed) > 0 && ring_.size() / channels_ >= enough(frames));
        throw_away(output, wanted);
        const std::size_t got = is_playing_ ? ring_.pop(output, wanted) : 0;
        std::fill(output + got, output + wanted, 0.0F);
        if (is_playing_ && got < wanted && !is_ending()) {
            add(underflows_, 1);
            add(underflowed_, (wanted - got) / channels_);
        }
        taken_count_ += static_cast<std::int64_t>(got / channels_);
        largest_count_ = std::max(largest_count_, static_cast<std::int64_t>(frames));
        // A sequence lock: readers accept the values only between two equal even versions.
        const std::uint64_t version = version_.load(std::memory_order_relaxed);
        version_.store(version + 1, std::memory_order_relaxed);
        frames_.store(frames_.load(std::memory_order_relaxed) + static_cast<std::int64_t>(frames),
                      std::memory_order_release);
        steady_ns_.store(steady_ns, std::memory_order_release);
        taken_.store(taken_count_, std::memory_order_release);
        largest_.store(largest_count_, std::memory_order_release);
        version_.store(version + 2, std::memory_order_release);
    }

    /// Any thread. Lock-free: retries only when a callback wrote in between.
    AudioProgress progress() const noexcept {
        for (;;) {
            const std::uint64_t version = version_.load(std::memory_order_acquire);
            const AudioProgress now{frames_.load(std::memory_order_acquire), steady_ns_.load(std::memory_order_acquire),
                                    taken_.load(std::memory_order_acquire), largest_.load(std::memory_order_acquire),
                                    false};
            if (version % 2 == 0 && version_.load(std::memory_order_relaxed) == version) return now;
        }
    }

    /// Any thread; wait-free.
    AudioStatistics statistics() const noexcept {
        return {written_.load(std::memory_order_relaxed), dropped_.load(std::memory_order_relaxed),
                underflowed_.load(std::memory_order_relaxed), underflows_.load(std::memory_order_relaxed),
                frames_left_out_.load(std::memory_order_relaxed)};
    }

private:
    using Count = std::atomic<std::uint64_t>;

    /// Each count has one writer, so a plain load and store suffice.
    static void add(Count& count, std::uint64_t more) noexcept {
        count.store(count.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
    }

    /// Number of frames that the ring must hold for playback; after the start, the number that the callback requests.
    std::size_t enough(std::size_t frames) const noexcept {
        if (is_playing_) return frames;
        return start_ == 0 ? 1 : std::min(start_ + frames, ring_.capacity() / channels_);
    }

    /// Discards frames by reading them into the card's buffer.
    void throw_away(float* output, std::size_t room) noexcept {
        std::int64_t left = is_playing_ ? unwanted_.load(std::memory_order_relaxed) - left_out_ : 0;
        while (left > 0) {
            const std::size_t got = ring_.pop(output, std::min(room, static_cast<std::size_t>(left) * channels_));
            if (got == 0) break;
            const auto frames = static_cast<std::int64_t>(got / channels_);
            left -= frames;
            left_out_ += frames;
            taken_count_ += frames;
            add(frames_left_out_, static_cast<std::uint64_t>(frames));
        }
    }

    std::size_t channels_, start_;
    Ring<float> ring_;
    Count written_{0}, dropped_{0}, underflowed_{0}, underflows_{0}, frames_left_out_{0}, version_{0};
    std::atomic<std::int64_t> frames_{0}, steady_ns_{0}, taken_{0}, largest_{0}, unwanted_{0};
    std::atomic<bool> ending_{false};
    // The card's thread.
    std::int64_t taken_count_ = 0, largest_count_ = 0, left_out_ = 0;
    bool is_playing_ = false;
};

}  // namespace tactus::audio
