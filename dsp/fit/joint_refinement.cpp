// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/joint_refinement.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/fit/adjoint.hpp"
#include "dsp/fit/fit_steps.hpp"
#include "dsp/geometry/dense_cholesky.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::fit {

namespace {

constexpr double max_step = 0.3e-3;  // m, of any face in one step
constexpr int narrowing_steps = 20;

/// The sum of the energies of all pairs, as one system over the bodies that may move.
class System {
public:
    System(const FragmentMatcher& matcher, std::span<const FacePair> pairs, std::span<const int> body,
           std::span<const char> fixed, std::span<Pose> poses)
        : matcher_(matcher), pairs_(pairs), body_(body), poses_(poses), unknown_(fixed.size(), -1) {
        for (std::size_t b = 0; b < fixed.size(); ++b)
            if (!fixed[b]) unknown_[b] = count_++;
        Vec3 sum(0.0);
        for (const auto& [m, f] : pairs) {
            energies_.emplace_back(matcher.face(m), matcher.face(f));
            set_law(energies_.back(), 0.0);
            energies_.back().law.kerf = matcher.settings.fit.kerf;
            sum += place_of(m);
        }
        if (!pairs.empty()) middle_ = sum / static_cast<double>(pairs.size());
    }

    std::size_t size() const { return 6 * static_cast<std::size_t>(count_); }

    template <class Set>
    void set(const Set& each) {
        for (FitEnergy& e : energies_) each(e);
    }
    void measure_noise(const FitSettings& settings) {
        for (std::size_t n = 0; n < pairs_.size(); ++n) fit::measure_noise(energies_[n], settings, centres(n));
    }
    /// Leaves nothing out any more of each pair that went astray since `before`. Returns whether there is one.
    bool hold_astray(const FitSettings& settings, const std::vector<Pose>& before) {
        const std::vector<Pose> now = poses();
        std::vector<Pose> was(pairs_.size());
        restore(before);
        for (std::size_t n = 0; n < pairs_.size(); ++n) was[n] = centres(n);
        restore(now);
        bool is_new = false;
        for (std::size_t n = 0; n < pairs_.size(); ++n) {
            if (!is_astray(energies_[n], settings, was[n], centres(n))) continue;
            energies_[n].law.chipped = 0.0;
            is_new = true;
        }
        return is_new;
    }
    void look() {
        for (std::size_t n = 0; n < pairs_.size(); ++n) energies_[n].look(centres(n));
    }
    /// Energy at the present poses, with the weights of the last look; fills gradient and stiffness when given.
    double energy(std::vector<double>* gradient = nullptr, std::vector<double>* stiffness = nullptr) {
        const std::size_t size = this->size();
        if (gradient) gradient->assign(size, 0.0);
        if (stiffness) stiffness->assign(size * size, 0.0);
        double all = 0.0;
        for (std::size_t n = 0; n < pairs_.size(); ++n) {
            const auto [m, f] = pairs_[n];
            const double area = std::min(matcher_.face(m).area, matcher_.face(f).area) * 1e4;
            const contact::ContactSum one =
                adjoint_transform(energies_[n](centres(n), contact::ContactParts::all),
                                  glm::mat3_cast(pose_of(f).orientation), place_of(m) - middle_, area);
            all += one.energy;
            if (!gradient) continue;
            const int a = unknown_of(m), b = unknown_of(f);
            add(*gradient, a, one.gradient, 1.0);
            add(*gradient, b, one.gradient, -1.0);
            add(*stiffness, a, a, one.stiffness, 1.0);
            add(*stiffness, b, b, one.stiffness, 1.0);
            add(*stiffness, a, b, one.stiffness, -1.0);
            add(*stiffness, b, a, one.stiffness, -1.0);
        }
        return all;
    }
    /// Moves each body by its twist about the middle, scaled so that no face moves too far. Returns the greatest motion
    /// of a face, m.
    double move(const std::vector<double>& twist) {
        double most = 0.0;
        for (const auto& [m, f] : pairs_)
            for (const std::size_t face : {m, f})
                if (const int u = unknown_of(face); u >= 0) {
                    const auto [v, w] = part_of(twist, u);
                    most = std::max(most, glm::length(v + glm::cross(w, place_of(face) - middle_)) +
                                              matcher_.face(face).gyration * glm::length(w));
                }
        const double scale = most > max_step ? max_step / most : 1.0;
        for (std::size_t n = 0; n < poses_.size(); ++n) {
            const int u = body_[n] < 0 ? -1 : unknown_[static_cast<std::size_t>(body_[n])];
            if (u < 0) continue;
            const auto [v, w] = part_of(twist, u);
            const Quat turn = rotation_by(scale * w);
            poses_[n].position = middle_ + scale * v + turn * (poses_[n].position - middle_);
            poses_[n].orientation = glm::normalize(turn * poses_[n].orientation);
        }
        return scale * most;
    }
    std::vector<Pose> poses() const { return {poses_.begin(), poses_.end()}; }
    void restore(const std::vector<Pose>& was) { std::ranges::copy(was, poses_.begin()); }

private:
    const Pose& pose_of(std::size_t face) const { return poses_[static_cast<std::size_t>(matcher_.fragment_of(face))]; }
    Vec3 place_of(std::size_t face) const { return pose_of(face).apply(matcher_.face(face).centre); }
    int unknown_of(std::size_t face) const {
        return unknown_[static_cast<std::size_t>(body_[static_cast<std::size_t>(matcher_.fragment_of(face))])];
    }
    Pose centres(std::size_t pair) const {
        const auto [m, f] = pairs_[pair];
        return between_centres(matcher_.face(m), matcher_.face(f), pose_of(f).inverse() * pose_of(m));
    }
    static std::pair<Vec3, Vec3> part_of(const std::vector<double>& twist, int unknown) {
        const double* x = twist.data() + 6 * unknown;
        return {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])};
    }
    static void add(std::vector<double>& gradient, int unknown, const geometry::Vector6& part, double sign) {
        if (unknown < 0) return;
        for (std::size_t i = 0; i < 6; ++i) gradient[6 * static_cast<std::size_t>(unknown) + i] += sign * part[i];
    }
    void add(std::vector<double>& stiffness, int row, int column, const geometry::Matrix6& part, double sign) const {
        if (row < 0 || column < 0) return;
        const std::size_t r = 6 * static_cast<std::size_t>(row), c = 6 * static_cast<std::size_t>(column);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) stiffness[(r + i) * size() + c + j] += sign * part[6 * i + j];
    }

    const FragmentMatcher& matcher_;
    std::span<const FacePair> pairs_;
    std::span<const int> body_;
    std::span<Pose> poses_;
    std::vector<int> unknown_;
    int count_ = 0;
    std::vector<FitEnergy> energies_;
    Vec3 middle_{0.0};
};

