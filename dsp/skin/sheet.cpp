// SPDX-License-Identifier: Apache-2.0
#include "dsp/skin/sheet.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::skin {

namespace {

constexpr int max_rounds_per_step = 30, max_halvings = 30;
constexpr double relative_residual = 1e-3;  // of the conjugate gradients: Newton's rounds correct the rest
constexpr double finest_motion = 1e-8;        // m: a smaller round ends a step

void require(bool is_right, const char* what) {
    if (!is_right) throw Error(fmt::format("a sheet of skin: {}", what));
}

bool is_within(double value, double low, double high) { return value >= low && value <= high; }

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += glm::dot(a[n], b[n]);
    return sum;
}

/// Of a spring of stiffness k: positive semidefinite, without the part that pushes sideways when it is shortened.
Mat3 spring_hessian(const Vec3& along, double rest, double stiffness) {
    const double length = glm::length(along);
    if (length < 1e-12) return Mat3(stiffness);
    const Vec3 u = along / length;
    const Mat3 outer = glm::outerProduct(u, u);
    return stiffness * (outer + std::max(0.0, 1.0 - rest / length) * (Mat3(1.0) - outer));
}

}  // namespace

Sheet::Sheet(const SheetSettings& s, const Pose& pose) : settings_(s) {
    require(s.columns >= 2 && s.columns <= 200 && s.rows >= 2 && s.rows <= 200, "2 to 200 nodes per side");
    require(is_within(s.length, 1e-3, 1.0) && is_within(s.width, 1e-3, 1.0), "length and width from 1 mm to 1 m");
    require(is_within(s.thickness, 1e-4, 0.1), "thickness from 0.1 mm to 100 mm");
    require(is_within(s.young, 1.0, 1e9) && is_within(s.shear, 0.0, 1e9) && is_within(s.bending_young, 0.0, 1e9),
            "moduli from 0 (Young's: 1 Pa) to 1 GPa");
    require(is_within(s.density, 1.0, 1e5), "density from 1 to 100000 kg/m3");
    require(is_within(s.contact, 0.0, 1e6) && is_within(s.drag, 0.0, 1e6), "contact and drag that are not negative");
    require(is_valid(pose), "a valid pose");

    const double du = s.length / (s.columns - 1), dv = s.width / (s.rows - 1);
    const auto share_of_row = [&](int row) { return row == 0 || row == s.rows - 1 ? 0.5 * dv : dv; };
    const auto share_of_column = [&](int column) { return column == 0 || column == s.columns - 1 ? 0.5 * du : du; };
    const auto count = static_cast<std::size_t>(s.columns) * static_cast<std::size_t>(s.rows);
    positions_.reserve(count);
    for (int row = 0; row < s.rows; ++row)
        for (int column = 0; column < s.columns; ++column) {
            positions_.push_back(pose.apply({column * du - 0.5 * s.length, row * dv - 0.5 * s.width, 0.0}));
            areas_.push_back(share_of_row(row) * share_of_column(column));
            masses_.push_back(areas_.back() * s.thickness * s.density);
        }
    // Bending stiffness per width of a plate without transverse contraction, N m.
    const double rigidity = s.bending_young * s.thickness * s.thickness * s.thickness / 12.0;
    for (int row = 0; row < s.rows; ++row)
        for (int column = 0; column < s.columns; ++column) {
            const int here = index(column, row);
            if (column + 1 < s.columns)
                stretches_.push_back(
                    {here, index(column + 1, row), du, s.young * s.thickness * share_of_row(row) / du});
            if (row + 1 < s.rows)
                stretches_.push_back(
                    {here, index(column, row + 1), dv, s.young * s.thickness * share_of_column(column) / dv});
            if (column + 2 < s.columns)
                bends_.push_back({here, index(column + 1, row), index(column + 2, row),
                                  rigidity * share_of_row(row) / (du * du * du)});
            if (row + 2 < s.rows)
                bends_.push_back({here, index(column, row + 1), index(column, row + 2),
                                  rigidity * share_of_column(column) / (dv * dv * dv)});
            if (column + 1 < s.columns && row + 1 < s.rows) {
                const int n10 = index(column + 1, row), n01 = index(column, row + 1), n11 = index(column + 1, row + 1);
                shears_.push_back({here, n10, n01, n11, du * dv, s.shear * s.thickness * du * dv});
                twists_.push_back({here, n10, n01, n11, 2.0 * rigidity / (du * dv)});
            }
        }
    held_.assign(count, 0);
    const std::vector<Vec3> zero(count, Vec3(0.0));
    velocities_ = predicted_ = before_ = trial_ = gradient_ = direction_ = residual_ = product_ = search_ = scaled_ =
        zero;
    stretch_hessians_.resize(stretches_.size());
    shear_u_.resize(shears_.size());
    shear_v_.resize(shears_.size());
    node_hessians_.resize(count);
    inverse_diagonals_.resize(count);
}

