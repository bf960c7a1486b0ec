// SPDX-License-Identifier: Apache-2.0
// The inputs of a sound card, aligned to the logical time of the group that records them.
#pragma once

#include "devices/audio/input_ring.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace tactus::io {

/// Activation a reads frame a − offset of the card. The offset is constant, so that inputs and outputs of a card keep
/// their distance to the sample. It is chosen again, for all channels together, when frames come too late or when the
/// buffer holds much more than needed. After late frames the input is silent until the card has caught up; no frame is
/// read twice.
class CardInput {
public:
    /// `margin_s`: buffered time in case the card is late.
    CardInput(std::shared_ptr<audio::InputRing> ring, double rate, double margin_s);

    /// Group's thread; wait-free. Channels count from 0. All channels are read for the same activations. `due_ns`:
    /// steady time at which the call should begin; using it instead of the current time keeps the offset independent of
    /// the thread's delay.
    void read(int channel, std::int64_t first, float* into, std::size_t count, std::int64_t due_ns) noexcept;

    // Any thread.
    int channels() const { return ring_->channels(); }
    /// Calls for which frames came too late.
    std::uint64_t xruns() const noexcept { return xruns_.load(std::memory_order_relaxed); }
    /// Number of overruns that the card or its server has reported.
    std::uint64_t card_xruns() const noexcept { return ring_->overflows(); }
    std::uint64_t frames_missed() const noexcept { return missed_.load(std::memory_order_relaxed); }
    std::uint64_t resyncs() const noexcept { return resyncs_.load(std::memory_order_relaxed); }
    /// Time in s from the end of a frame's callback to the activation that reads it, at the last choice of the offset.
    double latency_s() const noexcept { return latency_s_.load(std::memory_order_relaxed); }

private:
    void look(std::int64_t first, std::int64_t count, std::int64_t due_ns) noexcept;
    /// Returns false if the card has not caught up yet.
    bool place(const audio::InputRing::View& card, std::int64_t first, std::int64_t count,
               std::int64_t due_ns) noexcept;

    std::shared_ptr<audio::InputRing> ring_;
    double rate_;
    std::int64_t margin_, offset_ = 0, looked_at_ = -1;
    std::int64_t heard_until_ = 0;  ///< all frames before this one have been read
    int too_much_ = 0;  // calls
    bool is_placed_ = false, was_placed_ = false, is_silent_ = true;
    std::atomic<std::uint64_t> xruns_{0}, missed_{0}, resyncs_{0};
    std::atomic<double> latency_s_{0.0};
};

}  // namespace tactus::io
