// SPDX-License-Identifier: Apache-2.0
// A saw blade in a bone: the force that it feels and the front that it cuts.
#pragma once

#include "dsp/saw/take_over.hpp"
#include "dsp/saw/tool_body.hpp"
#include "dsp/saw/tool_hold.hpp"
#include "dsp/saw/tooth_row.hpp"

namespace tactus::saw {

struct SawContact {
    Wrench wrench;  ///< on the blade about the given origin, N and N·m, scene axes
    double thrust = 0.0;  ///< N against the cutting direction, ≥ 0
    double along = 0.0;  ///< N: force of the teeth along the stroke, to and fro
    double side = 0.0;  ///< N across the blade
    double lag = 0.0;  ///< m: greatest distance of a point of the blade from where bone holds it
    double feed = 0.0;  ///< m/s, advance of the teeth that cut
    double teeth = 0.0;  ///< teeth that bear on bone
    double magnitudes = 0.0;  ///< N, sum of the sizes of the forces of all points
    int count = 0;  ///< points held by bone
    HoldState state = HoldState::waiting;
};

/// Both families of springs, those of the teeth and of the blade's body, have the energy ½·(K/c)·‖lag‖₈² (see contact/blade.hpp): the hand feels at
/// most about K however many points touch.
class SawBlade {
public:
    SawBlade() = default;
    SawBlade(const SawShape& shape, double stiffness);

    /// One tick: the blade is held at `pose`. A pose that is none gives no force and drops the bone. `guide`: a solid that
    /// stops the blade and that no tooth cuts; null: none. Allocates nothing.
    SawContact step(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive, const CuttingLaw& law,
                    const PlacedSolid* guide = nullptr) noexcept;

    const ToothRow& teeth() const noexcept { return teeth_; }
    const ToolBody& body() const noexcept { return body_; }

private:
    double push_teeth(const Mat3& axes, const Vec3& about, const CuttingLaw& law, bool running,
                      SawContact& into) noexcept;

    SawShape shape_;
    ToothRow teeth_;
    ToolBody body_, front_;  // the front meets guides only, in their frame
    ToolHold hold_;
    TakeOver take_over_;
    double tooth_spring_ = 0.0;
    Pose last_;
    bool stuck_ = false;  // in the last tick
};

}  // namespace tactus::saw
