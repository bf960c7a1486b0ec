// SPDX-License-Identifier: Apache-2.0
// Keeps a body in contact from going through the middle of a wall.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/geometry/symmetric6.hpp"

#include <cmath>
#include <cstddef>

namespace tactus::coupling {

/// In the middle of a wall the nearest surface changes sides and the force turns over. The guard remembers the force with
/// which a contact began, follows it while the points agree on a direction, and refuses motions that go on against it to a place where
/// the force points the other way. The way back is always free. Only the points' own forces count. It sees the sum over
/// all points: a larger contact elsewhere can hide a small one that turns over.
class WallGuard {
public:
    void forget() noexcept { in_contact_ = false; }

    /// `now`: at a place where the body is; `depth` m: walls are thicker than four times this.
    void see(const contact::ContactSum& now, double depth) noexcept {
        const Forces& g = now.contact_gradient;
        if (now.in_contact == 0) forget();
        else if (!in_contact_ || now.penetration <= depth || is_steady(now, 0.5)) {
            began_ = g;
            in_contact_ = true;
        }
    }

    /// A motion by `displacement` to a place with contact `after` goes through the middle of a wall.
    bool refuses(const contact::ContactSum& after, const geometry::Vector6& displacement, double depth) const noexcept {
        if (!in_contact_ || !(after.penetration > depth)) return false;
        double into = 0.0;
        for (std::size_t i = 0; i < 6; ++i) into += began_[i] * displacement[i];
        return into > 0.0 && dot3(began_, after.contact_gradient) < 0.0 && is_steady(after, 0.2);
    }

private:
    using Forces = std::array<double, 6>;

    static double dot3(const Forces& a, const Forces& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    /// The points agree on a direction: the sum of their forces is at least `share` of the sum of their sizes.
    static bool is_steady(const contact::ContactSum& sum, double share) noexcept {
        return std::sqrt(dot3(sum.contact_gradient, sum.contact_gradient)) > share * sum.total_force;
    }

    Forces began_{};
    bool in_contact_ = false;
};

}  // namespace tactus::coupling
