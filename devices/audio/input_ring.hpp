// SPDX-License-Identifier: Apache-2.0
// The newest input frames of a card, passed from its callback to the thread of a group. The callback never waits and
// overwrites the oldest frames; a reader checks after copying whether the frames were overwritten meanwhile.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::audio {

class InputRing {
public:
    /// State of the card at its last callback.
    struct View {
        std::int64_t captured = 0;  ///< frames since the card was opened
        std::int64_t steady_ns = 0;  ///< time of the last callback
        std::int64_t largest = 0;  ///< largest number of frames in one callback
    };

    InputRing(int channels, std::size_t frames)
        : channels_(static_cast<std::size_t>(channels)), frames_(frames), samples_(channels_ * frames) {}

    int channels() const noexcept { return static_cast<int>(channels_); }
    std::int64_t capacity() const noexcept { return static_cast<std::int64_t>(frames_); }

    /// The card's thread; wait-free. Null `interleaved`: the card delivered nothing, which counts as silence.
    /// `overflowed`: the card reports that it lost frames before these.
    void capture(const float* interleaved, std::size_t count, std::int64_t steady_ns, bool overflowed) noexcept {
        const std::int64_t first = captured_.load(std::memory_order_relaxed);
        const auto more = static_cast<std::int64_t>(count);
        writing_until_.store(first + more, std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_release);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t at = (static_cast<std::size_t>(first) + i) % frames_ * channels_;
            for (std::size_t c = 0; c < channels_; ++c)
                samples_[at + c].store(interleaved ? interleaved[i * channels_ + c] : 0.0F, std::memory_order_relaxed);
        }
        if (overflowed) overflows_.store(overflows_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        largest_.store(std::max(largest_.load(std::memory_order_relaxed), more), std::memory_order_relaxed);
        steady_ns_.store(steady_ns, std::memory_order_relaxed);
        captured_.store(first + more, std::memory_order_release);
    }

    /// Any thread; wait-free, because a reader may have a higher priority than the card. The time may belong to a
    /// callback that is not in `captured` yet.
    View view() const noexcept {
        View now;
        now.captured = captured_.load(std::memory_order_acquire);
        now.largest = largest_.load(std::memory_order_relaxed);
        now.steady_ns = steady_ns_.load(std::memory_order_relaxed);
        return now;
    }

    /// Copies frames first … first + count − 1 of one channel. Returns false if some are not available yet, or no
    /// longer. Any thread; wait-free.
    bool read(std::int64_t first, std::size_t count, int channel, float* into) const noexcept {
        const auto more = static_cast<std::int64_t>(count);
        if (first < 0 || first + more > captured_.load(std::memory_order_acquire)) return false;
        for (std::size_t i = 0; i < count; ++i)
            into[i] = samples_[(static_cast<std::size_t>(first) + i) % frames_ * channels_ +
                               static_cast<std::size_t>(channel)]
                          .load(std::memory_order_relaxed);
        std::atomic_thread_fence(std::memory_order_acquire);
        return first >= writing_until_.load(std::memory_order_relaxed) - capacity();
    }

    /// Number of overflows that the card has reported. Any thread.
    std::uint64_t overflows() const noexcept { return overflows_.load(std::memory_order_relaxed); }

private:
    std::size_t channels_, frames_;
    std::vector<std::atomic<float>> samples_;
    std::atomic<std::int64_t> captured_{0}, writing_until_{0}, steady_ns_{0}, largest_{0};
    std::atomic<std::uint64_t> overflows_{0};
};

}  // namespace tactus::audio
