// SPDX-License-Identifier: Apache-2.0
// The hands of a run that devices pull by a spring where a person wants them, as a gamepad does. Only looked at.
#pragma once

#include "devices/haptic/pulled_hand.hpp"
#include "graph/compile/schedule.hpp"
#include "tools/window/document/viewed_run.hpp"
#include "tools/window/hand/hand_sight.hpp"
#include "tools/window/hand/place_watch.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::window {

class PulledHands {
public:
    /// A run, or an edit of its patch.
    void follow(const std::shared_ptr<observe::Observer>& observer, const render::SceneOutline& outline,
                const compile::Schedule& plan);
    void forget();
    /// Reads what the devices of the run tell. `now_ns`: steady clock.
    void look(const RunStatus& status, std::int64_t now_ns);
    /// Those that are there now.
    std::vector<HandSight> sights() const;

private:
    /// A device that a node reads as a hand.
    struct Source {
        std::string device;
        render::SceneOutline::Place place;  ///< empty: the patch maps it nowhere
        double limit_N = 0.0;
    };
    struct Hand {
        std::string device;
        std::shared_ptr<const haptic::PullLink> link;
        haptic::PulledHand told;
        double limit_N = 0.0;
        bool is_there = false;
        PlaceWatch place;
    };
    void keep_those_of(const RunStatus& status);

    std::shared_ptr<observe::Observer> observer_;
    std::vector<Source> sources_;
    std::vector<std::unique_ptr<Hand>> hands_;
};

}  // namespace tactus::window
