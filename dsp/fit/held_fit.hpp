// SPDX-License-Identifier: Apache-2.0
// The pull of a fit beside the contact of the body in the hand, as the coupling's solver asks for it.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "dsp/geometry/symmetric6.hpp"
#include "dsp/fit/fit_energy.hpp"

#include <array>
#include <cstddef>

namespace tactus::fit {

/// The paints are read once per tick, at the proxy, one of them in each tick in turn. Each half of the fit's energy is the
/// parabola that touches it where it was last read and, with the distances straightened, never lies below it: lowering
/// the parabolas lowers the energy, and a step costs nothing but the contact.
class HeldFit {
public:
    /// `energy` may be null: then there is contact alone. Both must live as long as this.
    HeldFit(coupling::HeldContact& contact, FitEnergy* energy) noexcept : contact_(contact), energy_(energy) {}

    /// Reads a paint, after `forget` both, with the handle at `handle`: `moving` is the moving bone's file frame in the frame of the handle,
    /// `fixed` that of the standing one in the world. `share` in [0, 1] scales the pull.
    void look(const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept;
    /// No pull until the next look.
    void forget() noexcept { halves_ = {}; }

    contact::ContactSum operator()(const Pose& handle, contact::ContactParts parts) noexcept;
    double clearance(const Pose& handle) const noexcept { return contact_.clearance(handle); }

    /// Energy of the fit alone, J, and its force on the body, N, where its halves were last read.
    double energy() const noexcept { return halves_[0].pull.energy + halves_[1].pull.energy; }
    double force() const noexcept;

private:
    struct Half {
        contact::ContactSum pull;  ///< about the handle, world axes
        Pose at;  ///< of the handle
        bool is_read = false;
    };
    void read(FitHalf half, const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept;

    coupling::HeldContact& contact_;
    FitEnergy* energy_;
    std::array<Half, 2> halves_;
    std::size_t turn_ = 0;  // the half that is read next
};

}  // namespace tactus::fit
