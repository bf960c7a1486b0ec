// SPDX-License-Identifier: Apache-2.0
#include "dsp/snap/held_fit.hpp"

#include "dsp/operator/hand.hpp"
#include "dsp/snap/fit.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus {

namespace {

/// The same sum about another point and along other axes: `arm` from there to the old point, new axes; `turn` takes old
/// axes to new ones.
ContactSum carried(const ContactSum& sum, const Mat3& turn, const Vec3& arm, double share) noexcept {
    // Motion of the old frame from that of the new one: v' = turnᵀ (v + ω × arm), ω' = turnᵀ ω.
    Matrix6 motion{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const Vec3 axis(column == 0, column == 1, column == 2), old = turn[row];
            const auto r = static_cast<std::size_t>(row), c = static_cast<std::size_t>(column);
            motion[6 * r + c] = motion[6 * (r + 3) + c + 3] = glm::dot(old, axis);
            motion[6 * r + c + 3] = glm::dot(old, glm::cross(axis, arm));
        }
    ContactSum out;
    Matrix6 half{};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) {
            out.gradient[i] += share * motion[6 * j + i] * sum.gradient[j];
            for (std::size_t k = 0; k < 6; ++k) half[6 * i + j] += sum.stiffness[6 * i + k] * motion[6 * k + j];
        }
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = i; j < 6; ++j) {
            double entry = 0.0;
            for (std::size_t k = 0; k < 6; ++k) entry += motion[6 * k + i] * half[6 * k + j];
            out.stiffness[6 * i + j] = out.stiffness[6 * j + i] = share * entry;
        }
    out.energy = share * sum.energy;
    return out;
}

}  // namespace

void HeldFit::look(const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept {
    if (!energy_ || !(share > 0.0)) return forget();
    if (!halves_[1 - turn_].is_read) read(static_cast<FitHalf>(1 - turn_), handle, moving, fixed, share);
    read(static_cast<FitHalf>(turn_), handle, moving, fixed, share);
    // One-sided, there is nothing to take turns with.
    turn_ = energy_->law.two_sided ? 1 - turn_ : 0;
}

void HeldFit::read(FitHalf half, const Pose& handle, const Pose& moving, const Pose& fixed, double share) noexcept {
    const Pose body = handle * moving;
    const Pose centres = between_centres(energy_->moving(), energy_->fixed(), fixed.inverse() * body);
    const Vec3 arm = body.apply(energy_->moving().centre) - handle.position;
    const ContactSum sum = energy_->look_at_half(half, centres);
    halves_[static_cast<std::size_t>(half)] = {
        carried(sum, glm::mat3_cast(fixed.orientation), arm, std::min(share, 1.0)), handle, true};
}

double HeldFit::force() const noexcept {
    Vec3 sum(0.0);
    for (const Half& half : halves_) sum += Vec3(half.pull.gradient[0], half.pull.gradient[1], half.pull.gradient[2]);
    return glm::length(sum);
}

ContactSum HeldFit::operator()(const Pose& handle, ContactParts parts) noexcept {
    ContactSum sum = contact_(handle, parts);
    for (const auto& [pull, at, is_read] : halves_) {
        if (!is_read || pull.energy == 0.0) continue;
        const Vec3 way = handle.position - at.position, turn = rotation_between(at.orientation, handle.orientation);
        const Vector6 x{way.x, way.y, way.z, turn.x, turn.y, turn.z};
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

}  // namespace tactus
