// SPDX-License-Identifier: Apache-2.0
#include "dsp/rope/rope.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus::rope {

namespace {

constexpr double near_bone = 1e-3;  // m: points within this distance of contact are watched

double square(double x) { return x * x; }

}  // namespace

RopeMaterial artery() {
    RopeMaterial material;
    const double area = 3.6e-6, stress = 62e3, strain = 0.12, wall_middle = 1.275e-3;
    material.stiffness = area * stress / strain;
    // A thin tube's second moment of area is area · radius² / 2.
    material.bending = stress / strain * area * square(wall_middle) / 2.0;
    material.weight = 0.07;  // full of blood: 7.1 mm² of 1000 kg/m³
    material.radius = 1.5e-3;
    material.friction = 0.05;  // wet tissue on bone; a guess
    return material;
}

Rope::Rope(std::vector<Vec3> points, std::vector<double> rest, const RopeMaterial& material,
           const RopeSettings& settings)
    : material_(material),
      settings_(settings),
      x_(std::move(points)),
      rest_(std::move(rest)),
      band_(x_.size()),
      base_(x_.size()) {
    if (x_.size() < 3 || rest_.size() + 1 != x_.size())
        throw Error(fmt::format("a rope of {} points and {} rest lengths", x_.size(), rest_.size()));
    for (std::size_t n = 0; n < x_.size(); ++n)
        if (!is_finite(x_[n]) || (n > 0 && !(rest_[n - 1] > 1e-6 && rest_[n - 1] < 10.0)))
            throw Error(fmt::format("a rope's point {} or the rest length before it is no length", n));
    const bool is_material = material.stiffness > 0.0 && material.bending >= 0.0 && material.drag > 0.0 &&
                             material.radius >= 0.0 && material.friction >= 0.0 && std::isfinite(material.weight);
    const bool is_setting = settings.substeps > 0 && settings.max_iterations > 0 && settings.tolerance > 0.0 &&
                            settings.contact_stiffness > 0.0 && settings.stick_stiffness > 0.0;
    if (!is_material || !is_setting) throw Error("a rope's stiffness and drag must be positive, nothing negative");
    before_ = trial_ = seen_ = normal_before_ = move_ = rest_of_gradient_ = target_ = x_;
    resists_.assign(rest_.size(), 0);
    touching_.assign(x_.size(), 0);
    load_.assign(x_.size(), Vec3(0.0));
    normal_ = load_;
    depth_.assign(x_.size(), 0.0);
    held_.assign(x_.size(), false);
    stick_.assign(x_.size(), {});
    curve_.assign(x_.size(), {});
    length_.assign(rest_.size(), 0.0);
    share_.assign(x_.size(), 0.0);
    bend_.assign(x_.size(), 0.0);
    clear_.assign(x_.size(), 0.0);
    for (std::size_t n = 0; n < rest_.size(); ++n) {
        share_[n] += 0.5 * rest_[n];
        share_[n + 1] += 0.5 * rest_[n];
    }
    for (std::size_t n = 1; n + 1 < x_.size(); ++n) bend_[n] = material_.bending / (share_[n] * share_[n] * share_[n]);
    measure();
}

void Rope::clamp_first(const std::optional<Vec3>& direction) noexcept {
    clamp_[0] = direction;
    bend_.front() = clamped_weight(rest_.front(), direction.has_value());
}

void Rope::clamp_last(const std::optional<Vec3>& direction) noexcept {
    clamp_[1] = direction;
    bend_.back() = clamped_weight(rest_.back(), direction.has_value());
}

/// At a clamp the rope continues as its mirror image, of which half belongs to the rope.
double Rope::clamped_weight(double l, bool is_clamped) const noexcept {
    return is_clamped ? 2.0 * material_.bending / (l * l * l) : 0.0;
}

void Rope::hold(std::size_t point, const Vec3& place) noexcept {
    if (!is_finite(place)) return;
    held_[point] = true;
    target_[point] = place;
}

