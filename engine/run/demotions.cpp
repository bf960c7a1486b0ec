// SPDX-License-Identifier: Apache-2.0
#include "engine/run/demotions.hpp"

#include <algorithm>

namespace tactus::run {

namespace {

/// A group that uses less would free nothing.
constexpr double smallest_share = 0.01;

}  // namespace

void Demotions::forget(std::size_t group) {
    if (group < states_.size()) states_[group] = {};
}

void Demotions::demote(std::size_t group, DemotionCause cause, std::int64_t now) {
    State& state = states_[group];
    if (state.cause == DemotionCause::none) {
        // Soon after it got its priority back: it needs longer.
        const bool is_again = state.until > 0 && now - state.until < longest_demotion_ns;
        state.lasts = is_again ? std::min(2 * state.lasts, longest_demotion_ns) : shortest_demotion_ns;
        state.cause = cause;
    }
    state.until = now + state.lasts;
}

void Demotions::check_load(std::int64_t now, const std::vector<GroupLoad>& groups) {
    const auto length = static_cast<double>(now - window_began_);
    double sum = 0.0;
    std::size_t least = groups.size();
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const State& state = states_[g];
        if (state.cause != DemotionCause::none || !state.is_known) continue;
        const double share = static_cast<double>(groups[g].spent - state.spent_before) / length;
        sum += share;
        if (share < smallest_share) continue;
        if (least == groups.size() || groups[g].priority < groups[least].priority) least = g;
    }
    if (sum > largest_load && least < groups.size()) demote(least, DemotionCause::load, now);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        states_[g].spent_before = groups[g].spent;
        states_[g].is_known = true;
    }
    window_began_ = now;
}

const std::vector<DemotionCause>& Demotions::look(std::int64_t now, const std::vector<GroupLoad>& groups) {
    if (states_.size() < groups.size()) states_.resize(groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const bool is_stuck = groups[g].busy_since > 0 && now - groups[g].busy_since > longest_call_ns;
        if (is_stuck) demote(g, DemotionCause::no_progress, now);
        else if (states_[g].cause != DemotionCause::none && now >= states_[g].until)
            states_[g].cause = DemotionCause::none;
    }
    if (now - window_began_ >= window_ns) check_load(now, groups);
    causes_.resize(groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) causes_[g] = states_[g].cause;
    return causes_;
}

}  // namespace tactus::run
