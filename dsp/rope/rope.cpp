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

constexpr int most_rounds = 4;  // of the active set, per iteration
constexpr double least_damping = 1e-2;  // N/m

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
    : material_(material), settings_(settings), x_(std::move(points)), rest_(std::move(rest)), band_(x_.size()) {
    if (x_.size() < 3 || rest_.size() + 1 != x_.size())
        throw Error(fmt::format("a rope of {} points and {} rest lengths", x_.size(), rest_.size()));
    for (std::size_t n = 0; n < x_.size(); ++n)
        if (!is_finite(x_[n]) || (n > 0 && !(rest_[n - 1] > 1e-6 && rest_[n - 1] < 10.0)))
            throw Error(fmt::format("a rope's point {} or the rest length before it is no length", n));
    const bool is_material = material.stiffness > 0.0 && material.bending >= 0.0 && material.drag > 0.0 &&
                             material.radius >= 0.0 && material.friction >= 0.0 && std::isfinite(material.weight);
    const bool is_setting = settings.substeps > 0 && settings.most_iterations > 0 && settings.tolerance > 0.0 &&
                            settings.contact_stiffness > 0.0 && settings.stick_stiffness > 0.0;
    if (!is_material || !is_setting) throw Error("a rope's stiffness and drag must be positive, nothing negative");
    before_ = trial_ = move_ = rest_of_gradient_ = target_ = x_;
    resists_.assign(rest_.size(), 0);
    touching_.assign(x_.size(), 0);
    load_.assign(x_.size(), Vec3(0.0));
    normal_ = load_;
    depth_.assign(x_.size(), 0.0);
    held_.assign(x_.size(), false);
    stick_.assign(x_.size(), {});
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

/// Length of rope that belongs to a point.
double Rope::share(std::size_t point) const noexcept {
    const double before = point > 0 ? rest_[point - 1] : 0.0, after = point < rest_.size() ? rest_[point] : 0.0;
    return 0.5 * (before + after);
}

/// Bending energy of a point is weight · |bend|² / 2. At a clamp the rope continues as its mirror image, of which half
/// belongs to the rope.
double Rope::bend_weight(std::size_t point) const noexcept {
    const bool is_first = point == 0, is_last = point + 1 == x_.size();
    if (is_first || is_last) {
        const double l = is_first ? rest_.front() : rest_.back();
        return clamp_[is_first ? 0 : 1] ? 2.0 * material_.bending / (l * l * l) : 0.0;
    }
    const double l = share(point);
    return material_.bending / (l * l * l);
}

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

void Rope::look_at(const Obstacle* bone) noexcept {
    for (std::size_t n = 0; n < x_.size(); ++n)
        depth_[n] = bone && !held_[n] ? material_.radius - bone->distance(x_[n], normal_[n]) : 0.0;
}

double Rope::potential(double drag) const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < rest_.size(); ++n)
        sum += 0.5 * material_.stiffness / rest_[n] * square(std::max(0.0, glm::length(x_[n + 1] - x_[n]) - rest_[n]));
    for (std::size_t n = 0; n < x_.size(); ++n) {
        if (const double w = bend_weight(n); w > 0.0) {
            const Vec3 bend = bend_at(n);
            sum += 0.5 * w * glm::dot(bend, bend);
        }
        sum += material_.weight * share(n) * x_[n].z;
        if (held_[n]) continue;
        sum -= glm::dot(load_[n], x_[n]);
        if (depth_[n] > 0.0) sum += 0.5 * settings_.contact_stiffness * square(depth_[n]);
        if (stick_[n].limit > 0.0) {
            const double way = glm::length(slip(n)), free = stick_[n].limit / settings_.stick_stiffness;
            sum += way < free ? 0.5 * settings_.stick_stiffness * way * way : stick_[n].limit * (way - 0.5 * free);
        }
        if (drag > 0.0) {
            const Vec3 moved = x_[n] - before_[n];
            sum += 0.5 * drag * share(n) * glm::dot(moved, moved);
        }
    }
    return sum;
}

double Rope::energy() const noexcept { return potential(0.0); }

