// SPDX-License-Identifier: Apache-2.0
// Detects touches in the traces of a run's device: a press of its button, or of one in the window, and the poses after
// it.
#pragma once

#include "tools/analysis/display/touch_lead.hpp"
#include "tools/window/signal/feed.hpp"

#include <optional>
#include <set>
#include <string>
#include <utility>

namespace tactus::window {

using analysis::Touched;

/// The observed ports, "node.port".
struct TouchSource {
    std::string pose;  ///< pose of the handle in the frame of the device
    std::string button;  ///< boolean; empty: none
    std::string tracker;  ///< pose of a tracked marker; empty: none
    Vec3 tip{0.0};  ///< position of the tip in the frame of the handle, m
};

/// All pose outputs, each with a button of the same node if any ("hand.pose", "hand.trigger").
std::vector<TouchSource> touch_sources(const Feed& feed);

class TouchWatch {
public:
    explicit TouchWatch(TouchSource source) : source_(std::move(source)) {}

    /// The ports to trace with every value.
    std::set<std::string> traced() const;
    /// Starts a touch now, independent of the device's button.
    void ask() { is_asked_ = true; }
    bool is_reading() const { return began_.has_value(); }
    /// The next complete touch; none: not yet. Presses are found in the traces, so that none is missed at low frame
    /// rates; presses before the first call are ignored.
    std::optional<Touched> next(const Feed& feed);

private:
    const Trace* button_of(const Feed& feed) const;
    void look_for_press(const Feed& feed, const Trace& poses);

    TouchSource source_;
    bool is_asked_ = false, has_looked_ = false;
    bool was_pressed_ = true;  // a button held from the beginning does not count as pressed
    double seen_ = -1.0, free_from_ = -1.0;  // s: end of the searched trace; earliest start of the next touch
    double newest_ = -1.0;  // s: of the poses
    std::optional<double> began_;
};

}  // namespace tactus::window