void Sheet::pin(int node, const Vec3& at) noexcept {
    const auto n = static_cast<std::size_t>(node);
    held_[n] = 1;
    positions_[n] = at;
    velocities_[n] = Vec3(0.0);
}

void Sheet::release(int node) noexcept { held_[static_cast<std::size_t>(node)] = 0; }

double Sheet::contact_energy(const Vec3& at, const rope::Obstacle& obstacle, Vec3& normal,
                             double& depth) const noexcept {
    depth = 0.5 * settings_.thickness - obstacle.distance(at, normal);
    if (!(depth > 0.0)) return depth = 0.0;
    return 0.5 * settings_.contact * depth * depth;
}

double Sheet::energy(std::span<const Vec3> at, const SheetLoads& loads) const noexcept {
    const auto p = [&](int node) -> const Vec3& { return at[static_cast<std::size_t>(node)]; };
    double sum = 0.0;
    for (const Stretch& s : stretches_) {
        const double longer = glm::length(p(s.b) - p(s.a)) - s.length;
        sum += 0.5 * s.stiffness * longer * longer;
    }
    for (const Shear& s : shears_) {
        const Vec3 u = 0.5 * (p(s.n10) - p(s.n00) + p(s.n11) - p(s.n01)),
                   v = 0.5 * (p(s.n01) - p(s.n00) + p(s.n11) - p(s.n10));
        const double angle = glm::dot(u, v) / s.across;
        sum += 0.5 * s.weight * angle * angle;
    }
    for (const Bend& b : bends_) {
        const Vec3 c = p(b.a) - 2.0 * p(b.b) + p(b.c);
        sum += 0.5 * b.weight * glm::dot(c, c);
    }
    for (const Twist4& t : twists_) {
        const Vec3 c = p(t.n00) - p(t.n10) - p(t.n01) + p(t.n11);
        sum += 0.5 * t.weight * glm::dot(c, c);
    }
    for (std::size_t n = 0; n < at.size(); ++n)
        sum -= glm::dot(masses_[n] * loads.gravity + areas_[n] * loads.pressure, at[n]);
    for (const Tether& t : loads.tethers) {
        const double longer = glm::length(p(t.node) - t.to) - t.slack_length;
        if (longer > 0.0) sum += 0.5 * t.stiffness * longer * longer;
    }
    if (loads.obstacle) {
        Vec3 normal;
        double depth = 0.0;
        for (const Vec3& place : at) sum += contact_energy(place, *loads.obstacle, normal, depth);
    }
    return sum;
}

void Sheet::add_bending(std::span<const Vec3> at, std::vector<Vec3>& out) const noexcept {
    const auto p = [&](int node) -> const Vec3& { return at[static_cast<std::size_t>(node)]; };
    const auto add = [&](int node, const Vec3& part) { out[static_cast<std::size_t>(node)] += part; };
    for (const Bend& b : bends_) {
        const Vec3 c = b.weight * (p(b.a) - 2.0 * p(b.b) + p(b.c));
        add(b.a, c);
        add(b.b, -2.0 * c);
        add(b.c, c);
    }
    for (const Twist4& t : twists_) {
        const Vec3 c = t.weight * (p(t.n00) - p(t.n10) - p(t.n01) + p(t.n11));
        add(t.n00, c);
        add(t.n10, -c);
        add(t.n01, -c);
        add(t.n11, c);
    }
}

