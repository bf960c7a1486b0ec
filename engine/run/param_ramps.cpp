// SPDX-License-Identifier: Apache-2.0
#include "engine/run/param_ramps.hpp"

#include <algorithm>

namespace tactus::run {

namespace {

constexpr Flicks ramp_time = flicks_per_second / 10;
constexpr Flicks step_time = flicks_per_second / 4000;  // four values per millisecond of a sound are smooth enough

}  // namespace

std::int64_t ParamRamps::length(Flicks period) noexcept { return std::max<Flicks>(ramp_time / period, 1); }

ParamRamps::ParamRamps(Flicks period) noexcept : step_(std::max<Flicks>(step_time / period, 1)) {}

void ParamRamps::set(Param& param, ParamRamp* ramp, double value, std::int64_t tick, std::int64_t length,
                     std::int64_t plan) noexcept {
    const bool is_gradual = ramp && length > 0 && ramp->newest_plan.load(std::memory_order_relaxed) >= plan;
    // A plan that took over since the change was given may have lowered the limit.
    value = std::min(value, param.max);
    // The previous schedule may define another ramp for this parameter, and the next one none.
    ParamRamp* const running = find(param);
    if (running && !(is_gradual && running == ramp)) remove(*running);
    if (!is_gradual) {
        param.value = value;
        return;
    }
    if (!ramp->is_running) {
        ramp->next = first_;
        first_ = ramp;
        ramp->is_running = true;
    }
    ramp->from = param.value;
    ramp->to = value;
    ramp->begin = tick;
    ramp->length = length;
}

void ParamRamps::limit(Param& param, ParamRamp* ramp, double most, std::int64_t tick, std::int64_t length,
                       std::int64_t plan) noexcept {
    param.max = most;
    const ParamRamp* const running = find(param);
    if ((running ? running->to : param.value) > most) set(param, ramp, most, tick, length, plan);
}

ParamRamp* ParamRamps::find(const Param& param) const noexcept {
    ParamRamp* ramp = first_;
    while (ramp && ramp->param != &param) ramp = ramp->next;
    return ramp;
}

void ParamRamps::remove(ParamRamp& ramp) noexcept {
    ParamRamp** at = &first_;
    while (*at != &ramp) at = &(*at)->next;
    *at = ramp.next;
    ramp.is_running = false;
}

void ParamRamps::keep(std::int64_t plan) noexcept {
    for (ParamRamp** at = &first_; *at;) {
        ParamRamp& ramp = **at;
        if (ramp.newest_plan.load(std::memory_order_relaxed) >= plan) {
            at = &ramp.next;
            continue;
        }
        ramp.param->value = ramp.to;
        *at = ramp.next;
        ramp.is_running = false;
    }
}

void ParamRamps::advance(std::int64_t tick) noexcept {
    for (ParamRamp** at = &first_; *at;) {
        ParamRamp& ramp = **at;
        const std::int64_t passed = ((tick - ramp.begin) / step_ + 1) * step_;
        if (passed < ramp.length) {
            ramp.param->value =
                ramp.from + (ramp.to - ramp.from) * static_cast<double>(passed) / static_cast<double>(ramp.length);
            at = &ramp.next;
            continue;
        }
        ramp.param->value = ramp.to;
        *at = ramp.next;
        ramp.is_running = false;
    }
}

std::int64_t ParamRamps::next_change(std::int64_t tick, std::int64_t until) const noexcept {
    for (const ParamRamp* ramp = first_; ramp; ramp = ramp->next)
        until = std::min(until, ramp->begin + ((tick - ramp->begin) / step_ + 1) * step_);
    return until;
}

}  // namespace tactus::run
