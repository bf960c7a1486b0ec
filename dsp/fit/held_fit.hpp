// SPDX-License-Identifier: Apache-2.0
// Adds the pull of a fit to the contact of the held body, for the coupling's solver.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "dsp/fit/fit_energy.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <array>
#include <cstddef>

namespace tactus::fit {

/// Evaluates one half of the fit's energy per tick, alternately, at the proxy. Each half is replaced by its majorising
/// parabola there, which with linearised distances is never below it. Hence lowering the parabolas lowers the energy,
/// and a solver step costs only the contact.
class HeldFit {
public:
    /// `energy` may be null: contact only. Both must outlive this object.
    HeldFit(coupling::HeldContact& contact, FitEnergy* energy) noexcept : contact_(contact), energy_(energy) {}

    /// Evaluates one half (both after `forget`) at the pose `handle`: `moving` is the moving bone's file frame in the
    /// frame of the handle, `fixed` that of the fixed bone in the world. `share` in [0, 1] scales the pull.
    void look(const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept;
    /// Removes the pull until the next `look`.
    void forget() noexcept { halves_ = {}; }

    contact::ContactSum operator()(const Pose& handle, contact::ContactParts parts) noexcept;
    double clearance(const Pose& handle) const noexcept { return contact_.clearance(handle); }

    /// Energy of the fit alone, J, and its force on the body, N, at the last evaluation of its halves.
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
    std::size_t turn_ = 0;  // the half to evaluate next
};

}  // namespace tactus::fit
