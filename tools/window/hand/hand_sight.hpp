// SPDX-License-Identifier: Apache-2.0
// What is seen of a hand that a spring pulls: cursor, spring and the bar of its force. Drawn in one way, whoever pulls.
#pragma once

#include "dsp/core/types.hpp"
#include "tools/window/hand/hand_cursor.hpp"
#include "tools/window/widgets/painter.hpp"

#include <functional>
#include <optional>
#include <string>

namespace tactus::window {

/// Where a point of the scene is on the screen; none: it is not seen.
using SeenAt = std::function<std::optional<Point>(const Vec3&)>;

struct HandSight {
    Vec3 hand{0.0}, wanted{0.0};  ///< scene
    double force_N = 0.0;
    double limit_N = 1.0;  ///< most that the hand can get
    std::string name;  ///< of its device, where there are several; empty: it needs none
};

/// The cursor, and the spring to the hand, which its stretch makes flat.
void draw_spring(const Painter& paint, const SeenAt& seen, const HandSight& sight);
/// The bar of the force at the right edge of the picture. Returns its left edge: another one has its place there.
double draw_force_bar(const Painter& paint, const Box& picture, const HandSight& sight);

}  // namespace tactus::window
