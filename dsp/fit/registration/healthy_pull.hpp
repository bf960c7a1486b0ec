// SPDX-License-Identifier: Apache-2.0
// Adds the healthy side to the fit of the faces: the outside of a fragment is pulled weakly onto it. So it determines
// only directions that the faces leave free. The weight is low because the two sides of a body differ by a millimetre,
// unlike two faces.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/fit/registration/registration.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

struct HealthyPullSettings {
    const RegistrationTarget* side = nullptr;  ///< in the frame of the poses; must outlive the matcher; null: none
    double scale = 1e-3;  ///< m, of the robust kernel: points farther away have little weight
    double weight = 0.05;  ///< of all points together, relative to the leading face
    std::size_t max_points = 500;  ///< maximum per fragment
};

/// The outside of one fragment.
class HealthyPull {
public:
    /// Selects points without `fracture` paint, evenly from the list. Only this constructor allocates.
    HealthyPull(std::span<const contact::SurfacePoint> points, const HealthyPullSettings& settings);

    /// Updates partners and weights for this pose of the fragment.
    void look(const Pose& body) noexcept;
    /// Adds energy, gradient and stiffness (both triangles) about `origin`, with those partners; `strength`: sum over
    /// all points, N/m.
    void add(contact::ContactSum& sum, const Pose& body, const Vec3& origin, double strength) const noexcept;

private:
    struct Link {
        Vec3 from, normal;  ///< of the fragment, its frame
        Vec3 to{0.0}, along{0.0};  ///< of the healthy side
        double share = 0.0, weight = 0.0;
    };
    HealthyPullSettings settings_;
    std::vector<Link> links_;
};

}  // namespace tactus::fit
