// SPDX-License-Identifier: Apache-2.0
// Interleaves the channels of a card, each of which is written by a different node.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace tactus::io {

/// Gathers one block of samples per channel into interleaved frames. All calls come from the thread of one group, which
/// calls its nodes in sequence with the same activations. Only `resize` allocates.
///
/// A block is complete when every channel has written that wrote the previous block; the first block requires all
/// expected channels. A channel that misses its block (an edit removed its node) is silent and is not required for the
/// next one. A channel that comes too late (a new node) is silent for one block and required from then on.
class ChannelGather {
public:
    static constexpr int max_channels = 64;

    /// Call before the first sample, or after `take`.
    void resize(int channels, int max_frames) {
        channels_ = static_cast<std::size_t>(channels);
        max_frames_ = static_cast<std::size_t>(std::max(max_frames, 1));
        frames_.assign(channels_ * max_frames_, 0.0F);
    }
    int channels() const noexcept { return static_cast<int>(channels_); }
    std::size_t max_frames() const noexcept { return max_frames_; }
    /// Requires this channel from the first block on. Call before the first sample.
    void expect(int channel) noexcept { expected_ |= bit(channel); }

    /// Returns true if the current block must be removed by `take` before `count` samples of that channel fit.
    bool is_blocked(int channel, std::int64_t first, std::size_t count) const noexcept {
        return count_ > 0 && (first != first_ || count != count_ || (written_ & bit(channel)) != 0);
    }

    /// Adds samples of the activations first, first + 1, …, `stride` bytes apart; at most `max_frames`. Returns true
    /// when the block is complete.
    bool put(int channel, std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept {
        if (first < next_) {  // the block went without this channel
            expected_ |= bit(channel);
            return false;
        }
        if (count_ == 0) {
            first_ = first;
            count_ = count;
            std::fill_n(frames_.begin(), static_cast<std::ptrdiff_t>(count * channels_), 0.0F);
        }
        const auto* from = static_cast<const std::byte*>(values);
        float* to = frames_.data() + channel;
        for (std::size_t i = 0; i < count; ++i, from += stride, to += channels_) std::memcpy(to, from, sizeof(float));
        written_ |= bit(channel);
        return (written_ & expected_) == expected_;
    }

    /// Returns the block's frames, valid until the next `put`; `first`: the activation of the first one.
    std::span<const float> take(std::int64_t& first) noexcept {
        first = first_;
        const std::span<const float> block(frames_.data(), count_ * channels_);
        if (count_ > 0) {
            expected_ = written_;
            next_ = first_ + static_cast<std::int64_t>(count_);
        }
        written_ = 0;
        count_ = 0;
        return block;
    }

private:
    static constexpr std::uint64_t bit(int channel) noexcept { return std::uint64_t{1} << channel; }

    std::size_t channels_ = 1, max_frames_ = 1, count_ = 0;
    std::vector<float> frames_;
    std::int64_t first_ = 0, next_ = INT64_MIN;
    std::uint64_t written_ = 0, expected_ = 0;
};

}  // namespace tactus::io
