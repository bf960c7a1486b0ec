// SPDX-License-Identifier: Apache-2.0
// The inputs of a sound card, at the logical times of the group that hears them.
#pragma once

#include "devices/audio/input_ring.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace tactus::io {

/// Activation a hears frame a − offset of the card, and the offset stays: inputs and outputs of a card keep their
/// distance to the sample. It is chosen anew, for all channels at once, when frames come too late (silence then, until
/// the card has gone far enough; no frame is heard twice) or when much more waits than needs to.
class CardInput {
public:
    /// `margin_s`: what waits in case the card is late.
    CardInput(std::shared_ptr<audio::InputRing> ring, double rate, double margin_s);

    /// Group's thread; wait-free. Channel from 0. All channels are read for the same activations. `due_ns`: steady time at
    /// which the call should begin; how late the thread is does not change the distance.
    void read(int channel, std::int64_t first, float* into, std::size_t count, std::int64_t due_ns) noexcept;

    // Any thread.
    int channels() const { return ring_->channels(); }
    /// Calls for which frames came too late.
    std::uint64_t xruns() const noexcept { return xruns_.load(std::memory_order_relaxed); }
    /// Times that the card or its server says that it was late.
    std::uint64_t card_xruns() const noexcept { return ring_->overflows(); }
    std::uint64_t frames_missed() const noexcept { return missed_.load(std::memory_order_relaxed); }
    std::uint64_t resyncs() const noexcept { return resyncs_.load(std::memory_order_relaxed); }
    /// From the end of a frame's callback to the activation that hears it, s: at the last choice.
    double latency_s() const noexcept { return latency_s_.load(std::memory_order_relaxed); }

private:
    void look(std::int64_t first, std::int64_t count, std::int64_t due_ns) noexcept;
    /// False: the card has not gone far enough since.
    bool place(const audio::InputRing::View& card, std::int64_t first, std::int64_t count,
               std::int64_t due_ns) noexcept;

    std::shared_ptr<audio::InputRing> ring_;
    double rate_;
    std::int64_t margin_, offset_ = 0, looked_at_ = -1;
    std::int64_t heard_until_ = 0;  ///< frame up to which all was heard: none is heard twice
    int too_much_ = 0;  // calls
    bool is_placed_ = false, was_placed_ = false, is_silent_ = true;
    std::atomic<std::uint64_t> xruns_{0}, missed_{0}, resyncs_{0};
    std::atomic<double> latency_s_{0.0};
};

}  // namespace tactus::io
