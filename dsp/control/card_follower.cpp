// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/card_follower.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::control {

void CardFollower::prepare(double rate, double margin_s) noexcept {
    *this = CardFollower{};
    rate_ = rate;
    frame_ = std::llround(static_cast<double>(flicks_per_second) / rate);
    margin_ = std::llround(margin_s * rate);
    loop_.prepare(rate);
}

std::int64_t CardFollower::follow(const CardView& card, std::int64_t now_ns, TrimmedClock& clock) noexcept {
    if (card.asked <= asked_) return 0;
    asked_ = card.asked;
    largest_ = std::max(largest_, card.largest);
    loop_.update(card.asked, card.steady_ns);
    const std::int64_t made = clock.when((card.next + target()) * frame_);
    excess_ns_ = loop_.time_ns(card.asked) - static_cast<double>(made);
    clock.trim(now_ns, loop_.frame_ns() * rate_ * 1e-9, -excess_ns_);
    const double excess = excess_ns_ * 1e-9 * rate_;
    too_much_ = excess > static_cast<double>(margin_) ? too_much_ + 1 : 0;
    if (too_much_ < patience) return 0;
    too_much_ = 0;
    return std::llround(excess);
}

}  // namespace tactus::control
