// SPDX-License-Identifier: Apache-2.0
// The healthy side in the same fit as the faces: the outside of a fragment is pulled onto it, weakly, so that it decides
// along directions in which the faces do not hold. The two sides of a body differ by a millimetre; faces do not.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/fit/registration/registration.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

struct HealthyPullSettings {
    const RegistrationTarget* side = nullptr;  ///< in the frame of the poses; outlives the matcher; null: none
    double scale = 1e-3;  ///< m, of the robust kernel: what is farther away has little weight
    double weight = 0.05;  ///< of all points together, relative to the leading face
    std::size_t most_points = 500;  ///< of a fragment
};

/// The outside of one fragment.
class HealthyPull {
public:
    /// Chooses points without `fracture` paint, evenly from the list. Allocates here only.
    HealthyPull(std::span<const contact::SurfacePoint> points, const HealthyPullSettings& settings);

    /// Partners and weights at this pose of the fragment.
    void look(const Pose& body) noexcept;
    /// Adds energy, gradient and stiffness (both triangles) about `origin`, with those partners; `strength`: N/m of all
    /// points.
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
