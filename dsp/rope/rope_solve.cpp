// SPDX-License-Identifier: Apache-2.0
// The solver of a rope's substep: Newton's method with an active set.
#include "dsp/rope/rope.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::rope {

namespace {

constexpr int many_rounds = 4;  // of the active set, per iteration
constexpr int few_halvings = 4, many_halvings = 10;  // of a step
constexpr int max_failures = 2;  // searches for a lower sum that fail in contact, one after the other
constexpr double min_damping = 1e-2;  // N/m
constexpr double damping_in_contact = 1.0 / 400.0;  // of the stiffness of contact, at first

}  // namespace

/// The largest unbalanced force. Keeps the gradient of all but stretch and contact, which the model has by itself.
double Rope::gradient(double drag) noexcept {
    for (Vec3& g : rest_of_gradient_) g = Vec3(0.0);
    const std::size_t last = x_.size() - 1;
    for (std::size_t n = 0; n <= last; ++n) {
        if (const double w = bend_[n]; w > 0.0) {
            const Vec3 g = w * bend_at(n);
            if (n == 0) rest_of_gradient_[0] -= g, rest_of_gradient_[1] += g;
            else if (n == last) rest_of_gradient_[last] -= g, rest_of_gradient_[last - 1] += g;
            else rest_of_gradient_[n - 1] += g, rest_of_gradient_[n] -= 2.0 * g, rest_of_gradient_[n + 1] += g;
        }
        Vec3& g = rest_of_gradient_[n];
        g += drag * share_[n] * (x_[n] - before_[n]) - load_[n];
        g.z += material_.weight * share_[n];
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
            const double l = length_[n], over = l - rest_[n];
            if (over > 0.0) after = material_.stiffness / rest_[n] * over / l * (x_[n + 1] - x_[n]);
        }
        Vec3 g = rest_of_gradient_[n] + before - after;
        if (depth_[n] > 0.0) g -= settings_.contact_stiffness * depth_[n] * normal_[n];
        // A force that is not a number is no small one.
        if (const double size = glm::length(g); !held_[n] && !std::isnan(largest) && !(size <= largest)) largest = size;
        before = after;
    }
    return largest;
}

/// What the matrix of a substep always holds: bending and drag.
void Rope::assemble_base(double drag) noexcept {
    base_.clear();
    const std::size_t last = x_.size() - 1;
    for (std::size_t n = 0; n <= last; ++n) {
        const double w = bend_[n];
        if (w > 0.0 && (n == 0 || n == last)) {
            const std::size_t inner = n == 0 ? 1 : last - 1;
            base_.add(n, n, w);
            base_.add(inner, inner, w);
            base_.add(std::max(n, inner), std::min(n, inner), -w);
        } else if (w > 0.0) {
            base_.add(n - 1, n - 1, w);
            base_.add(n, n, 4.0 * w);
            base_.add(n + 1, n + 1, w);
            base_.add(n, n - 1, -2.0 * w);
            base_.add(n + 1, n, -2.0 * w);
            base_.add(n + 1, n - 1, w);
        }
        base_.add(n, n, drag * share_[n]);
    }
}

