// SPDX-License-Identifier: Apache-2.0
// A round burr in a bone.
#pragma once

#include "dsp/carve/cut_front.hpp"
#include "dsp/saw/cutting_law.hpp"
#include "dsp/saw/tool_body.hpp"
#include "dsp/saw/tool_hold.hpp"
#include "dsp/saw/tooth_row.hpp"
#include "dsp/volume/bricks.hpp"

namespace tactus::saw {

struct BurrShape {
    double radius = 0.002;  ///< m
    double flutes = 8.0;  ///< cutting edges
    double shaft_radius = 0.001175;  ///< m: a shank of 2.35 mm (ISO 1797-1); 0: none
    double shaft_length = 0.025;  ///< m, from the ball
};

/// Tool frame: origin in the ball's centre, y the direction of the shaft, towards the bone.
struct BurrContact {
    Wrench wrench;  ///< on the tool about the ball's centre, N and N·m, scene axes
    double load = 0.0;  ///< N, all of the force
    double along = 0.0;  ///< N: force of the flutes around the shaft
    double width = 0.0;  ///< m of a flute in bone; 0: it does not cut
    double lag = 0.0;  ///< m
    double feed = 0.0;  ///< m/s
    double magnitudes = 0.0;  ///< N, sum of the sizes of the forces of the ball and of all points of the shaft
    bool touches = false;
    HoldState state = HoldState::waiting;
};

/// A ball that rests on bone it has not cut: a god object (Zilles and Salisbury 1995), held by a spring. Running, it
/// advances along its own force by an implicit step of the cutting law, one flute bearing at a time over the width of
/// the ball that lies in bone, so that saw and burr share one law of force per width. Otherwise bone stops it, with Coulomb friction. It never moves away from its target, so that the force is passive. The shaft does
/// not cut.
class Burr {
public:
    Burr() = default;
    Burr(const BurrShape& shape, double stiffness);

    /// `drive.rate`: turns per second. A pose that is none gives no force and drops the bone. Allocates nothing.
    BurrContact step(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive,
                     const CuttingLaw& law) noexcept;

    void fill(carve::CutFront& front, const Pose& pose, bool running) const noexcept;
    const Vec3& at() const noexcept { return at_; }

private:
    struct Touch;

    Touch touch(const volume::BoneSnapshot& bone, const Vec3& lag, double ahead) const noexcept;
    double follow(const volume::BoneSnapshot& bone, bool running, double moved) noexcept;
    double width_in(const volume::BoneSnapshot& bone) const noexcept;
    void cut(const volume::BoneSnapshot& bone, const Drive& drive, double density, const CuttingLaw& law,
             BurrContact& into) noexcept;

    BurrShape shape_;
    double stiffness_ = 0.0;
    Vec3 at_{0.0, 0.0, 0.0}, target_{0.0, 0.0, 0.0};
    ToolBody shaft_;
    ToolHold hold_;
    Pose last_;
    bool fresh_ = false;
    bool stuck_ = false;  // in the last tick
};

}  // namespace tactus::saw
