// SPDX-License-Identifier: Apache-2.0
// The sides of a saw blade in its kerf.
#pragma once

#include "dsp/saw/saw_shape.hpp"
#include "dsp/volume/bricks.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus::saw {

/// A point of a face and the place where bone holds it.
struct FacePoint {
    Vec3 local{0.0, 0.0, 0.0};  ///< blade frame, m
    Vec3 at{0.0, 0.0, 0.0}, target{0.0, 0.0, 0.0};  ///< bone's frame, m
    double bending = 1.0;  ///< share of the stiffness across the blade that bending leaves
    bool seated = false;
};

/// 88 points in two rows at half height (thesis 6.2.2), at most 5 mm behind the teeth. Each is a god object (Zilles and Salisbury 1995): it follows the
/// blade and never crosses a surface, so that a thin wall stops it as a thick one does. It slides along walls, with
/// Coulomb friction while the blade stands still, and only where that shortens its lag: the force is passive.
class BladeFaces {
public:
    static constexpr std::size_t row = 44, count = 2 * row;

    BladeFaces() = default;
    BladeFaces(const SawShape& shape, double stiffness);

    void follow(const volume::BoneSnapshot& bone, const Pose& pose, bool running, double dt) noexcept;
    std::span<const FacePoint> points() const noexcept { return points_; }
    /// Squared length of a point's lag, bending counted, m².
    double square(const FacePoint& p) const noexcept;
    Vec3 lag(const FacePoint& p) const noexcept { return (p.target - p.at) * axes_; }  ///< blade axes, m
    void forget() noexcept;

private:
    void slide(const volume::BoneSnapshot& bone, FacePoint& p, double voxel, bool running) const noexcept;

    std::array<FacePoint, count> points_;
    Mat3 axes_{1.0};
};

}  // namespace tactus::saw