Vec3 Rope::pull_on(std::size_t point) const noexcept {
    Vec3 force(0.0, 0.0, -material_.weight * share(point));
    const auto along = [&](std::size_t from, std::size_t to, double tension_of) {
        const Vec3 d = x_[to] - x_[from];
        const double l = glm::length(d);
        if (l > 0.0) force += tension_of / l * d;
    };
    if (point > 0) along(point, point - 1, tension(point - 1));
    if (point + 1 < x_.size()) along(point, point + 1, tension(point));
    const std::size_t first = point > 0 ? point - 1 : 0, last = std::min(point + 1, x_.size() - 1);
    for (std::size_t n = first; n <= last; ++n) {
        const double w = bend_weight(n);
        if (!(w > 0.0)) continue;
        const bool is_end = n == 0 || n + 1 == x_.size();
        const double sign = n == point ? (is_end ? -1.0 : -2.0) : 1.0;
        // The first end's bend counts x₁ - x₀, the last one's the same towards the inside.
        force -= sign * w * bend_at(n);
    }
    return force;
}

/// The largest unbalanced force. Keeps the gradient of all but stretch and contact, which the model has by itself.
double Rope::gradient(double drag) noexcept {
    for (Vec3& g : rest_of_gradient_) g = Vec3(0.0);
    const std::size_t last = x_.size() - 1;
    for (std::size_t n = 0; n <= last; ++n) {
        if (const double w = bend_weight(n); w > 0.0) {
            const Vec3 g = w * bend_at(n);
            if (n == 0) rest_of_gradient_[0] -= g, rest_of_gradient_[1] += g;
            else if (n == last) rest_of_gradient_[last] -= g, rest_of_gradient_[last - 1] += g;
            else rest_of_gradient_[n - 1] += g, rest_of_gradient_[n] -= 2.0 * g, rest_of_gradient_[n + 1] += g;
        }
        Vec3& g = rest_of_gradient_[n];
        g += drag * share(n) * (x_[n] - before_[n]) - load_[n];
        g.z += material_.weight * share(n);
        if (stick_[n].limit > 0.0) {
            const Vec3 way = slip(n);
            const double length_of = glm::length(way), k = settings_.stick_stiffness;
            g += (k * length_of < stick_[n].limit ? k : stick_[n].limit / length_of) * way;
        }
    }
    double largest = 0.0;
    Vec3 before(0.0);
    for (std::size_t n = 0; n <= last; ++n) {
        Vec3 after(0.0);
        if (n < last) {
            const Vec3 d = x_[n + 1] - x_[n];
            const double l = glm::length(d), over = l - rest_[n];
            if (over > 0.0) after = material_.stiffness / rest_[n] * over / l * d;
        }
        Vec3 g = rest_of_gradient_[n] + before - after;
        if (depth_[n] > 0.0) g -= settings_.contact_stiffness * depth_[n] * normal_[n];
        if (!held_[n]) largest = std::max(largest, glm::length(g));
        before = after;
    }
    return largest;
}

/// The quadratic model at the present points: its matrix, and the right side in move_. Flagged segments resist, flagged
/// points touch, whether they do so now or not.
void Rope::assemble(double drag, double damping) noexcept {
    band_.clear();
    for (std::size_t n = 0; n < x_.size(); ++n) move_[n] = held_[n] ? Vec3(0.0) : -rest_of_gradient_[n];
    for (std::size_t n = 0; n < rest_.size(); ++n) {
        if (!resists_[n]) continue;
        const Vec3 d = x_[n + 1] - x_[n];
        const double l = glm::length(d), over = l - rest_[n], k = material_.stiffness / rest_[n];
        const Vec3 u = d / l;
        Mat3 block = k * glm::outerProduct(u, u);
        if (over > 0.0) block += k * over / l * (Mat3(1.0) - glm::outerProduct(u, u));
        band_.add(n, n, block);
        band_.add(n + 1, n + 1, block);
        block *= -1.0;
        band_.add(n + 1, n, block);
        move_[n] += k * over * u;
        move_[n + 1] -= k * over * u;
    }
    const std::size_t last = x_.size() - 1;
    for (std::size_t n = 0; n <= last; ++n) {
        const double w = bend_weight(n);
        if (w > 0.0 && (n == 0 || n == last)) {
            const std::size_t inner = n == 0 ? 1 : last - 1;
            band_.add(n, n, w);
            band_.add(inner, inner, w);
            band_.add(std::max(n, inner), std::min(n, inner), -w);
        } else if (w > 0.0) {
            band_.add(n - 1, n - 1, w);
            band_.add(n, n, 4.0 * w);
            band_.add(n + 1, n + 1, w);
            band_.add(n, n - 1, -2.0 * w);
            band_.add(n + 1, n, -2.0 * w);
            band_.add(n + 1, n - 1, w);
        }
        band_.add(n, n, drag * share(n) + damping);
        if (held_[n]) continue;
        if (touching_[n]) {
            band_.add(n, n, settings_.contact_stiffness * glm::outerProduct(normal_[n], normal_[n]));
            move_[n] += settings_.contact_stiffness * depth_[n] * normal_[n];
        }
        if (const Stick& s = stick_[n]; s.limit > 0.0) {
            const Mat3 tangent = Mat3(1.0) - glm::outerProduct(s.normal, s.normal);
            const Vec3 way = slip(n);
            const double length_of = glm::length(way), k = settings_.stick_stiffness;
            if (k * length_of < s.limit) band_.add(n, n, k * tangent);
            else
                band_.add(n, n,
                          s.limit / length_of * (tangent - glm::outerProduct(way, way) / (length_of * length_of)));
        }
    }
    for (std::size_t n = 0; n <= last; ++n)
        if (held_[n]) {
            band_.fix(n);
            move_[n] = Vec3(0.0);
        }
}

