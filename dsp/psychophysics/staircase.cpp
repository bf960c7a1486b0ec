// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/staircase.hpp"

#include "dsp/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::psychophysics {

double StaircaseRule::target() const {
    const double rate = step_up / (step_up + step_down);
    return kind == Kind::weighted ? rate : std::pow(rate, 1.0 / down);
}

Staircase::Staircase(const StaircaseRule& rule) : rule_(rule), level_(rule.start) {
    if (!(rule.step_up > 0.0 && rule.step_down > 0.0)) throw Error("the steps of a staircase must be positive");
    if (!(rule.first_factor >= 1.0)) throw Error("the first steps of a staircase must not be smaller than the others");
    if (rule.down < 1) throw Error("a staircase goes down after at least one correct answer");
    if (!(rule.min < rule.max && rule.start >= rule.min && rule.start <= rule.max))
        throw Error("the start of a staircase must lie between its least and its greatest level");
    if (rule.reversals < 4) throw Error("a staircase needs at least 4 reversals");
}

void Staircase::answer(bool correct) {
    ++trials_;
    if (!correct) {
        correct_in_a_row_ = 0;
        move(+1);
        return;
    }
    const int needed = rule_.kind == StaircaseRule::Kind::weighted ? 1 : rule_.down;
    if (++correct_in_a_row_ < needed) return;
    correct_in_a_row_ = 0;
    move(-1);
}

void Staircase::move(int direction) {
    if (direction_ != 0 && direction != direction_) reversals_.push_back(level_);
    direction_ = direction;
    const double factor = std::max(1.0, std::ldexp(rule_.first_factor, -static_cast<int>(reversals_.size())));
    const double step = direction > 0 ? rule_.step_up : -rule_.step_down;
    level_ = std::clamp(level_ + factor * step, rule_.min, rule_.max);
}

}  // namespace tactus::psychophysics
