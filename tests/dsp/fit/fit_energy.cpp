// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit_energy.hpp"

#include "dsp/fit/fit.hpp"
#include "dsp/fit/held_fit.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

using namespace tactus;
using namespace tactus::test;

namespace {

Pose nudged(const Pose& pose, std::size_t axis, double by) {
    Vec3 way(0.0), turn(0.0);
    (axis < 3 ? way : turn)[static_cast<int>(axis % 3)] = by;
    return {pose.position + way, glm::normalize(rotation_by(turn) * pose.orientation)};
}

}  // namespace

TEST_CASE("dsp: the gradient of the fit is the slope of its energy, in every mode") {
    const Half a = bar_half(-1.0, rough_relief(3)), b = bar_half(1.0, rough_relief(3));
    const fit::FitSurface moving = a.surface(), fixed = b.surface();
    fit::FitEnergy energy(moving, fixed);
    for (const auto& [is_robust, kerf] : {std::pair(true, 0.0), std::pair(true, 0.7 * mm), std::pair(false, 0.0)}) {
        energy.law = {};
        energy.law.kerf = kerf;
        energy.law.kernel = is_robust ? fit::FitKernel::robust : fit::FitKernel::steady;
        energy.law.scale = 1.0 * mm;
        energy.law.outline = is_robust ? 0.3 : 0.0;
        energy.law.two_sided = is_robust;
        energy.law.strength = is_robust ? 10e3 : 30.0;
        energy.law.contact = is_robust ? 0.0 : 10e3;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Pose pose = beside(0.8 * mm, 0.05, seed);
            energy.look(pose);
            const contact::ContactSum at = energy(pose, contact::ContactParts::all);
            for (std::size_t axis = 0; axis < 6; ++axis) {
                // Small enough that hardly any point changes its cell, where the slope steps.
                const double step = axis < 3 ? 1e-8 : 1e-6;
                const double slope = (energy(nudged(pose, axis, step), contact::ContactParts::all).energy -
                                      energy(nudged(pose, axis, -step), contact::ContactParts::all).energy) /
                                     (2.0 * step);
                const double scale = axis < 3 ? energy.law.strength * (is_robust ? 1e-3 : 1.0)
                                              : energy.law.strength * (is_robust ? 1e-5 : 1e-2);
                INFO("robust " << is_robust << ", seed " << seed << ", axis " << axis);
                CHECK(at.gradient[axis] == Approx(slope).epsilon(5e-3).margin(5e-3 * scale));
            }
        }
    }
}

TEST_CASE("dsp: the stiffness of the fit is symmetric and never negative") {
    const Half a = bar_half(-1.0, rough_relief(3)), b = bar_half(1.0, rough_relief(3));
    const fit::FitSurface moving = a.surface(), fixed = b.surface();
    fit::FitEnergy energy(moving, fixed);
    energy.law.outline = 0.3;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Pose pose = beside(2 * mm, 0.1, seed);
        energy.look(pose);
        const contact::ContactSum sum = energy(pose, contact::ContactParts::all);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) CHECK(sum.stiffness[6 * i + j] == sum.stiffness[6 * j + i]);
        const geometry::SymmetricEigen<6> eigen = geometry::symmetric_eigen<6>(sum.stiffness);
        CHECK(eigen.value[0] > -1e-9 * eigen.value[5]);
    }
}

TEST_CASE("dsp: looking and evaluating take no memory") {
    const Half a = bar_half(-1.0, rough_relief(3)), b = bar_half(1.0, rough_relief(3));
    const fit::FitSurface moving = a.surface(), fixed = b.surface();
    fit::FitEnergy energy(moving, fixed);
    energy.law.outline = 0.3;
    contact::ContactSum sum;
    const RealtimeViolations seen = watch([&] {
        energy.look(Pose{});
        sum = energy(Pose{}, contact::ContactParts::all);
        energy.law.kernel = fit::FitKernel::intact;
        energy.law.scale = 0.1 * mm;
        energy.law.kerf = 0.5 * mm;
        energy.look(Pose{});
        energy.quality(Pose{}, 0.2 * mm);
    });
    CHECK(seen.allocations == 0);
    CHECK(seen.releases == 0);
    CHECK(sum.evaluated > 100);
}

