// SPDX-License-Identifier: Apache-2.0
// Saws a bone at its site at constant thrust: the blade at 1 kHz, the carver at 60 Hz.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/saw/saw_shape.hpp"
#include "dsp/volume/site.hpp"

#include <span>
#include <vector>

namespace tactus::analysis {

struct BoneTrialRow {
    double thrust = 0.0;  ///< N
    double feed = 0.0;  ///< m/s, mean over the measured time
    double removal = 0.0;  ///< m³/s over that time
    double seconds = 0.0;  ///< measured time: shorter if the blade broke through
};

struct BoneTrial {
    volume::SawSite site;
    double voxel = 0.0;  ///< m, of the bone as cut
    std::vector<BoneTrialRow> rows;
};

/// One row per thrust, each on the uncut bone: after 0.5 s in contact, 2 s of cutting or up to the far side. Throws
/// Error when the bone has no site for a saw cut.
BoneTrial run_bone_trial(const bone::Bone& bone, std::span<const double> thrusts, const saw::SawShape& shape = {},
                         double stiffness = 40e3);

/// The same at a given site, for `measured` s of cutting.
BoneTrial run_bone_trial_at(const volume::SawSite& site, const bone::Bone& bone, std::span<const double> thrusts,
                            double measured, const saw::SawShape& shape = {}, double stiffness = 40e3);

}  // namespace tactus::analysis
