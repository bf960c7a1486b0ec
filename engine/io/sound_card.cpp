// SPDX-License-Identifier: Apache-2.0
#include "engine/io/sound_card.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace tactus::io {

bool SoundChannel::write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept {
    return card_.write(index_, first, values, count, stride);
}

SoundCard::SoundCard(std::unique_ptr<AudioSink> sink, CardUse use, std::shared_ptr<audio::InputRing> inputs)
    : sink_(std::move(sink)), use_(std::move(use)), is_played_(use_.is_played) {
    follower_.prepare(rate_of(use_.period), use_.margin_s);
    if (inputs) input_.emplace(std::move(inputs), rate(), use_.margin_s);
}

void SoundCard::hear(int channel, std::int64_t first, float* into, std::size_t count, std::int64_t due_ns) noexcept {
    input_->read(channel, first, into, count, due_ns);
    if (first == heard_) return;
    heard_ = first;
    // Nodes write after the input of a call was read. An edit can add the first player or remove the last.
    if (std::exchange(is_played_, false)) return;
    static constexpr float silence[256] = {};
    const std::int64_t end = first + static_cast<std::int64_t>(count);
    for (std::int64_t at = first; at < end; at += std::ssize(silence))
        put(0, at, silence, static_cast<std::size_t>(std::min(end - at, std::ssize(silence))), sizeof(float));
}

void SoundCard::open(const std::vector<std::string>& names) {
    sink_->prepare(rate(), names);
    gather_.resize(static_cast<int>(names.size()), use_.max_frames);
}

SoundChannel& SoundCard::channel(int index) {
    for (const auto& known : listed_)
        if (known->index() == index) return *known;
    return *listed_.emplace_back(std::make_unique<SoundChannel>(*this, index));
}

bool SoundCard::write(int channel, std::int64_t first, const void* values, std::size_t count,
                      std::ptrdiff_t stride) noexcept {
    is_played_ = true;
    return put(channel, first, values, count, stride);
}

bool SoundCard::put(int channel, std::int64_t first, const void* values, std::size_t count,
                    std::ptrdiff_t stride) noexcept {
    const auto* from = static_cast<const std::byte*>(values);
    bool fits = true;
    while (count > 0) {
        const std::size_t n = std::min(count, gather_.max_frames());
        if (gather_.is_blocked(channel, first, n)) fits = flush() && fits;
        if (gather_.put(channel, first, from, n, stride)) fits = flush() && fits;
        from += static_cast<std::ptrdiff_t>(n) * stride;
        first += static_cast<std::int64_t>(n);
        count -= n;
    }
    return fits;
}

bool SoundCard::flush() noexcept {
    std::int64_t first = 0;
    const std::span<const float> block = gather_.take(first);
    return write_frames(first, block.data(), block.size() / static_cast<std::size_t>(channels()));
}

bool SoundCard::write_frames(std::int64_t first, const float* frames, std::size_t count) noexcept {
    static constexpr std::size_t piece = 256;
    static constexpr float silence[piece] = {};
    const std::size_t max_silent = piece / static_cast<std::size_t>(channels());
    std::size_t lost = 0;
    if (expected_ < 0) {
        expected_ = first;
        shift_.store(first, std::memory_order_relaxed);
    }
    // What the ring has no room for is not worth writing as silence.
    auto gap = static_cast<std::size_t>(first - expected_);
    for (const std::size_t room = sink_->writable(); gap > room; gap = room) lost += gap - room;
    for (; gap > 0; gap -= std::min(gap, max_silent)) sink_->write(silence, std::min(gap, max_silent));
    lost += count - sink_->write(frames, count);
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
    // A card whose node was removed by an edit no longer drives the engine's clock.
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
