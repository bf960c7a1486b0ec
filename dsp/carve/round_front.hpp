// SPDX-License-Identifier: Apache-2.0
// Contact of the round front of a kerf with bone.
#pragma once

#include "dsp/core/types.hpp"

#include <algorithm>

namespace tactus::carve {

/// A front of width 2·radius, round ahead. A Field has `double value(Vec3)`: distance, m, negative in bone; `double
/// density(Vec3)`, kg/m³.
struct RoundFront {
    double radius = 0.0;  ///< m, half the kerf
    double ahead = 0.0;  ///< m: samples lie this far below the surface of the swept body; a quarter voxel

    struct Contact {
        double density = 0.0;  ///< kg/m³ of the bone the front touches; 0: none
        double clear = 0.0;  ///< m of free distance
    };

    /// Samples three points of the round front (Gauss–Legendre nodes across the kerf) and, at `neighbour` to either
    /// side, its middle, all `ahead` below the surface of the swept body. `slack`: tolerated depth in bone, m.
    template <class Field>
    Contact look(const Field& field, const Vec3& at, const Vec3& direction, const Vec3& side, const Vec3& neighbour,
                 double slack) const noexcept {
        const double touching = -ahead + slack;
        const Vec3 middle = at + direction * (radius + ahead);
        const Vec3 low = at + direction * (0.63246 * radius + ahead);
        const Vec3 own[3] = {low - side * (0.77460 * radius), middle, low + side * (0.77460 * radius)};
        constexpr double weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
        double mass = 0.0, share = 0.0, nearest = 1.0;
        for (int n = 0; n < 3; ++n) {
            const double d = field.value(own[n]);
            if (d <= touching) {
                mass += weight[n] * field.density(own[n]);
                share += weight[n];
            }
            nearest = std::min(nearest, d);
        }
        Contact contact;
        if (share > 0.0) {
            contact.density = mass / share;
        } else if (neighbour != Vec3(0.0)) {
            for (const double sign : {-1.0, 1.0}) {
                const Vec3 there = middle + neighbour * sign;
                const double d = field.value(there);
                if (d <= touching) contact.density = std::max(contact.density, field.density(there));
                nearest = std::min(nearest, d);
            }
        }
        if (!(contact.density >= 1.0)) contact.density = 0.0;
        // Bone without density does not resist, but the region may be thin: sample again after a quarter voxel.
        contact.clear = nearest > touching ? nearest + ahead : ahead;
        return contact;
    }

    /// Returns the smallest distance of the three points, m.
    template <class Field>
    double floor(const Field& field, const Vec3& at, const Vec3& direction, const Vec3& side) const noexcept {
        const Vec3 low = at + direction * (0.63246 * radius + ahead);
        return std::min({field.value(at + direction * (radius + ahead)), field.value(low - side * (0.77460 * radius)),
                         field.value(low + side * (0.77460 * radius))});
    }
};

}  // namespace tactus::carve
