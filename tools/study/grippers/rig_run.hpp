// SPDX-License-Identifier: Apache-2.0
// One cell of a rig's matrix: a patch with a gripper, an object and a rig, run on a virtual clock and judged.
#pragma once

#include "dsp/control/fidelity.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/session/patch_choice.hpp"
#include "tools/study/rig_matrix.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

struct RigCell {
    std::string motor;
    RigObject object;
    double rate = 1.0;        ///< Hz
    double amplitude = 0.025; ///< m of the cord to each side
    std::optional<double> feed_forward;  ///< none: as the patch has it
    std::vector<std::string> settings;   ///< more of them, "devices.wqsm.lag=1 ms"
};

struct RigRow {
    RigCell cell;
    control::Fidelity fidelity;
    std::string failure;  ///< why there is no result; empty when there is one
};

/// Names of the nodes in a patch that a rig needs.
struct RigNodes {
    std::string input, controller, output, rig;
};

/// Throws Error unless the patch has exactly one node of each type.
RigNodes find_rig_nodes(const session::PatchChoice& choice);

/// Seconds before the cycles that count.
inline constexpr double rig_settle_s = 2.0;

struct RigRun {
    control::RigSeries series;
    double max_speed = 0.0;  ///< m/s, of the motor
};

/// Throws Error.
RigRun run_rig_cell(const session::PatchChoice& choice, const RigNodes& nodes, const RigCell& cell, int cycles,
                    compile::AssetCache& assets);

RigRow judge_rig_cell(const RigCell& cell, const control::RigSeries& series);

control::ObjectSettings object_of(const RigObject& object);

}  // namespace tactus::study