void Sheet::elastic_gradient(std::span<const Vec3> at, std::vector<Vec3>& out) const noexcept {
    const auto p = [&](int node) -> const Vec3& { return at[static_cast<std::size_t>(node)]; };
    const auto add = [&](int node, const Vec3& force) { out[static_cast<std::size_t>(node)] += force; };
    for (const Stretch& s : stretches_) {
        const Vec3 along = p(s.b) - p(s.a);
        const double length = glm::length(along);
        if (length < 1e-12) continue;
        const Vec3 force = s.stiffness * (1.0 - s.length / length) * along;
        add(s.b, force);
        add(s.a, -force);
    }
    for (const Shear& s : shears_) {
        const Vec3 u = 0.5 * (p(s.n10) - p(s.n00) + p(s.n11) - p(s.n01)),
                   v = 0.5 * (p(s.n01) - p(s.n00) + p(s.n11) - p(s.n10));
        const double scale = 0.5 * s.weight * glm::dot(u, v) / (s.across * s.across);
        const Vec3 plus = scale * (u + v), minus = scale * (v - u);
        add(s.n11, plus);
        add(s.n00, -plus);
        add(s.n10, minus);
        add(s.n01, -minus);
    }
    add_bending(at, out);
}

void Sheet::gradient(std::span<const Vec3> at, const SheetLoads& loads, std::vector<Vec3>& out) const noexcept {
    for (std::size_t n = 0; n < at.size(); ++n) out[n] = -(masses_[n] * loads.gravity + areas_[n] * loads.pressure);
    elastic_gradient(at, out);
    for (const Tether& t : loads.tethers) {
        const auto n = static_cast<std::size_t>(t.node);
        const Vec3 along = at[n] - t.to;
        const double length = glm::length(along);
        if (length > t.slack_length && length > 1e-12) out[n] += t.stiffness * (1.0 - t.slack_length / length) * along;
    }
    if (loads.obstacle)
        for (std::size_t n = 0; n < at.size(); ++n) {
            Vec3 normal;
            double depth = 0.0;
            contact_energy(at[n], *loads.obstacle, normal, depth);
            out[n] -= settings_.contact * depth * normal;
        }
}

void Sheet::linearise(std::span<const Vec3> at, const SheetLoads& loads, double inertia_scale) noexcept {
    const auto p = [&](int node) -> const Vec3& { return at[static_cast<std::size_t>(node)]; };
    for (std::size_t n = 0; n < at.size(); ++n) {
        node_hessians_[n] = Mat3(inertia_scale * masses_[n]);
        if (!loads.obstacle) continue;
        Vec3 normal;
        double depth = 0.0;
        contact_energy(at[n], *loads.obstacle, normal, depth);
        if (depth > 0.0) node_hessians_[n] += settings_.contact * glm::outerProduct(normal, normal);
    }
    for (const Tether& t : loads.tethers) {
        const Vec3 along = p(t.node) - t.to;
        if (glm::length(along) > t.slack_length)
            node_hessians_[static_cast<std::size_t>(t.node)] += spring_hessian(along, t.slack_length, t.stiffness);
    }
    auto& diagonals = inverse_diagonals_;
    diagonals = node_hessians_;
    const auto add = [&](int node, const Mat3& part) { diagonals[static_cast<std::size_t>(node)] += part; };
    for (std::size_t n = 0; n < stretches_.size(); ++n) {
        const Stretch& s = stretches_[n];
        stretch_hessians_[n] = spring_hessian(p(s.b) - p(s.a), s.length, s.stiffness);
        add(s.a, stretch_hessians_[n]);
        add(s.b, stretch_hessians_[n]);
    }
    for (std::size_t n = 0; n < shears_.size(); ++n) {
        const Shear& s = shears_[n];
        const Vec3 u = 0.5 * (p(s.n10) - p(s.n00) + p(s.n11) - p(s.n01)),
                   v = 0.5 * (p(s.n01) - p(s.n00) + p(s.n11) - p(s.n10));
        const double scale = 0.5 * std::sqrt(s.weight) / s.across;
        shear_u_[n] = scale * (u + v);  // gradient of the angle at n11; its negative at n00
        shear_v_[n] = scale * (v - u);  // at n10; its negative at n01
        const Mat3 plus = glm::outerProduct(shear_u_[n], shear_u_[n]),
                   minus = glm::outerProduct(shear_v_[n], shear_v_[n]);
        add(s.n11, plus);
        add(s.n00, plus);
        add(s.n10, minus);
        add(s.n01, minus);
    }
    for (const Bend& b : bends_) {
        add(b.a, Mat3(b.weight));
        add(b.b, Mat3(4.0 * b.weight));
        add(b.c, Mat3(b.weight));
    }
    for (const Twist4& t : twists_)
        for (const int node : {t.n00, t.n10, t.n01, t.n11}) add(node, Mat3(t.weight));
    for (Mat3& m : diagonals) m = glm::inverse(m);
}

