// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/hand_cursor.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/geometric.hpp>

namespace tactus::window {

Vec3 in_scene(const Vec3& at, const Vec3& hand, const HandPlace& place) {
    return place.handle + place.to_scene * (at - hand) * place.scale;
}

void HandCursor::begin(const Pose& hand) { wanted_ = hand; }

void HandCursor::move(const Vec3& by, const HandPlace& place) {
    if (is_finite(by) && place.scale > 0.0) wanted_.position += glm::conjugate(place.to_scene) * by / place.scale;
}

void HandCursor::turn(const Vec3& by, const HandPlace& place) {
    if (!is_finite(by)) return;
    wanted_.orientation = glm::normalize(rotation_by(glm::conjugate(place.to_scene) * by) * wanted_.orientation);
}

void HandCursor::stay_near(const Pose& felt, double force_N) {
    constexpr double min_force = 0.5;
    const Vec3 away = wanted_.position - felt.position;
    const double far = glm::length(away);
    if (force_N > min_force && far > longest_spring_m)
        wanted_.position = felt.position + away * (longest_spring_m / far);
}

}  // namespace tactus::window
