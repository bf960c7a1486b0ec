// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/display/touch_lead.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace tactus::analysis {

namespace {

constexpr double max_moved = 1e-3;  // m, greatest motion of the tip during a touch
constexpr int max_tries = 3;
constexpr std::size_t min_samples = 10;

Vec3 mean_of(std::span<const Vec3> places) {
    Vec3 sum(0.0);
    for (const Vec3& place : places) sum += place;
    return places.empty() ? sum : sum / static_cast<double>(places.size());
}

}  // namespace

Touched touch_of(std::span<const Vec3> tips, std::span<const Vec3> tracked) {
    Touched touched{mean_of(tips), mean_of(tracked), 0.0, tips.size(), tracked.size()};
    for (const Vec3& tip : tips) touched.moved = std::max(touched.moved, glm::length(tip - touched.tip));
    return touched;
}

TouchLead::TouchLead(std::vector<display::Touch> steps, bool has_tracker, Check check)
    : steps_(std::move(steps)), tries_(steps_.size(), 0), has_tracker_(has_tracker), check_(std::move(check)) {
    if (steps_.empty()) throw Error("there is nothing to touch");
}

bool TouchLead::is_part_done() const {
    if (reached_ == steps_.size()) return true;
    const display::Touch &last = steps_[reached_ - 1], &next = steps_[reached_];
    return last.of != next.of || last.screen != next.screen;
}

std::string TouchLead::fault_of(const Touched& touched) const {
    if (touched.samples < min_samples)
        return fmt::format(
            "the device gave {} valid samples during the touch, but {} are needed; check that it is plugged in and "
            "sampled at {:.0f} Hz or more, and press again",
            touched.samples == 0 ? "no" : std::to_string(touched.samples), min_samples,
            static_cast<double>(min_samples) / touch_lasts);
    if (is_tracked(steps_[due_]) && touched.tracked_samples == 0)
        return "the tracker did not see the marker during the touch; bring it into view and press again";
    if (touched.moved > max_moved)
        return fmt::format(
            "the tip moved by {:.1f} mm during the touch; hold it still for a fifth of a second and press again",
            touched.moved * 1e3);
    return {};
}

std::string TouchLead::take(const Touched& touched) {
    if (const std::string fault = fault_of(touched); !fault.empty()) {
        if (++tries_[due_] >= max_tries) throw Error(fault);
        return fault;
    }
    display::Touch& step = steps_[due_];
    step.reading = touched.tip;
    if (is_tracked(step)) step.place = touched.tracked;
    if (due_ == reached_) ++reached_;
    due_ = reached_;
    if (!is_part_done()) return {};
    try {
        check_(std::span(steps_).first(reached_));
    } catch (const display::BadTouch& bad) {
        if (++tries_[bad.touch] >= max_tries) throw;
        due_ = bad.touch;
        return bad.message();
    }
    return {};
}

}  // namespace tactus::analysis
