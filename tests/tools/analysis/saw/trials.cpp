// SPDX-License-Identifier: Apache-2.0
// What `tactus bench saw` shows in full, in short.
#include "assets/library/mandible.hpp"
#include "tests/support/catch.hpp"
#include "tools/analysis/saw/device_trial.hpp"
#include "tools/analysis/saw/grid_study.hpp"
#include "tools/analysis/saw/solid_sweep.hpp"

using namespace tactus;

TEST_CASE("a saw removes as much per thrust on a weak device as on a strong one, within 5 %", "[slow]") {
    double ideal = 0.0;
    for (analysis::DeviceTrial trial : analysis::device_trials()) {
        trial.settle = trial.seconds = 2.0;
        const analysis::DeviceTrialResult found = analysis::run_device_trial(trial);
        if (ideal == 0.0) ideal = found.per_thrust;
        CAPTURE(trial.model, found.thrust, found.rubbing, found.removal, found.per_thrust);
        CHECK(found.thrust >= 2.0 * found.rubbing);
        CHECK(found.limited == 0.0);
        CHECK(found.per_thrust > 0.0);
        CHECK(found.per_thrust == Approx(ideal).epsilon(0.05));
    }
}

TEST_CASE("how much a saw removes does not depend on the voxels of the bone, within 5 %", "[slow]") {
    constexpr double voxels[] = {0.3e-3, 1e-3};
    const auto rows = analysis::run_grid_study(voxels);
    CAPTURE(rows[0].removed, rows[1].removed);
    CHECK(rows[0].removed > 5e-9);
    CHECK(rows[1].removed == Approx(rows[0].removed).epsilon(0.05));
}

TEST_CASE("no part of a saw or a burr sinks into the jaw of the library without force", "[slow]") {
    const bone::Bone jaw = library::make_mandible();
    for (const auto tool : {analysis::SolidTool::blade, analysis::SolidTool::sagittal, analysis::SolidTool::burr}) {
        const analysis::SolidSweepResult found = analysis::run_solid_sweep(tool, jaw, 8);
        CAPTURE(static_cast<int>(tool), found.greatest_silent, found.greatest_step);
        CHECK(found.poses == 8);
        CHECK(found.pressed > 50);
        CHECK(found.silent == 0);
        CHECK(found.active == 0);
        CHECK(found.held == 0);
    }
}
