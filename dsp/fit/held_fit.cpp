// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/held_fit.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/fit/adjoint.hpp"
#include "dsp/fit/fit.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::fit {

void HeldFit::look(const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept {
    if (!energy_ || !(share > 0.0)) return forget();
    if (!halves_[1 - turn_].is_read) read(static_cast<FitHalf>(1 - turn_), handle, moving, fixed, share);
    read(static_cast<FitHalf>(turn_), handle, moving, fixed, share);
    // A one-sided fit has one half only.
    turn_ = energy_->law.two_sided ? 1 - turn_ : 0;
}

void HeldFit::read(FitHalf half, const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept {
    const Pose body = handle * moving;
    const Pose centres = between_centres(energy_->moving(), energy_->fixed(), fixed.inverse() * body);
    const Vec3 arm = body.apply(energy_->moving().centre) - handle.position;
    const contact::ContactSum sum = energy_->look_at_half(half, centres);
    halves_[static_cast<std::size_t>(half)] = {
        adjoint_transform(sum, glm::mat3_cast(fixed.orientation), arm, std::min(share, 1.0)), handle, true};
}

double HeldFit::force() const noexcept {
    Vec3 sum(0.0);
    for (const Half& half : halves_) sum += Vec3(half.pull.gradient[0], half.pull.gradient[1], half.pull.gradient[2]);
    return glm::length(sum);
}

contact::ContactSum HeldFit::operator()(const Pose& handle, contact::ContactParts parts) noexcept {
    contact::ContactSum sum = contact_(handle, parts);
    for (const auto& [pull, at, is_read] : halves_) {
        if (!is_read || pull.energy == 0.0) continue;
        const Vec3 translation = handle.position - at.position,
                   rotation = rotation_between(at.orientation, handle.orientation);
        const geometry::Vector6 x{translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z};
        sum.energy += pull.energy;
        for (std::size_t i = 0; i < 6; ++i) {
            double slope = pull.gradient[i];
            for (std::size_t j = 0; j < 6; ++j) {
                slope += pull.stiffness[6 * i + j] * x[j];
                sum.stiffness[6 * i + j] += pull.stiffness[6 * i + j];
            }
            sum.energy += 0.5 * x[i] * (slope + pull.gradient[i]);
            sum.gradient[i] += slope;
        }
    }
    return sum;
}

}  // namespace tactus::fit
