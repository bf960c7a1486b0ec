// SPDX-License-Identifier: Apache-2.0
// Watches where a device lies in the scene of a run.
#pragma once

#include "engine/observe/observer.hpp"
#include "tools/render/scene_outline.hpp"
#include "tools/window/hand/hand_cursor.hpp"

#include <memory>
#include <string>

namespace tactus::window {

class PlaceWatch {
public:
    PlaceWatch() = default;
    ~PlaceWatch() { forget(); }
    PlaceWatch(const PlaceWatch&) = delete;
    PlaceWatch& operator=(const PlaceWatch&) = delete;

    void follow(const std::shared_ptr<observe::Observer>& observer, const render::SceneOutline::Place& place);
    void forget();
    /// For a hand at a pose of the device. The scene of a patch without a mapping is the device's own frame.
    HandPlace of(const Pose& hand) const;

private:
    std::shared_ptr<observe::Observer> observer_;
    std::string frame_port_, scale_port_;
};

}  // namespace tactus::window