/// One damped step; keeps the poses when no step lowers the energy. Returns the greatest motion of a face, m.
double step(System& system) {
    std::vector<double> gradient, stiffness;
    system.look();
    const double before = system.energy(&gradient, &stiffness);
    const std::vector<Pose> was = system.poses();
    for (double damping = 1e-6; damping < 1.0; damping *= 100.0) {
        std::vector<double> matrix = stiffness, twist = gradient;
        for (std::size_t n = 0; n < gradient.size(); ++n) {
            matrix[n * gradient.size() + n] = stiffness[n * gradient.size() + n] * (1.0 + damping) + 1e-9;
            twist[n] = -twist[n];
        }
        if (!geometry::solve_positive(matrix, twist)) continue;
        const double moved = system.move(twist);
        if (system.energy() < before) return moved;
        system.restore(was);
    }
    return 0.0;
}

}  // namespace

std::vector<FacePair> mated_faces(const FragmentMatcher& matcher, std::span<const Pose> poses,
                                  std::span<const int> body) {
    std::vector<FacePair> pairs;
    if (matcher.faces() == 0) return pairs;
    const auto body_of = [&](std::size_t face) { return body[static_cast<std::size_t>(matcher.fragment_of(face))]; };
    const auto place = [&](std::size_t face) {
        return poses[static_cast<std::size_t>(matcher.fragment_of(face))].apply(matcher.face(face).centre);
    };
    FitEnergy energy = matcher.make_energy();
    for (std::size_t m = 0; m < matcher.faces(); ++m)
        for (std::size_t f = m + 1; f < matcher.faces(); ++f) {
            if (body_of(m) < 0 || body_of(f) < 0 || body_of(m) == body_of(f)) continue;
            if (glm::length(place(m) - place(f)) > matcher.face(m).gyration + matcher.face(f).gyration) continue;
            // Chains of fits have errors before they are refined: half of what a fit by itself must have.
            if (matcher.quality_of(energy, m, f, poses).score > 0.5 * Acceptance::min_score) pairs.emplace_back(m, f);
        }
    return pairs;
}

int refine_jointly(const FragmentMatcher& matcher, std::span<const FacePair> pairs, std::span<const int> body,
                   std::span<const char> fixed, std::span<Pose> poses) {
    System system(matcher, pairs, body, fixed, poses);
    if (system.size() == 0 || pairs.empty()) return 0;
    const FitSettings& fit = matcher.settings.fit;
    int steps = 0;
    for (int n = 0; n < narrowing_steps; ++n) {
        system.set([&](FitEnergy& e) { set_robust(e, fit, std::max(1.0, 3.0 - 0.25 * n)); });
        ++steps;
        if (step(system) < 1e-7 && n > 8) break;
    }
    for (int n = 1; n < first_intact_step; ++n, ++steps) {
        system.set([&](FitEnergy& e) { set_polish(e, fit, n); });
        step(system);
    }
    system.measure_noise(fit);
    const std::vector<Pose> polished = system.poses();
    const auto leave_out_chips = [&] {
        system.set([&](FitEnergy& e) { set_polish(e, fit, polish_steps); });
        for (int n = first_intact_step; n <= polish_steps; ++n, ++steps) step(system);
    };
    leave_out_chips();
    // Pairs without hold keep all their points; the chips of the others are still left out.
    while (system.hold_astray(fit, polished)) {
        system.restore(polished);
        leave_out_chips();
    }
    return steps;
}

}  // namespace tactus::fit
