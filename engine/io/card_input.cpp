// SPDX-License-Identifier: Apache-2.0
#include "engine/io/card_input.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::io {

namespace {

constexpr std::int64_t longest_silence_ns = 500'000'000;  // a card that is lost, not late
constexpr int patience = 50;  // calls

void add(std::atomic<std::uint64_t>& count, std::uint64_t more) noexcept {
    count.store(count.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

}  // namespace

CardInput::CardInput(std::shared_ptr<audio::InputRing> ring, double rate, double margin_s)
    : ring_(std::move(ring)), rate_(rate), margin_(std::llround(margin_s * rate)) {}

/// Places the end of the call one callback plus the margin behind the newest sample that the card had when it was due.
bool CardInput::place(const audio::InputRing::View& card, std::int64_t first, std::int64_t count,
                      std::int64_t due_ns) noexcept {
    const double since = static_cast<double>(due_ns - card.steady_ns) * 1e-9 * rate_;
    const std::int64_t heard = card.captured + std::min<std::int64_t>(std::llround(since), card.largest);
    const std::int64_t offset = first + count - (heard - card.largest - margin_);
    if (was_placed_ && first - offset < heard_until_) return false;
    offset_ = offset;
    latency_s_.store(static_cast<double>(card.largest + margin_) / rate_, std::memory_order_relaxed);
    if (std::exchange(was_placed_, true)) add(resyncs_, 1);
    is_placed_ = true;
    too_much_ = 0;
    return true;
}

void CardInput::look(std::int64_t first, std::int64_t count, std::int64_t due_ns) noexcept {
    const audio::InputRing::View card = ring_->view();
    // A card that is lost is not late.
    is_silent_ = card.captured == 0 || due_ns - card.steady_ns > longest_silence_ns;
    if (is_silent_) {
        is_placed_ = false;
        return;
    }
    if (!is_placed_ && !place(card, first, count, due_ns)) {
        is_silent_ = true;
        add(missed_, static_cast<std::uint64_t>(count));
        return;
    }
    const std::int64_t from = first - offset_, waiting = card.captured - (from + count);
    const bool is_past = from < card.captured - ring_->capacity() + 2 * card.largest;
    if (waiting < 0 || (is_past && from >= 0)) {
        add(xruns_, 1);
        add(missed_, static_cast<std::uint64_t>(is_past ? count : std::min(-waiting, count)));
        heard_until_ = std::max(heard_until_, std::min(from + count, card.captured));
        is_placed_ = false;  // from the next call on
        return;
    }
    heard_until_ = from + count;
    too_much_ = waiting > 2 * margin_ + 4 * card.largest + count ? too_much_ + 1 : 0;
    if (too_much_ > patience) is_placed_ = false;
}

void CardInput::read(int channel, std::int64_t first, float* into, std::size_t count, std::int64_t due_ns) noexcept {
    if (looked_at_ != first) {
        look(first, static_cast<std::int64_t>(count), due_ns);
        looked_at_ = first;
    }
    if (!is_silent_ && ring_->read(first - offset_, count, channel, into)) return;
    // What is there of it.
    for (std::size_t i = 0; i < count; ++i)
        if (is_silent_ || !ring_->read(first + static_cast<std::int64_t>(i) - offset_, 1, channel, into + i))
            into[i] = 0.0F;
}

}  // namespace tactus::io
