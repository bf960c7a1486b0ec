// SPDX-License-Identifier: Apache-2.0
// A round burr in a bone.
#pragma once

#include "dsp/carve/cut_front.hpp"
#include "dsp/saw/cutting_law.hpp"
#include "dsp/volume/bricks.hpp"

namespace tactus::saw {

struct BurrShape {
    double radius = 0.002;  ///< m
    double flutes = 8.0;  ///< cutting edges
};

/// Tool frame: origin in the ball's centre, y the direction of the shaft, towards the bone.
struct BurrContact {
    Wrench wrench;  ///< on the tool about the ball's centre, N and N·m, scene axes
    double load = 0.0;  ///< N, all of the force
    double along = 0.0;  ///< N: force of the flutes around the shaft
    double lag = 0.0;  ///< m
    double feed = 0.0;  ///< m/s
    bool touches = false;
};

/// A ball that rests on bone it has not cut: a god object (Zilles and Salisbury 1995), held by a spring. Running, it
/// advances along its own force by an implicit step of the cutting law, one flute bearing at a time; otherwise bone
/// stops it, with Coulomb friction. It never moves away from its target, so that the force is passive.
class Burr {
public:
    Burr() = default;
    Burr(const BurrShape& shape, double stiffness) : shape_(shape), stiffness_(stiffness) {}

    /// `rate`: turns per second. A pose that is none gives no force and lets go of the bone. Allocates nothing.
    BurrContact step(const volume::BoneSnapshot& bone, const Pose& pose, bool running, double rate, double dt,
                     const CuttingLaw& law) noexcept;

    void fill(carve::CutFront& front, const Pose& pose, bool running) const noexcept;
    const Vec3& at() const noexcept { return at_; }

private:
    struct Touch;

    Touch touch(const volume::BoneSnapshot& bone, const Vec3& lag, double ahead) const noexcept;
    double follow(const volume::BoneSnapshot& bone, bool running) noexcept;

    BurrShape shape_;
    double stiffness_ = 0.0;
    Vec3 at_{0.0, 0.0, 0.0}, target_{0.0, 0.0, 0.0};
    bool seated_ = false, fresh_ = false;
};

}  // namespace tactus::saw