/// The step to the minimum of the model. Its active set is what resists and touches at that minimum.
bool Rope::find_move(double drag, double damping) noexcept {
    for (std::size_t n = 0; n < rest_.size(); ++n) resists_[n] = glm::length(x_[n + 1] - x_[n]) > rest_[n];
    for (std::size_t n = 0; n < x_.size(); ++n) touching_[n] = depth_[n] > 0.0;
    for (int round = 0; round < most_rounds; ++round) {
        assemble(drag, damping);
        if (!band_.solve(move_)) return false;
        bool is_same = true;
        for (std::size_t n = 0; n < rest_.size(); ++n) {
            const Vec3 d = x_[n + 1] - x_[n];
            const double l = glm::length(d);
            const bool will = l > 0.0 && l - rest_[n] + glm::dot(d, move_[n + 1] - move_[n]) / l > 0.0;
            is_same = is_same && will == (resists_[n] != 0);
            resists_[n] = will;
        }
        for (std::size_t n = 0; n < x_.size(); ++n) {
            if (held_[n] || normal_[n] == Vec3(0.0)) continue;
            const bool will = depth_[n] - glm::dot(normal_[n], move_[n]) > 0.0;
            is_same = is_same && will == (touching_[n] != 0);
            touching_[n] = will;
        }
        if (is_same) break;
    }
    return true;
}

bool Rope::substep(double h, const Obstacle* bone, RopeStep& report) noexcept {
    const double drag = material_.drag / h;
    look_at(bone);
    double now = potential(drag), damping = 0.0;
    for (int iteration = 0;; ++iteration) {
        const double residual = gradient(drag);
        if (residual <= settings_.tolerance || iteration == settings_.most_iterations) {
            report.residual = std::max(report.residual, residual);
            return residual <= settings_.tolerance;
        }
        ++report.iterations;
        bool is_less = false;
        if (find_move(drag, damping)) {
            // A point moves by at most two segments.
            double scale = 1.0;
            for (std::size_t n = 0; n < x_.size(); ++n)
                scale = std::min(scale, 2.0 * share(n) / std::max(glm::length(move_[n]), 1e-12));
            trial_ = x_;
            for (int halving = 0; halving < 6 && !is_less; ++halving, scale *= 0.5) {
                for (std::size_t n = 0; n < x_.size(); ++n) x_[n] = trial_[n] + scale * move_[n];
                look_at(bone);
                const double then = potential(drag);
                // Near the minimum the decrease is below rounding.
                is_less = then <= now + 1e-14 * (std::abs(now) + 1e-6);
                if (is_less) now = then;
            }
            if (!is_less) {
                x_ = trial_;
                look_at(bone);
            }
        }
        damping = is_less ? 0.1 * damping : std::max(10.0 * damping, least_damping);
        if (damping < least_damping) damping = 0.0;
    }
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
    report.is_solved = true;
    const int substeps = settings_.substeps;
    for (int n = 0; n < substeps; ++n) {
        before_ = x_;
        report.lag = 0.0;
        for (std::size_t p = 0; p < x_.size(); ++p) {
            if (!held_[p]) continue;
            const Vec3 way = target_[p] - x_[p];
            const double length_of = glm::length(way), most = 0.5 * std::min(2.0 * share(p), rest_[p ? p - 1 : 0]);
            const double part = std::min(1.0 / (substeps - n), length_of > 0.0 ? most / length_of : 1.0);
            x_[p] = part >= 1.0 ? target_[p] : x_[p] + part * way;
            report.lag = std::max(report.lag, (1.0 - part) * length_of);
        }
        begin_friction();
        report.is_solved = substep(h / substeps, bone, report) && report.is_solved;
        end_friction();
    }
    for (const double depth : depth_) report.contacts += depth > 0.0;
    return report;
}

}  // namespace tactus::rope