void Rope::release(std::size_t point) noexcept { held_[point] = false; }

double Rope::tension(std::size_t segment) const noexcept {
    const double strain = glm::length(x_[segment + 1] - x_[segment]) / rest_[segment] - 1.0;
    return material_.stiffness * std::max(strain, 0.0);
}

double Rope::length() const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n + 1 < x_.size(); ++n) sum += glm::length(x_[n + 1] - x_[n]);
    return sum;
}

double Rope::rest_length() const noexcept { return std::accumulate(rest_.begin(), rest_.end(), 0.0); }

Vec3 Rope::bend_at(std::size_t point) const noexcept {
    if (point == 0) return x_[1] - x_[0] - rest_[0] * *clamp_[0];
    const std::size_t last = x_.size() - 1;
    if (point == last) return x_[last - 1] - x_[last] + rest_[last - 1] * *clamp_[1];
    return x_[point - 1] - 2.0 * x_[point] + x_[point + 1];
}

/// Way of a point from its anchor along the surface.
Vec3 Rope::slip(std::size_t point) const noexcept {
    const Stick& s = stick_[point];
    const Vec3 way = x_[point] - s.anchor;
    return way - glm::dot(way, s.normal) * s.normal;
}

void Rope::measure() noexcept {
    for (std::size_t n = 0; n < rest_.size(); ++n) length_[n] = glm::length(x_[n + 1] - x_[n]);
}

/// Skips points that have moved less than their last clearance, because the bone is fixed within a tick.
void Rope::look_at(const Obstacle* bone, bool is_anew) noexcept {
    measure();
    if (!bone) return;
    for (std::size_t n = 0; n < x_.size(); ++n) {
        if (held_[n]) {
            depth_[n] = 0.0;
            continue;
        }
        if (!is_anew && clear_[n] > 0.0) {
            const Vec3 way = x_[n] - seen_[n];
            if (glm::dot(way, way) < clear_[n] * clear_[n]) continue;
        }
        depth_[n] = material_.radius - bone->distance(x_[n], normal_[n]);
        // No contact where the field has no gradient.
        if (normal_[n] == Vec3(0.0)) depth_[n] = std::min(depth_[n], 0.0);
        clear_[n] =
            depth_[n] < -near_bone ? bone->free_way(x_[n], material_.radius - depth_[n], material_.radius) : 0.0;
        if (clear_[n] > 0.0) {
            seen_[n] = x_[n];
            normal_[n] = Vec3(0.0);
        }
    }
}

double Rope::potential(double drag) const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < rest_.size(); ++n)
        sum += 0.5 * material_.stiffness / rest_[n] * square(std::max(0.0, length_[n] - rest_[n]));
    for (std::size_t n = 0; n < x_.size(); ++n) {
        if (const double w = bend_[n]; w > 0.0) {
            const Vec3 bend = bend_at(n);
            sum += 0.5 * w * glm::dot(bend, bend);
        }
        sum += material_.weight * share_[n] * x_[n].z;
        if (held_[n]) continue;
        sum -= glm::dot(load_[n], x_[n]);
        if (depth_[n] > 0.0) sum += 0.5 * settings_.contact_stiffness * square(depth_[n]);
        if (stick_[n].limit > 0.0) {
            const double way = glm::length(slip(n)), free = stick_[n].limit / settings_.stick_stiffness;
            sum += way < free ? 0.5 * settings_.stick_stiffness * way * way : stick_[n].limit * (way - 0.5 * free);
        }
        if (drag > 0.0) {
            const Vec3 moved = x_[n] - before_[n];
            sum += 0.5 * drag * share_[n] * glm::dot(moved, moved);
        }
    }
    return sum;
}

double Rope::energy() const noexcept { return potential(0.0); }

