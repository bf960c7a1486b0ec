// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/place_watch.hpp"

#include <glm/geometric.hpp>

namespace tactus::window {

void PlaceWatch::follow(const std::shared_ptr<observe::Observer>& observer, const render::SceneOutline::Place& place) {
    forget();
    observer_ = observer;
    frame_port_ = place.frame;
    scale_port_ = place.scale;
    for (const std::string& port : {frame_port_, scale_port_})
        if (!port.empty()) observer_->watch(port, observe::Watch::latest, this);
}

void PlaceWatch::forget() {
    if (observer_)
        for (const std::string& port : {frame_port_, scale_port_})
            if (!port.empty()) observer_->watch(port, observe::Watch::nothing, this);
    observer_.reset();
    frame_port_.clear();
    scale_port_.clear();
}

HandPlace PlaceWatch::of(const Pose& hand) const {
    HandPlace place{{1.0, 0.0, 0.0, 0.0}, 1.0, hand.position};
    if (!observer_ || frame_port_.empty()) return place;
    if (const auto frame = observer_->latest<Pose>(frame_port_); frame && is_valid(frame->value)) {
        place.to_scene = glm::normalize(frame->value.orientation);
        place.handle = frame->value.position;
    }
    if (const auto scale = observer_->latest<double>(scale_port_); scale && scale->value > 0.0)
        place.scale = scale->value;
    return place;
}

}  // namespace tactus::window
