// SPDX-License-Identifier: Apache-2.0
// View-frustum culling.
#pragma once

#include "dsp/display/camera.hpp"

#include <glm/vec4.hpp>

#include <array>

namespace tactus::display {

/// The six planes of a view frustum, in the frame that `to_clip` starts from.
class Frustum {
public:
    explicit Frustum(const Mat4& to_clip) {
        const auto row = [&](int n) { return glm::dvec4(to_clip[0][n], to_clip[1][n], to_clip[2][n], to_clip[3][n]); };
        for (int axis = 0; axis < 3; ++axis) {
            planes_[static_cast<std::size_t>(2 * axis)] = row(3) + row(axis);
            planes_[static_cast<std::size_t>(2 * axis + 1)] = row(3) - row(axis);
        }
    }

    /// False only for a box completely beyond one of the planes.
    bool meets(const Bounds& box) const {
        for (const glm::dvec4& plane : planes_) {
            double most = plane.w;
            for (int axis = 0; axis < 3; ++axis)
                most += plane[axis] * (plane[axis] > 0.0 ? box.high[axis] : box.low[axis]);
            if (most < 0.0) return false;
        }
        return true;
    }

private:
    std::array<glm::dvec4, 6> planes_;
};

}  // namespace tactus::display
