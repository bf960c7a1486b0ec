// SPDX-License-Identifier: Apache-2.0
// Sound cards of a live run. Signals are written directly to their rings, the run's clock follows the first card, and a
// card that stops requesting frames is detected.
#pragma once

#include "dsp/control/card_follower.hpp"
#include "engine/io/card_input.hpp"
#include "engine/io/channel_gather.hpp"
#include "graph/node/device.hpp"
#include "graph/node/setup.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::io {

class SoundCard;

/// A channel of a card.
class SoundChannel : public RecordStream {
public:
    SoundChannel(SoundCard& card, int index) : card_(card), index_(index) {}
    bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept override;

    SoundCard& card() const { return card_; }
    int index() const { return index_; }  ///< from 0

private:
    SoundCard& card_;
    int index_;
};

/// Configuration of a card.
struct CardUse {
    Flicks period = 0;
    double margin_s = 0.0;  ///< buffered sound in the ring
    int group = 0;  ///< the only group whose thread writes
    std::string wanted = {};  ///< the text by which the card was chosen
    bool is_shared = false;  ///< several nodes write to it, each to its own channel
    int max_frames = 256;  ///< most samples per write
    bool is_played = true;  ///< false: initially, nodes only record from it
};

class SoundCard {
public:
    /// `inputs`: ring that the card's callback fills, or null.
    SoundCard(std::unique_ptr<AudioSink> sink, CardUse use, std::shared_ptr<audio::InputRing> inputs = {});

    /// Thread of the group. Activations that never ran become silence; samples that do not fit are dropped and counted.
    bool write(int channel, std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept;

    /// Thread of the group. Reads channel `channel` for activations first … first + count − 1, which were due at
    /// `due_ns`; wait-free. While no node writes, silence is played, so that the clock follows the card.
    void hear(int channel, std::int64_t first, float* into, std::size_t count, std::int64_t due_ns) noexcept;

    // Control thread.
    int inputs() const { return input_ ? input_->channels() : 0; }
    const CardInput* input() const { return input_ ? &*input_ : nullptr; }
    /// Opens the card with one channel per name. Patch bays show the names that are not empty. Throws Error.
    void open(const std::vector<std::string>& names);
    int channels() const { return gather_.channels(); }
    /// `index`: from 0, below `channels()`.
    SoundChannel& channel(int index);
    /// The first frame requires these channels. Call before the first sample.
    void expect(int index) { gather_.expect(index); }
    /// Checks the state of the card. Trims `clock`, if given, by its value at `now_ns`. `reached`: logical time.
    /// Returns true once when the card is found to be lost: no callback came for `longest_silence_ns`.
    bool service(std::int64_t now_ns, Flicks reached, control::TrimmedClock* clock);
    void close() { sink_->close(); }

    const std::string& name() const { return sink_->name(); }
    double rate() const { return rate_of(use_.period); }
    const CardUse& use() const { return use_; }
    AudioStatistics statistics() const { return sink_->statistics(); }
    const control::CardFollower& follower() const { return follower_; }
    std::int64_t largest_callback() const { return largest_; }
    bool is_lost() const { return lost_; }  ///< from any thread
    /// Logical time of the first loss.
    const std::optional<Flicks>& lost_at() const { return lost_at_; }
    int losses() const { return losses_; }

    static constexpr std::int64_t longest_silence_ns = 500'000'000;

private:
    bool put(int channel, std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept;
    bool write_frames(std::int64_t first, const float* frames, std::size_t count) noexcept;
    bool flush() noexcept;

    std::unique_ptr<AudioSink> sink_;
    CardUse use_;
    std::vector<std::unique_ptr<SoundChannel>> listed_;
    std::optional<CardInput> input_;
    // Thread of the group:
    bool is_played_;  ///< a node has written since the input was read for the previous call
    std::int64_t heard_ = -1;  ///< first activation of the call that is read
    ChannelGather gather_;  // thread of the group
    control::CardFollower follower_;
    std::atomic<std::int64_t> shift_{0};  // activation of frame 0 of the ring
    std::int64_t expected_ = -1;  // thread of the group
    // Control thread.
    std::uint64_t written_ = 0;
    std::int64_t written_ns_ = 0, skipped_ = 0, largest_ = 0, seen_frames_ = 0, seen_ns_ = 0;
    std::atomic<bool> lost_{false};
    std::optional<Flicks> lost_at_;
    int losses_ = 0;
};

}  // namespace tactus::io
