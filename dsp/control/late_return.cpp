// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/late_return.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::control {

namespace {

// A second of ticks of 1 ms can sum to just under a second.
constexpr double rounding = 1.0 - 1e-9;
constexpr double max_at_once = 2.0;

}  // namespace

void LateReturn::prepare(double period_s, double at_least_s) noexcept {
    period_s_ = period_s;
    wait_s_ = std::max(on_time_s, at_least_s);
    on_time_ = quiet_ = 0.0;
    left_out_ = 0;
}

bool LateReturn::leaves_out_too_many(double ticks) noexcept {
    if (ticks > max_at_once) return true;
    for (int n = 0; n < static_cast<int>(ticks); ++n) {
        double& at = left_out_at_[next_left_out_];  // the oldest, once there are so many
        if (left_out_ == max_left_out && now_s_ - at < on_time_s * rounding) return true;
        at = now_s_;
        next_left_out_ = (next_left_out_ + 1) % left_out_at_.size();
        left_out_ = std::min(left_out_ + 1, max_left_out);
    }
    return false;
}

void LateReturn::tick(bool is_late, bool is_quiet, double elapsed_s) noexcept {
    now_s_ += elapsed_s;
    const double left_out = std::max(0.0, std::round(elapsed_s / period_s_) - 1.0);
    if (is_late || leaves_out_too_many(left_out)) {
        on_time_ = 0.0;
        left_out_ = 0;
    } else on_time_ += elapsed_s;
    quiet_ = is_quiet ? quiet_ + elapsed_s : 0.0;
    if (!is_attended_ || now_s_ - attended_since_ <= wait_s_ + attended_s) return;
    needs_hand_ = needs_hand_ || (is_lost_ && needed_hand_);
    is_attended_ = needed_hand_ = false;
}

void LateReturn::lose() noexcept {
    const auto recent =
        std::count_if(at_.begin(), at_.begin() + count_, [&](double t) { return now_s_ - t < window_s; });
    needs_hand_ = needs_hand_ || recent >= max_returns;
    is_lost_ = true;
    comes_in_ = false;
}

bool LateReturn::returns() noexcept {
    if (needs_hand_ || on_time_ < wait_s_ * rounding || quiet_ < quiet_s * rounding) return false;
    if (count_ == max_returns) {
        std::shift_left(at_.begin(), at_.end(), 1);
        --count_;
    }
    at_[static_cast<std::size_t>(count_++)] = now_s_;
    is_lost_ = is_attended_ = needed_hand_ = false;
    comes_in_ = true;
    return true;
}

void LateReturn::come_in(bool are_on, bool are_full) noexcept {
    if (!are_on && count_ > 0) at_[static_cast<std::size_t>(count_ - 1)] = now_s_;
    comes_in_ = comes_in_ && !(are_on && are_full);
}

void LateReturn::forgive() noexcept {
    count_ = 0;
    needed_hand_ = needed_hand_ || needs_hand_;
    needs_hand_ = false;
    is_attended_ = true;
    attended_since_ = now_s_;
}

}  // namespace tactus::control
