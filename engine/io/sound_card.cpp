// SPDX-License-Identifier: Apache-2.0
#include "engine/io/sound_card.hpp"

#include <algorithm>
#include <cstring>

namespace tactus::io {

SoundCard::SoundCard(std::unique_ptr<AudioSink> sink, Flicks period, double margin_s, int group)
    : sink_(std::move(sink)), period_(period), group_(group) {
    follower_.prepare(rate_of(period), margin_s);
}

bool SoundCard::write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept {
    static constexpr std::size_t piece = 256;
    static constexpr float silence[piece] = {};
    std::size_t lost = 0;
    if (expected_ < 0) {
        expected_ = first;
        shift_.store(first, std::memory_order_relaxed);
    }
    // What the ring has no room for is not worth writing as silence.
    auto gap = static_cast<std::size_t>(first - expected_);
    for (const std::size_t room = sink_->writable(); gap > room; gap = room) lost += gap - room;
    for (; gap > 0; gap -= std::min(gap, piece)) sink_->write(silence, std::min(gap, piece));
    const auto* from = static_cast<const std::byte*>(values);
    for (std::size_t done = 0; done < count;) {
        float block[piece];
        const std::size_t n = std::min(count - done, piece);
        for (std::size_t i = 0; i < n; ++i, from += stride) std::memcpy(&block[i], from, sizeof(float));
        lost += n - sink_->write(block, n);
        done += n;
    }
    expected_ = first + static_cast<std::int64_t>(count);
    if (lost > 0) shift_.fetch_add(static_cast<std::int64_t>(lost), std::memory_order_relaxed);
    return lost == 0;
}

bool SoundCard::service(std::int64_t now_ns, Flicks reached, control::TrimmedClock* clock) {
    const AudioProgress progress = sink_->progress();
    largest_ = progress.largest;
    if (progress.frames != seen_frames_ || seen_ns_ == 0) {
        seen_frames_ = progress.frames;
        seen_ns_ = std::max(progress.steady_ns, seen_ns_ == 0 ? now_ns : 0);
        lost_ = false;
    }
    // A server that waits for its clients may take its time.
    if (progress.waits) seen_ns_ = std::max(seen_ns_, now_ns - longest_silence_ns / 2);
    if (now_ns - seen_ns_ > longest_silence_ns) {
        if (lost_) return false;
        lost_ = true;
        ++losses_;
        if (!lost_at_) lost_at_ = reached;
        if (clock) clock->trim(now_ns, 1.0, 0.0);
        return true;
    }
    // A card whose node an edit took away has nothing to tell about the engine's time.
    const AudioStatistics statistics = sink_->statistics();
    if (statistics.frames_written != written_) written_ns_ = now_ns;
    written_ = statistics.frames_written;
    if (now_ns - written_ns_ > longest_silence_ns) return false;
    if (!clock || progress.waits || progress.taken == 0) return false;
    const auto left_out = static_cast<std::int64_t>(statistics.frames_left_out);
    // What is still to be left out counts as gone already.
    const std::int64_t next = progress.taken + shift_.load(std::memory_order_relaxed) + (skipped_ - left_out);
    const std::int64_t more =
        follower_.follow({progress.frames, next, progress.steady_ns, progress.largest}, now_ns, *clock);
    if (more > 0) {
        skipped_ += more;
        sink_->leave_out(more);
    }
    return false;
}

}  // namespace tactus::io
