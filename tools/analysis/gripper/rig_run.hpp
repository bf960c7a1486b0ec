// SPDX-License-Identifier: Apache-2.0
// Runs and evaluates one cell of the test matrix: a patch with a gripper, an object and the test rig, on a virtual
// clock.
#pragma once

#include "dsp/control/fidelity.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/analysis/rig_matrix.hpp"
#include "tools/run/patch_choice.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct RigCell {
    std::string motor;
    RigObject object;
    double rate = 1.0;        ///< Hz
    double amplitude = 0.025; ///< m, amplitude of the cord
    std::optional<double> feed_forward;  ///< empty: as in the patch
    std::vector<std::string> settings;   ///< further overrides, "devices.wqsm.lag=1 ms"
};

struct RigRow {
    RigCell cell;
    control::Fidelity fidelity;
    std::string failure;  ///< reason of a failure; empty: success
};

/// Names of the nodes that a rig study needs.
struct RigNodes {
    std::string input, controller, output, rig;
};

/// Throws Error unless the patch has exactly one node of each type.
RigNodes find_rig_nodes(const run::PatchChoice& choice);

/// Settling time before the evaluated cycles, s.
inline constexpr double rig_settle_s = 2.0;

struct RigRun {
    control::RigSeries series;
    double max_speed = 0.0;  ///< m/s, largest speed of the motor
};

/// Throws Error.
RigRun run_rig_cell(const run::PatchChoice& choice, const RigNodes& nodes, const RigCell& cell, int cycles,
                    compile::AssetCache& assets);

RigRow judge_rig_cell(const RigCell& cell, const control::RigSeries& series);

control::ObjectSettings object_of(const RigObject& object);

}  // namespace tactus::analysis
