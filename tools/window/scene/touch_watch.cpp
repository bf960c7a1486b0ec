// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/touch_watch.hpp"

#include "graph/node/value.hpp"

#include <algorithm>
#include <utility>

namespace tactus::window {

using analysis::touch_lasts;
using analysis::touch_of;

namespace {

Pose pose_at(const Trace& trace, std::size_t row) {
    const auto c = [&](std::size_t column) { return trace.columns[column][row]; };
    return {{c(0), c(1), c(2)}, Quat(c(3), c(4), c(5), c(6))};
}

/// The valid poses in [begin, end).
std::vector<Pose> poses_within(const Trace& trace, double begin, double end) {
    std::vector<Pose> poses;
    const auto first = std::ranges::lower_bound(trace.times, begin) - trace.times.begin();
    for (auto row = static_cast<std::size_t>(first); row < trace.times.size() && trace.times[row] < end; ++row)
        if (const Pose pose = pose_at(trace, row); is_valid(pose)) poses.push_back(pose);
    return poses;
}

double newest_of(const Trace* trace) { return trace && !trace->times.empty() ? trace->times.back() : -1.0; }

}  // namespace

std::vector<TouchSource> touch_sources(const Feed& feed) {
    std::vector<TouchSource> with_button, without;
    const std::vector<Feed::Port> ports = feed.ports();
    for (const Feed::Port& port : ports) {
        if (port.type != &value::pose) continue;
        const std::string button = port.name.substr(0, port.name.rfind('.')) + ".trigger";
        const auto known = std::ranges::find(ports, button, &Feed::Port::name);
        if (known != ports.end() && known->type == &value::boolean) with_button.push_back({port.name, button, {}, {}});
        else without.push_back({port.name, {}, {}, {}});
    }
    with_button.insert(with_button.end(), without.begin(), without.end());
    return with_button;
}

std::set<std::string> TouchWatch::traced() const {
    std::set<std::string> ports{source_.pose, source_.button, source_.tracker};
    ports.erase("");
    return ports;
}

const Trace* TouchWatch::button_of(const Feed& feed) const {
    return source_.button.empty() ? nullptr : feed.trace(source_.button);
}

void TouchWatch::look_for_press(const Feed& feed, const Trace& poses) {
    if (std::exchange(is_asked_, false)) {
        began_ = poses.times.back();
        return;
    }
    const Trace* const button = button_of(feed);
    if (!button || button->times.empty()) return;
    const auto first = std::ranges::upper_bound(button->times, seen_) - button->times.begin();
    for (auto row = static_cast<std::size_t>(first); row < button->times.size() && !began_; ++row) {
        seen_ = button->times[row];
        const bool pressed = button->columns[0][row] != 0.0;
        if (pressed && !was_pressed_ && seen_ >= free_from_) began_ = seen_;
        was_pressed_ = pressed;
    }
}

std::optional<Touched> TouchWatch::next(const Feed& feed) {
    const Trace* const poses = feed.trace(source_.pose);
    // Values traced before the start, for example for a scope, contain no touches.
    if (!std::exchange(has_looked_, true)) seen_ = free_from_ = std::max(newest_of(poses), newest_of(button_of(feed)));
    if (!poses || poses->times.empty()) return std::nullopt;
    // A new run starts at time zero.
    if (poses->times.back() < newest_) {
        seen_ = free_from_ = -1.0;
        was_pressed_ = true;
        began_.reset();
    }
    newest_ = poses->times.back();
    if (!began_) look_for_press(feed, *poses);
    if (!began_ || poses->times.back() < *began_ + touch_lasts) return std::nullopt;
    const double begin = *began_, end = begin + touch_lasts;
    began_.reset();
    free_from_ = end;
    std::vector<Vec3> tips, tracked;
    for (const Pose& pose : poses_within(*poses, begin, end)) tips.push_back(pose.apply(source_.tip));
    if (const Trace* const marker = source_.tracker.empty() ? nullptr : feed.trace(source_.tracker))
        for (const Pose& pose : poses_within(*marker, begin, end)) tracked.push_back(pose.position);
    return touch_of(tips, tracked);
}

}  // namespace tactus::window