Vec3 Rope::pull_on(std::size_t point) const noexcept {
    Vec3 force(0.0, 0.0, -material_.weight * share_[point]);
    const auto along = [&](std::size_t from, std::size_t to, double tension_of) {
        const Vec3 d = x_[to] - x_[from];
        const double l = glm::length(d);
        if (l > 0.0) force += tension_of / l * d;
    };
    if (point > 0) along(point, point - 1, tension(point - 1));
    if (point + 1 < x_.size()) along(point, point + 1, tension(point));
    const std::size_t first = point > 0 ? point - 1 : 0, last = std::min(point + 1, x_.size() - 1);
    for (std::size_t n = first; n <= last; ++n) {
        const double w = bend_[n];
        if (!(w > 0.0)) continue;
        const bool is_end = n == 0 || n + 1 == x_.size();
        const double sign = n == point ? (is_end ? -1.0 : -2.0) : 1.0;
        // The first end's bend counts x₁ - x₀, the last one's the same towards the inside.
        force -= sign * w * bend_at(n);
    }
    return force;
}

void Rope::begin_friction() noexcept {
    for (std::size_t n = 0; n < x_.size(); ++n) {
        Stick& s = stick_[n];
        const bool touched = depth_[n] > 0.0 && !held_[n] && material_.friction > 0.0;
        if (!touched) {
            s.limit = 0.0;
            continue;
        }
        if (!(s.limit > 0.0)) s.anchor = x_[n];
        s.normal = normal_[n];
        s.limit = material_.friction * settings_.contact_stiffness * depth_[n];
        // A weaker hold lets the anchor follow.
        const Vec3 way = slip(n);
        const double free = s.limit / settings_.stick_stiffness, length_of = glm::length(way);
        s.anchor = x_[n] - (length_of > free ? free / length_of : 1.0) * way;
    }
}

void Rope::end_friction() noexcept {
    for (std::size_t n = 0; n < x_.size(); ++n) {
        Stick& s = stick_[n];
        if (!(s.limit > 0.0)) continue;
        const Vec3 way = slip(n);
        const double free = s.limit / settings_.stick_stiffness, length_of = glm::length(way);
        if (length_of > free) s.anchor = x_[n] - free / length_of * way;
    }
}

RopeStep Rope::step(double h, const Obstacle* bone) noexcept {
    RopeStep report;
    if (!(h > 0.0)) return report;
    report.is_solved = true;
    const auto allowed = [&](std::size_t p) { return 0.5 * std::min(2.0 * share_[p], rest_[p ? p - 1 : 0]); };
    // As many substeps as the fastest held point needs.
    double max_parts = 1.0;
    for (std::size_t p = 0; p < x_.size(); ++p)
        if (held_[p]) max_parts = std::max(max_parts, glm::length(target_[p] - x_[p]) / settings_.way);
    const int substeps = static_cast<int>(std::ceil(std::min(max_parts, static_cast<double>(settings_.substeps))));
    if (!bone) {
        std::ranges::fill(depth_, 0.0);
        std::ranges::fill(normal_, Vec3(0.0));
    }
    for (int n = 0; n < substeps; ++n) {
        before_ = x_;
        report.lag = 0.0;
        for (std::size_t p = 0; p < x_.size(); ++p) {
            if (!held_[p]) continue;
            const Vec3 way = target_[p] - x_[p];
            const double length_of = glm::length(way);
            const double part = std::min(1.0 / (substeps - n), length_of > 0.0 ? allowed(p) / length_of : 1.0);
            x_[p] = part >= 1.0 ? target_[p] : x_[p] + part * way;
            report.lag = std::max(report.lag, (1.0 - part) * length_of);
        }
        begin_friction();
        look_at(bone, n == 0);
        const int left = settings_.max_iterations * settings_.substeps - report.iterations;
        const int most = left - settings_.max_iterations / 2 * (substeps - 1 - n);
        report.is_solved = substep(h / substeps, bone, most, report) && report.is_solved;
        end_friction();
    }
    for (const double depth : depth_) report.contacts += depth > 0.0;
    return report;
}

}  // namespace tactus::rope
