// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/scene.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <limits>

namespace tactus::nodes {

struct Grasp {
    static constexpr auto about =
        "Takes hold of the body that is nearest to the hand while the trigger is held, at the very point where the "
        "hand "
        "is, and lets go of it again; forces come and go without a jump.";

    In<Pose> hand{"in the scene", "m"};
    In<tactus::coupling::Scene> scene{"what can be taken"};
    In<bool> trigger{"hold"};
    Out<double> held{"place of the body in the scene until its force has faded, -1 without one"};
    Out<Pose> grip{"the body in the frame of the hand", "m"};
    Out<bool> holding{"false once it is let go"};
    Out<double> strength{"share of the coupling's force that is to be felt"};
    Param reach{"5 mm", "0 mm", "1 m", "how near to a body the hand must be"};
    Param fade{"50 ms", "0 ms", "10 s", "in which the force comes in and goes out"};
    Param fixed{"1", "0", "16", "so many places from the first cannot be taken"};

    void prepare(const Setup&) { publish(); }

    void process(const Tick& tick) noexcept {
        const bool wanted = trigger.get() && is_valid(hand.get());
        if (place_ < 0 && wanted && !was_wanted_) take();
        if (place_ >= 0 && !trigger.get()) holds_ = false;
        was_wanted_ = wanted;
        const double change = fade > 0.0 ? tick.elapsed_seconds() / fade : 1.0;
        strength_ = std::clamp(strength_ + (holds_ ? change : -change), 0.0, 1.0);
        publish();
        // Told once more with no force, so that whoever follows sees the end of it.
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

TACTUS_NODE(Grasp, hand, scene, trigger, held, grip, holding, strength, reach, fade, fixed)

}  // namespace tactus::nodes