void Sheet::multiply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const noexcept {
    const auto d = [&](int node) -> const Vec3& { return in[static_cast<std::size_t>(node)]; };
    const auto add = [&](int node, const Vec3& part) { out[static_cast<std::size_t>(node)] += part; };
    for (std::size_t n = 0; n < in.size(); ++n) out[n] = node_hessians_[n] * in[n];
    for (std::size_t n = 0; n < stretches_.size(); ++n) {
        const Stretch& s = stretches_[n];
        const Vec3 force = stretch_hessians_[n] * (d(s.b) - d(s.a));
        add(s.b, force);
        add(s.a, -force);
    }
    for (std::size_t n = 0; n < shears_.size(); ++n) {
        const Shear& s = shears_[n];
        const double angle = glm::dot(shear_u_[n], d(s.n11) - d(s.n00)) + glm::dot(shear_v_[n], d(s.n10) - d(s.n01));
        add(s.n11, angle * shear_u_[n]);
        add(s.n00, -angle * shear_u_[n]);
        add(s.n10, angle * shear_v_[n]);
        add(s.n01, -angle * shear_v_[n]);
    }
    add_bending(in, out);
    for (std::size_t n = 0; n < in.size(); ++n)
        if (held_[n]) out[n] = Vec3(0.0);
}

int Sheet::minimise(const SheetLoads& loads, double inertia_scale, int max_rounds) noexcept {
    const auto objective = [&](const std::vector<Vec3>& at) {
        double sum = energy(at, loads);
        for (std::size_t n = 0; n < at.size(); ++n) {
            const Vec3 moved = at[n] - predicted_[n];
            if (!held_[n]) sum += 0.5 * inertia_scale * masses_[n] * glm::dot(moved, moved);
        }
        return sum;
    };
    double now = objective(positions_);
    int round = 0;
    for (; round < max_rounds; ++round) {
        gradient(positions_, loads, gradient_);
        for (std::size_t n = 0; n < gradient_.size(); ++n)
            gradient_[n] =
                held_[n] ? Vec3(0.0) : gradient_[n] + inertia_scale * masses_[n] * (positions_[n] - predicted_[n]);
        linearise(positions_, loads, inertia_scale);
        // Conjugate gradients, preconditioned by the 3 × 3 blocks of the diagonal.
        std::ranges::fill(direction_, Vec3(0.0));
        for (std::size_t n = 0; n < residual_.size(); ++n) {
            residual_[n] = -gradient_[n];
            scaled_[n] = inverse_diagonals_[n] * residual_[n];
            search_[n] = scaled_[n];
        }
        double along = dot(residual_, scaled_);
        const double enough = relative_residual * relative_residual * along;
        const int max_iterations = 4 * (settings_.columns + settings_.rows) + 200;
        for (int k = 0; k < max_iterations && along > enough && along > 0.0; ++k) {
            multiply(search_, product_);
            const double curvature = dot(search_, product_);
            if (!(curvature > 0.0)) break;
            const double step = along / curvature;
            for (std::size_t n = 0; n < direction_.size(); ++n) {
                direction_[n] += step * search_[n];
                residual_[n] -= step * product_[n];
                scaled_[n] = inverse_diagonals_[n] * residual_[n];
            }
            const double next = dot(residual_, scaled_), ratio = next / along;
            for (std::size_t n = 0; n < search_.size(); ++n) search_[n] = scaled_[n] + ratio * search_[n];
            along = next;
        }
        const double slope = dot(gradient_, direction_);
        if (!(slope < 0.0)) break;
        double fraction = 1.0;
        bool is_lower = false;
        for (int halving = 0; halving < max_halvings && !is_lower; ++halving, fraction *= 0.5) {
            for (std::size_t n = 0; n < trial_.size(); ++n) trial_[n] = positions_[n] + fraction * direction_[n];
            const double then = objective(trial_);
            if (then <= now + 1e-4 * fraction * slope) {
                is_lower = true;
                positions_.swap(trial_);
                now = then;
                break;
            }
        }
        if (!is_lower) break;
        double motion = 0.0;
        for (const Vec3& d : direction_) motion = std::max(motion, glm::dot(d, d));
        if (fraction == 1.0 && motion < finest_motion * finest_motion) break;
    }
    return round;
}

