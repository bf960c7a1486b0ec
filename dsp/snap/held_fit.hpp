// SPDX-License-Identifier: Apache-2.0
// The pull of a fit beside the contact of the body in the hand, as the coupling's solver asks for it.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/symmetric6.hpp"
#include "dsp/snap/fit_energy.hpp"

namespace tactus {

/// Both paints are read once per tick, at the proxy. Within the tick the fit's energy is the parabola that touches it
/// there and, with the distances straightened, never lies below it: lowering the parabola lowers the energy, and a step
/// costs nothing but the contact.
class HeldFit {
public:
    /// `energy` may be null: then there is contact alone. Both must live as long as this.
    HeldFit(HeldContact& contact, FitEnergy* energy) noexcept : contact_(contact), energy_(energy) {}

    /// Reads the paints with the handle at `handle`: `moving` is the moving bone's file frame in the frame of the handle,
    /// `fixed` that of the standing one in the world. `share` in [0, 1] scales the pull.
    void look(const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept;
    /// No pull until the next look.
    void forget() noexcept { pull_ = {}; }

    ContactSum operator()(const Pose& handle, ContactParts parts) noexcept;
    double clearance(const Pose& handle) const noexcept { return contact_.clearance(handle); }

    /// Of the fit alone, at the pose last looked at, about the handle, world axes.
    const ContactSum& pull() const noexcept { return pull_; }

private:
    HeldContact& contact_;
    FitEnergy* energy_;
    ContactSum pull_;
    Pose at_;
};

}  // namespace tactus
