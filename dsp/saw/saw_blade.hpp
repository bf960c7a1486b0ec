// SPDX-License-Identifier: Apache-2.0
// A saw blade in a bone: the force that it feels and the front that it cuts.
#pragma once

#include "dsp/saw/blade_faces.hpp"
#include "dsp/saw/tooth_row.hpp"

#include <vector>

namespace tactus::saw {

struct SawContact {
    Wrench wrench;  ///< on the blade about the given origin, N and N·m, scene axes
    double thrust = 0.0;  ///< N against the cutting direction, ≥ 0
    double along = 0.0;  ///< N: force of the teeth along the stroke, to and fro
    double side = 0.0;  ///< N across the blade
    double lag = 0.0;  ///< m: greatest distance of a point of the blade from where bone holds it
    double feed = 0.0;  ///< m/s, advance of the teeth that cut
    double teeth = 0.0;  ///< teeth that bear on bone
    int count = 0;  ///< points held by bone
};

/// Both families of springs, teeth and faces, have the energy ½·(K/c)·‖lag‖₈² (see contact/blade.hpp): the hand feels at
/// most about K however many points touch.
class SawBlade {
public:
    SawBlade() = default;
    SawBlade(const SawShape& shape, double stiffness);

    /// One tick: the blade is held at `pose`. A pose that is none gives no force and lets go of the bone. Allocates
    /// nothing.
    SawContact step(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive,
                    const CuttingLaw& law) noexcept;

    const ToothRow& teeth() const noexcept { return teeth_; }
    const BladeFaces& faces() const noexcept { return faces_; }

private:
    void push_teeth(const Mat3& axes, const Vec3& about, const CuttingLaw& law, bool running,
                    SawContact& into) noexcept;
    void push_faces(const Mat3& axes, const Vec3& about, SawContact& into) noexcept;

    ToothRow teeth_;
    BladeFaces faces_;
    double tooth_spring_ = 0.0, face_spring_ = 0.0;
    std::vector<double> squares_;
};

}  // namespace tactus::saw
