// SPDX-License-Identifier: Apache-2.0
// Sinks a round burr into an analytic block under a constant thrust.
#pragma once

#include "dsp/saw/burr.hpp"

namespace tactus::analysis {

struct BurrTrial {
    double thrust = 4.0;  ///< N
    double turn_rate = 1000.0, tick_rate = 1000.0;  ///< Hz
    double voxel = 0.33e-3;  ///< m
    double density = 1800.0;  ///< kg/m³
    double settle = 1.0, seconds = 1.0;  ///< s before and during the measurement
    double stiffness = 20e3;  ///< N/m
    saw::BurrShape shape{};
};

struct BurrTrialResult {
    double feed = 0.0;  ///< m/s, mean
    double thrust = 0.0;  ///< N, mean: what the hand's own damping leaves
    double along = 0.0;  ///< N, mean force of the flutes around the shaft
    double width = 0.0;  ///< m of a flute in bone, mean
    double removal = 0.0;  ///< m³/s
};

/// The block is as deep as the burr may sink in this time, at most 30 mm; a burr that would go through it counts up to there.
BurrTrialResult run_burr_trial(const BurrTrial& trial);

}  // namespace tactus::analysis
