// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/constraint_analysis.hpp"

#include "dsp/geometry/symmetric_eigen.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::fit {

void find_free(Fit& fit, const geometry::Matrix6& stiffness, double radius, double min_hold) {
    const double lever = std::max(radius, 1e-6);
    const double weight = stiffness[0] + stiffness[7] + stiffness[14];  // directions have unit length: Σ k n·n
    geometry::Matrix6 m{};
    if (weight > 0.0)
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j)
                m[6 * i + j] = stiffness[6 * i + j] / (weight * (i < 3 ? 1.0 : lever) * (j < 3 ? 1.0 : lever));
    const geometry::SymmetricEigen<6> eigen = geometry::symmetric_eigen<6>(m);
    fit.hold = eigen.value;
    fit.free.clear();
    for (std::size_t n = 0; n < 6 && eigen.value[n] < min_hold; ++n) {
        const geometry::Vector6& v = eigen.vector[n];
        const Vec3 translation(v[0], v[1], v[2]), rotation(v[3], v[4], v[5]);
        const bool is_rotation = glm::length(rotation) > glm::length(translation);
        fit.free.push_back({is_rotation, glm::normalize(is_rotation ? rotation : translation)});
    }
}

}  // namespace tactus::fit