int Sheet::step(double dt, const SheetLoads& loads) noexcept {
    const double keep = std::exp(-settings_.drag * dt);
    for (std::size_t n = 0; n < positions_.size(); ++n) {
        velocities_[n] *= keep;
        predicted_[n] = held_[n] ? positions_[n] : positions_[n] + dt * velocities_[n];
    }
    before_ = positions_;
    const int rounds = minimise(loads, 1.0 / (dt * dt), max_rounds_per_step);
    for (std::size_t n = 0; n < positions_.size(); ++n)
        velocities_[n] = held_[n] ? Vec3(0.0) : (positions_[n] - before_[n]) / dt;
    return rounds;
}

bool Sheet::settle(const SheetLoads& loads, double tolerance, int max_steps) noexcept {
    // Inertia without velocity regularises the first steps; it fades as the sheet comes to rest.
    double dt = 2e-3;
    for (int n = 0; n < max_steps; ++n) {
        predicted_ = positions_;
        before_ = positions_;
        minimise(loads, 1.0 / (dt * dt), max_rounds_per_step);
        double motion = 0.0;
        for (std::size_t k = 0; k < positions_.size(); ++k)
            motion = std::max(motion, glm::length(positions_[k] - before_[k]));
        std::ranges::fill(velocities_, Vec3(0.0));
        if (motion < tolerance && dt >= 1.0) return true;
        dt = std::min(10.0, dt * (motion < 2e-3 ? 2.0 : 1.1));
    }
    return false;
}

double Sheet::potential(const SheetLoads& loads) const noexcept { return energy(positions_, loads); }

double Sheet::kinetic() const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < velocities_.size(); ++n)
        sum += 0.5 * masses_[n] * glm::dot(velocities_[n], velocities_[n]);
    return sum;
}

double Sheet::tension(const Tether& t) const noexcept {
    return t.stiffness *
           std::max(0.0, glm::length(positions_[static_cast<std::size_t>(t.node)] - t.to) - t.slack_length);
}

double Sheet::area() const noexcept {
    double sum = 0.0;
    for (int row = 0; row + 1 < settings_.rows; ++row)
        for (int column = 0; column + 1 < settings_.columns; ++column) {
            const auto p = [&](int c, int r) { return positions_[static_cast<std::size_t>(index(c, r))]; };
            const Vec3 a = p(column, row), b = p(column + 1, row), c = p(column + 1, row + 1), d = p(column, row + 1);
            sum += 0.5 * (glm::length(glm::cross(b - a, c - a)) + glm::length(glm::cross(c - a, d - a)));
        }
    return sum;
}

}  // namespace tactus::skin
