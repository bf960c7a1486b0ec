// SPDX-License-Identifier: Apache-2.0
#include "nodes/plan/case_history.hpp"

namespace tactus::nodes {

namespace {

// Nine hours at a step per second. Later steps are kept too, but the oldest can then no longer be undone.
constexpr std::size_t max_steps = 32768;

}  // namespace

CaseHistory::CaseHistory(const plan::CasePlan& plan)
    : tree_(plan.fragments.size(), plan.steps.size(), max_steps),
      kept_(plan::state_of(plan).arrangement),
      way_(static_cast<std::size_t>(plan.current)) {
    plan::visit_steps(plan, [&](int n, const plan::PlanState& from, const plan::PlanState& to) {
        tree_.put(n, plan.steps[static_cast<std::size_t>(n)].before, from.arrangement, to.arrangement);
    });
    tree_.stand(plan.place());
    ways_.reserve(max_ways);
    dropped_.reserve(plan::max_dropped);
    for (const plan::PlanAlternative& way : plan.alternatives)
        if (ways_.size() < max_ways) ways_.push_back(way.place);
}

bool CaseHistory::undo(fit::Arrangement& now) noexcept {
    if (!tree_.undo(now)) return false;
    kept_ = now;
    return true;
}

bool CaseHistory::redo(fit::Arrangement& now) noexcept {
    if (!tree_.redo(now)) return false;
    kept_ = now;
    return true;
}

bool CaseHistory::go_to(std::size_t alternative, fit::Arrangement& now) noexcept {
    if (alternative > ways_.size() || alternative >= max_ways || alternative == way_) return false;
    ways_[way_] = tree_.place();
    const bool begins = alternative == ways_.size();
    if (begins) ways_.push_back(fit::after_step(tree_.head()));
    if (!tree_.go(ways_[alternative], now)) {
        if (begins) ways_.pop_back();
        return false;
    }
    way_ = alternative;
    kept_ = now;
    return true;
}

bool CaseHistory::drop(double number) noexcept {
    if (number < 0.0) {
        if (dropped_.empty() || ways_.size() >= max_ways) return false;
        ways_.push_back(dropped_.back());
        dropped_.pop_back();
        return true;
    }
    const auto place = static_cast<std::size_t>(number);
    if (place >= ways_.size() || place == way_) return false;
    if (dropped_.size() == plan::max_dropped) dropped_.erase(dropped_.begin());
    dropped_.push_back(ways_[place]);
    ways_.erase(ways_.begin() + static_cast<std::ptrdiff_t>(place));
    way_ -= place < way_ ? 1 : 0;
    return true;
}

void CaseHistory::add(const fit::Arrangement& now) noexcept {
    tree_.add(kept_, now);
    kept_ = now;
}

plan::StepRow CaseHistory::row(double kind) const noexcept {
    plan::StepRow row;
    row.step = static_cast<double>(tree_.count());
    row.after = static_cast<double>(tree_.head());
    row.kind = kind;
    return row;
}

}  // namespace tactus::nodes
