// SPDX-License-Identifier: Apache-2.0
#include "devices/board/mechanism.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::board {

namespace {

constexpr double min_determinant = 1e-7;  // m²: nearer to a stretched linkage a force would need endless torques

}  // namespace

Mechanism Mechanism::sector(double radius) noexcept {
    Mechanism made;
    made.proximal_ = radius;
    return made;
}

Mechanism Mechanism::pantograph(double proximal, double distal, double spacing) noexcept {
    Mechanism made;
    made.is_sector_ = false;
    made.proximal_ = proximal;
    made.distal_ = distal;
    made.spacing_ = spacing;
    return made;
}

std::optional<Vec3> Mechanism::position(const std::array<double, 2>& angles) const noexcept {
    if (is_sector_) return Vec3(proximal_ * angles[0], 0.0, 0.0);
    const Vec3 left(-0.5 * spacing_ + proximal_ * std::cos(angles[0]), proximal_ * std::sin(angles[0]), 0.0);
    const Vec3 right(0.5 * spacing_ + proximal_ * std::cos(angles[1]), proximal_ * std::sin(angles[1]), 0.0);
    const Vec3 across = right - left;
    const double apart = glm::length(across), height2 = distal_ * distal_ - 0.25 * apart * apart;
    if (!(apart > 1e-6) || !(height2 >= 0.0)) return std::nullopt;
    const Vec3 along = across / apart;
    return left + 0.5 * across + Vec3(-along.y, along.x, 0.0) * std::sqrt(height2);
}

std::array<double, 2> Mechanism::torques(const std::array<double, 2>& angles, const Vec3& force) const noexcept {
    if (is_sector_) return {proximal_ * force.x, 0.0};
    const std::optional<Vec3> handle = position(angles);
    if (!handle) return {};
    // (P − E)·dP = (P − E)·dE for both distal links: A dP = B dθ, hence J = A⁻¹ B.
    std::array<Vec3, 2> link;
    std::array<double, 2> drive{};
    for (std::size_t i = 0; i < 2; ++i) {
        const double side = i == 0 ? -0.5 : 0.5, c = std::cos(angles[i]), s = std::sin(angles[i]);
        link[i] = *handle - Vec3(side * spacing_ + proximal_ * c, proximal_ * s, 0.0);
        drive[i] = glm::dot(link[i], Vec3(-proximal_ * s, proximal_ * c, 0.0));
    }
    const double determinant = link[0].x * link[1].y - link[0].y * link[1].x;
    if (!(std::abs(determinant) > min_determinant)) return {};
    const Vec3 first = Vec3(link[1].y, -link[1].x, 0.0) * (drive[0] / determinant);
    const Vec3 second = Vec3(-link[0].y, link[0].x, 0.0) * (drive[1] / determinant);
    return {glm::dot(first, force), glm::dot(second, force)};
}

}  // namespace tactus::board
