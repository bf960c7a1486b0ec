// SPDX-License-Identifier: Apache-2.0
// Sound cards of a live run: signals go straight to their rings, the run's clock follows the first of them, and one that
// asks for nothing any more is noticed.
#pragma once

#include "dsp/control/card_follower.hpp"
#include "graph/node/device.hpp"
#include "graph/node/setup.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tactus::io {

class SoundCard : public RecordStream {
public:
    /// `sink` is prepared for one channel with that period. `margin_s` of sound waits in its ring. Only the thread of
    /// `group` writes.
    SoundCard(std::unique_ptr<AudioSink> sink, Flicks period, double margin_s, int group);

    /// Thread of the group. Activations that never ran are silence; what finds no room is lost and counted.
    bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept override;

    // Control thread.
    /// Looks at what the card did. Trims `clock`, when given one, where it is at `now_ns`. `reached`: logical time. True at the moment when the card turns out to be lost:
    /// no callback came for `longest_silence_ns`.
    bool service(std::int64_t now_ns, Flicks reached, control::TrimmedClock* clock);
    void close() { sink_->close(); }

    const std::string& name() const { return sink_->name(); }
    double rate() const { return rate_of(period_); }
    bool serves(int group, Flicks period) const { return group == group_ && period == period_; }
    AudioStatistics statistics() const { return sink_->statistics(); }
    const control::CardFollower& follower() const { return follower_; }
    std::int64_t largest_callback() const { return largest_; }
    bool is_lost() const { return lost_; }  ///< from any thread
    /// Logical time of the first loss.
    const std::optional<Flicks>& lost_at() const { return lost_at_; }
    int losses() const { return losses_; }

    static constexpr std::int64_t longest_silence_ns = 500'000'000;

private:
    std::unique_ptr<AudioSink> sink_;
    Flicks period_;
    int group_;
    control::CardFollower follower_;
    std::atomic<std::int64_t> shift_{0};  // index of the activation that is frame 0 of the ring
    std::int64_t expected_ = -1;  // thread of the group
    // Control thread.
    std::uint64_t written_ = 0;
    std::int64_t written_ns_ = 0, skipped_ = 0, largest_ = 0, seen_frames_ = 0, seen_ns_ = 0;
    std::atomic<bool> lost_{false};
    std::optional<Flicks> lost_at_;
    int losses_ = 0;
};

}  // namespace tactus::io
