// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/scene.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <limits>

namespace tactus::nodes {

struct Grasp {
    static constexpr auto about =
        "Grasps the body nearest to the hand while the trigger is held, with the body's pose relative to the hand "
        "kept, and releases it afterwards. Forces fade in and out.";

    In<Pose> hand{"pose of the hand in the scene", "m"};
    In<tactus::coupling::Scene> scene{"the bodies that can be grasped"};
    In<bool> trigger{"true: hold"};
    In<bool> release{optional, "true: release the body; press the trigger again to hold it"};
    Out<double> held{"place of the held body in the scene until its force has faded; -1: none"};
    Out<Pose> grip{"pose of the body in the frame of the hand", "m"};
    Out<bool> holding{"true until the body is released"};
    Out<double> strength{"share of the coupling's force that the hand feels, 0 to 1"};
    Param reach{"5 mm", "0 mm", "1 m", "maximum distance from the hand to the body"};
    Param fade{"50 ms", "0 ms", "10 s", "time in which the force fades in and out"};
    Param fixed{discrete, "1", "0", "16", "number of places, from place 0 on, that cannot be grasped"};

    void prepare(const Setup&) { publish(); }

    void process(const Tick& tick) noexcept {
        const bool wanted = trigger.get() && is_valid(hand.get());
        const bool is_released = release.connected && release.get();
        if (place_ < 0 && wanted && !was_wanted_ && !is_released) take();
        if (place_ >= 0 && (!trigger.get() || is_released)) holds_ = false;
        was_wanted_ = wanted;
        const double change = fade > 0.0 ? tick.elapsed_seconds() / fade : 1.0;
        strength_ = std::clamp(strength_ + (holds_ ? change : -change), 0.0, 1.0);
        publish();
        // One more tick with strength 0, so that nodes downstream see the end.
        if (!holds_ && strength_ == 0.0) place_ = -1;
    }

private:
    void take() noexcept {
        double nearest = reach;
        for (std::size_t i = static_cast<std::size_t>(fixed); i < scene->count; ++i) {
            const coupling::SceneObject& object = scene->objects[i];
            if (!object.body.map || !is_valid(object.pose)) continue;
            const double distance = object.body.map->sample(object.pose.inverse().apply(hand->position)).value;
            if (!(distance < nearest)) continue;
            nearest = distance;
            place_ = static_cast<int>(i);
        }
        if (place_ < 0) return;
        const Pose here{hand->position, glm::normalize(hand->orientation)};
        grip_ = here.inverse() * scene->objects[static_cast<std::size_t>(place_)].pose;
        holds_ = true;
    }

    void publish() noexcept {
        held = place_;
        grip = grip_;
        holding = holds_;
        strength = strength_;
    }

    int place_ = -1;
    bool holds_ = false, was_wanted_ = false;
    double strength_ = 0.0;
    Pose grip_;
};

TACTUS_NODE(Grasp, hand, scene, trigger, release, held, grip, holding, strength, reach, fade, fixed)

}  // namespace tactus::nodes
