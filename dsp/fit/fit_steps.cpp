// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit_steps.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::fit {

namespace {

constexpr double max_noise = 0.5;  // of the finest robust scale
constexpr double min_scale = 2.0;  // standard deviations of the scans' noise
// Share of the weight: where less is off the other bone, it is noise and the rim of the paint (2 to 8 % without chips).
constexpr double min_chipped = 0.1;

/// m, of the kernel of what is not chipped.
double intact_scale(const FitEnergy& energy, const FitSettings& settings) noexcept {
    return std::max(settings.intact, min_scale * energy.law.noise);
}

/// One step of the solver from its pose, with the weights of that pose. Returns the length of the step, m.
double step_once(FitEnergy& energy, coupling::QuasiStaticCoupling& solver, int& iterations) noexcept {
    const Pose before = solver.state().proxy;
    energy.look(before);
    iterations += solver.update(before, energy).iterations;
    return pose_distance(before, solver.state().proxy, energy.moving().gyration);
}

}  // namespace

coupling::QuasiStaticSettings free_solver(double gyration) noexcept {
    coupling::QuasiStaticSettings s;
    s.springs = {{0.0, 1.0}, {0.0, 1.0}};
    s.iterations = 1;
    s.tolerance = 1e-7;
    s.reach = s.gyration = gyration;
    return s;
}

void set_law(FitEnergy& energy, double outline, std::size_t points) noexcept {
    const double kerf = energy.law.kerf;
    energy.law = {};
    energy.law.kerf = kerf;
    energy.law.reach = 1.0;
    energy.law.outline = outline;
    const std::size_t all = std::min(energy.moving().position.size(), energy.fixed().position.size());
    energy.law.stride = points > 0 ? std::max<std::size_t>(1, all / points) : 1;
}

Pose anneal(FitEnergy& energy, const Pose& start, const Narrowing& narrowing, int& iterations) noexcept {
    coupling::QuasiStaticCoupling solver;
    solver.settings = free_solver(energy.moving().gyration);
    solver.reset(start);
    for (int stage = 0; stage < narrowing.stages; ++stage) {
        const double progress = narrowing.stages > 1 ? static_cast<double>(stage) / (narrowing.stages - 1) : 1.0;
        energy.law.scale = narrowing.widest * std::pow(narrowing.finest / narrowing.widest, progress);
        energy.law.power = 1.0 + (narrowing.power - 1.0) * progress;
        solver.settings.step = std::max(energy.law.scale, 0.3e-3);
        step_once(energy, solver, iterations);
    }
    return solver.state().proxy;
}

void set_robust(FitEnergy& energy, const FitSettings& settings, double wider) noexcept {
    energy.law.kernel = FitKernel::robust;
    energy.law.scale = wider * settings.finest;
    energy.law.power = settings.power;
}

void set_polish(FitEnergy& energy, const FitSettings& settings, int step) noexcept {
    const bool is_last = step >= first_intact_step;
    if (is_last && energy.law.chipped >= min_chipped) {
        energy.law.kernel = FitKernel::intact;
        energy.law.scale = intact_scale(energy, settings);
        return;
    }
    const double progress = std::min(1.0, static_cast<double>(step) / 5.0);
    const double polish = is_last ? std::max(settings.polish, min_scale * energy.law.noise) : settings.polish;
    energy.law.kernel = FitKernel::robust;
    energy.law.scale = settings.finest * std::pow(std::min(1.0, polish / settings.finest), progress);
    energy.law.power = settings.power + progress * std::max(0.0, settings.polish_power - settings.power);
}

void measure_noise(FitEnergy& energy, const FitSettings& settings, const Pose& pose) noexcept {
    energy.look(pose);
    energy.law.noise = energy.noise();
    // No scan that is worth a fit is that noisy: half of the points are chipped.
    if (energy.law.noise > max_noise * settings.finest) energy.law.noise = 0.0;
    energy.law.chipped = energy.share_beyond(intact_scale(energy, settings));
}

bool is_astray(const FitEnergy& energy, const FitSettings& settings, const Pose& before, const Pose& after) noexcept {
    return energy.law.kernel == FitKernel::intact && pose_distance(before, after, energy.moving().gyration) >
                                                         std::max(settings.finest, intact_scale(energy, settings));
}

Pose refine(FitEnergy& energy, const Pose& start, const FitSettings& settings, int& iterations) noexcept {
    coupling::QuasiStaticCoupling solver;
    solver.settings = free_solver(energy.moving().gyration);
    solver.settings.step = 0.3e-3;
    solver.reset(start);
    set_robust(energy, settings, 1.0);
    for (int n = 0; n < 30; ++n) {
        const int before = iterations;
        if (step_once(energy, solver, iterations) < 1e-7 || iterations == before) break;
    }
    Pose polished;
    for (int n = 1; n <= polish_steps; ++n) {
        if (n == first_intact_step) measure_noise(energy, settings, polished = solver.state().proxy);
        set_polish(energy, settings, n);
        step_once(energy, solver, iterations);
    }
    return is_astray(energy, settings, polished, solver.state().proxy) ? polished : solver.state().proxy;
}

Quat shortest_turn(const Vec3& from, const Vec3& to) noexcept {
    const Vec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis), cosine = glm::dot(from, to);
    if (sine < 1e-9) {
        if (cosine > 0.0) return {1.0, 0.0, 0.0, 0.0};
        const Vec3 other = std::abs(from.x) < 0.5 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
        return glm::angleAxis(std::numbers::pi, glm::normalize(glm::cross(from, other)));
    }
    return glm::angleAxis(std::atan2(sine, cosine), axis / sine);
}

Vec3 direction_of(const Vec3& normal) noexcept {
    const double length = glm::length(normal);
    return length > 1e-6 ? normal / length : Vec3(0.0, 0.0, 1.0);
}

Quat opposed(const FitSurface& moving, const FitSurface& fixed, const Quat& from) noexcept {
    return shortest_turn(from * direction_of(moving.mean_normal), -direction_of(fixed.mean_normal)) * from;
}

double pose_distance(const Pose& a, const Pose& b, double gyration) noexcept {
    return glm::length(a.position - b.position) +
           gyration * glm::length(rotation_between(a.orientation, b.orientation));
}

}  // namespace tactus::fit