TEST_CASE("dsp: quality tells a fit from the same paint a little beside it") {
    const Half a = bar_half(-1.0, rough_relief(3)), b = bar_half(1.0, rough_relief(3));
    const fit::FitSurface moving = a.surface(), fixed = b.surface();
    fit::FitEnergy energy(moving, fixed);
    const Pose truth{moving.centre - fixed.centre, {1.0, 0.0, 0.0, 0.0}};
    const Pose beside_it{truth.position + Vec3(0.0, 1.0 * mm, 0.0), truth.orientation};
    const fit::FitQuality good = energy.quality(truth, 0.2 * mm), bad = energy.quality(beside_it, 0.2 * mm);
    CHECK(good.score > 0.85);
    CHECK(good.rms < 0.08 * mm);
    CHECK(good.penetration < 0.2 * mm);
    CHECK(good.overlap > 0.8 * moving.area);
    CHECK(bad.score < 0.6 * good.score);
    CHECK(bad.penetration > 0.3 * mm);
}

TEST_CASE("dsp: both halves of a look give the same sum, and the held fit carries it to the handle") {
    const Half a = bar_half(-1.0, rough_relief(3)), b = bar_half(1.0, rough_relief(3));
    const fit::FitSurface moving = a.surface(), fixed = b.surface();
    fit::FitEnergy energy(moving, fixed);
    energy.law.outline = 0.3;
    const Pose pose = beside(0.8 * mm, 0.05, 2);
    energy.look(pose);
    const contact::ContactSum fresh = energy(pose, contact::ContactParts::all);
    const contact::ContactSum halves[] = {energy.look_at_half(fit::FitHalf::moving_points, pose),
                                          energy.look_at_half(fit::FitHalf::fixed_points, pose)};
    CHECK(fresh.energy == Approx(halves[0].energy + halves[1].energy));
    for (std::size_t i = 0; i < 36; ++i)
        CHECK(fresh.stiffness[i] == Approx(halves[0].stiffness[i] + halves[1].stiffness[i]).margin(1e-6));
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(fresh.gradient[i] == Approx(halves[0].gradient[i] + halves[1].gradient[i]).margin(1e-9));

    // The fixed half stands askew in the world, the handle is 40 mm from the moving one.
    coupling::HeldContact nothing(64);
    fit::HeldFit fit(nothing, &energy);
    const Pose stands{Vec3(0.1, 0.2, -0.1), rotation_by({0.4, -1.0, 0.3})};
    const Pose grip{Vec3(0.0, 30.0, -25.0) * mm, rotation_by({0.2, 0.1, -0.5})};
    const Pose handle = stands * fit::between_bodies(moving, fixed, pose) * grip.inverse();
    fit.look(handle, grip, stands, 1.0);
    const auto energy_at = [&](const Pose& where) {
        return energy(fit::between_centres(moving, fixed, stands.inverse() * where * grip), contact::ContactParts::all)
            .energy;
    };
    const contact::ContactSum there = fit(handle, contact::ContactParts::all);
    CHECK(fit.energy() == Approx(there.energy));
    for (std::size_t axis = 0; axis < 6; ++axis) {
        const double step = axis < 3 ? 1e-7 : 1e-6;
        const double slope =
            (energy_at(nudged(handle, axis, step)) - energy_at(nudged(handle, axis, -step))) / (2.0 * step);
        CHECK(there.gradient[axis] == Approx(slope).epsilon(0.02).margin(axis < 3 ? 0.05 : 0.002));
        const contact::ContactSum at = fit(nudged(handle, axis, step), contact::ContactParts::all);
        CHECK((at.energy - there.energy) / step == Approx(there.gradient[axis]).epsilon(1e-2).margin(1e-2));
    }
}