/// The quadratic model at the present points: its matrix, and the right side in move_. Flagged segments resist, flagged
/// points touch, whether they do so now or not.
void Rope::assemble(double damping, bool with_curves) noexcept {
    band_.copy(base_);
    for (std::size_t n = 0; n < x_.size(); ++n) move_[n] = -rest_of_gradient_[n];
    for (std::size_t n = 0; n < rest_.size(); ++n) {
        if (!resists_[n]) continue;
        const Vec3 d = x_[n + 1] - x_[n];
        const double l = length_[n], over = l - rest_[n], k = material_.stiffness / rest_[n];
        const Vec3 u = d / l;
        // k u uᵀ + k over / l (1 - u uᵀ)
        const double across = over > 0.0 ? k * over / l : 0.0;
        Mat3 block = glm::outerProduct((k - across) * u, u);
        for (int a = 0; a < 3; ++a) block[a][a] += across;
        band_.add(n, n, block);
        band_.add(n + 1, n + 1, block);
        band_.add(n + 1, n, -block);
        move_[n] += k * over * u;
        move_[n + 1] -= k * over * u;
    }
    const double hard = settings_.contact_stiffness;
    for (std::size_t n = 0; n < x_.size(); ++n) {
        if (damping > 0.0) band_.add(n, n, damping);
        if (held_[n]) continue;
        if (touching_[n]) {
            band_.add(n, n, glm::outerProduct(hard * normal_[n], normal_[n]));
            if (with_curves && depth_[n] > 0.0 && curve_[n].bend != 0.0)
                band_.add(n, n,
                          glm::outerProduct(-hard * depth_[n] * curve_[n].bend * curve_[n].along, curve_[n].along));
            move_[n] += hard * depth_[n] * normal_[n];
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
    for (std::size_t n = 0; n < x_.size(); ++n)
        if (held_[n]) {
            band_.fix(n);
            move_[n] = Vec3(0.0);
        }
}

/// The step to the minimum of the model. Its active set is what resists and touches at that minimum. Gives the rounds
/// that it took; 0: there is no such step.
int Rope::find_move(double damping, int max_rounds) noexcept {
    for (std::size_t n = 0; n < rest_.size(); ++n) resists_[n] = length_[n] > rest_[n];
    for (std::size_t n = 0; n < x_.size(); ++n) touching_[n] = depth_[n] > 0.0;
    for (int round = 1;; ++round) {
        assemble(damping, true);
        if (!band_.solve(move_)) {
            assemble(damping, false);
            if (!band_.solve(move_)) return 0;
        }
        bool is_same = true;
        for (std::size_t n = 0; n < rest_.size(); ++n) {
            const Vec3 d = x_[n + 1] - x_[n];
            const double l = length_[n];
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
        if (is_same || round == max_rounds) return round;
    }
}

/// How the surface bends along the way of each point that touches it.
void Rope::learn_curves() noexcept {
    for (std::size_t n = 0; n < x_.size(); ++n) {
        if (!(depth_[n] > 0.0)) {
            curve_[n].bend = 0.0;
            continue;
        }
        if (normal_before_[n] == Vec3(0.0)) continue;
        const Vec3 way = x_[n] - trial_[n], along = way - glm::dot(way, normal_[n]) * normal_[n];
        const double length_of = glm::length(along);
        if (!(length_of > 1e-8)) continue;
        const double bend = glm::dot(normal_[n] - normal_before_[n], along) / (length_of * length_of);
        curve_[n] = {along / length_of, std::clamp(bend, -1e3, 1e3)};
    }
}

/// Goes along the move, or a part of it, when the sum gets less.
bool Rope::go(bool has_move, int max_halvings, double drag, const Obstacle* bone, double& now) noexcept {
    if (!has_move) return false;
    // A point moves by at most two segments.
    double scale = 1.0;
    for (std::size_t n = 0; n < x_.size(); ++n)
        scale = std::min(scale, 2.0 * share_[n] / std::max(glm::length(move_[n]), 1e-12));
    trial_ = x_;
    normal_before_ = normal_;
    for (int halving = 0; halving < max_halvings; ++halving, scale *= 0.5) {
        for (std::size_t n = 0; n < x_.size(); ++n) x_[n] = trial_[n] + scale * move_[n];
        look_at(bone, false);
        const double then = potential(drag);
        // Near the minimum the decrease is below rounding.
        if (then <= now + 1e-14 * (std::abs(now) + 1e-6)) {
            now = then;
            return true;
        }
    }
    x_ = trial_;
    look_at(bone, false);
    return false;
}

/// At an edge of bone, where the sum has a kink, the smallest sum is no point without force: where no step makes it less
/// the substep ends.
bool Rope::substep(double h, const Obstacle* bone, int max_iterations, RopeStep& report) noexcept {
    const double drag = material_.drag / h;
    assemble_base(drag);
    double now = potential(drag), damping = 0.0;
    int failures = 0;
    for (int iteration = 0;; ++iteration) {
        const double residual = gradient(drag);
        if (residual <= settings_.tolerance || iteration >= max_iterations || failures == max_failures) {
            if (!(residual <= report.residual)) report.residual = residual;
            return residual <= settings_.tolerance;
        }
        ++report.iterations;
        // Where the active set does not settle, its move may lead uphill. That of the present one never does.
        const int rounds = find_move(damping, many_rounds);
        bool is_less = go(rounds > 0, rounds == 1 ? many_halvings : few_halvings, drag, bone, now);
        if (!is_less && rounds > 1) is_less = go(find_move(damping, 1) > 0, many_halvings, drag, bone, now);
        if (is_less) {
            learn_curves();
            failures = 0;
            damping = damping > 10.0 * min_damping ? 0.1 * damping : 0.0;
        } else {
            const bool touches = std::ranges::any_of(depth_, [](double depth) { return depth > 0.0; });
            failures += touches;
            damping =
                std::max(10.0 * damping, touches ? damping_in_contact * settings_.contact_stiffness : min_damping);
        }
    }
}

}  // namespace tactus::rope
