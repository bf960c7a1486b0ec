// SPDX-License-Identifier: Apache-2.0
// Finds the touches in what a run's device did: a press of its button, or of one in the window, and the poses after it.
#pragma once

#include "tools/study/displays/touch_lead.hpp"
#include "tools/view/signal/feed.hpp"

#include <optional>
#include <set>
#include <string>
#include <utility>

namespace tactus::view {

using study::Touched;

/// What is read, all by "node.port".
struct TouchSource {
    std::string pose;  ///< of the handle, frame of the device
    std::string button;  ///< boolean; empty: none
    std::string tracker;  ///< pose of a tracked marker; empty: none
    Vec3 tip{0.0};  ///< in the frame of the handle, m
};

/// Poses, each with a button that is on a device of the same node where there is one ("hand.pose", "hand.trigger").
std::vector<TouchSource> touch_sources(const Feed& feed);

class TouchWatch {
public:
    explicit TouchWatch(TouchSource source) : source_(std::move(source)) {}

    /// The ports whose every value it needs.
    std::set<std::string> traced() const;
    /// A touch begins now, whatever the device's button says.
    void ask() { is_asked_ = true; }
    bool is_reading() const { return began_.has_value(); }
    /// The next touch that was read as a whole, none: not yet. Presses are found in the traces, so that none is missed
    /// however rarely the window looks; those before the first call are none.
    std::optional<Touched> next(const Feed& feed);

private:
    const Trace* button_of(const Feed& feed) const;
    void look_for_press(const Feed& feed, const Trace& poses);

    TouchSource source_;
    bool is_asked_ = false, has_looked_ = false;
    bool was_pressed_ = true;  // a button that is held from the beginning says nothing
    double seen_ = -1.0, free_from_ = -1.0;  // s: up to where the button was looked at, and from where it may begin one
    double newest_ = -1.0;  // s: of the poses
    std::optional<double> began_;
};

}  // namespace tactus::view
