// SPDX-License-Identifier: Apache-2.0
// Saws an analytic block at constant thrust or constant feed: the blade at the force's rate, the carver at 60 Hz.
#pragma once

#include "dsp/carve/carver.hpp"
#include "dsp/saw/saw_blade.hpp"
#include "dsp/volume/bricks.hpp"

#include <memory>

namespace tactus::analysis {

struct SawTrial {
    double thrust = 7.0;  ///< N; or
    double feed = 0.0;  ///< m/s of the hand; above 0 it moves at this speed regardless of the force
    double blade_rate = 228.0;  ///< Hz
    double tick_rate = 1000.0;  ///< Hz
    double voxel = 0.33e-3;  ///< m
    double density = 1800.0;  ///< kg/m³
    double width = 0.012, depth = 0.008, thickness = 0.008;  ///< m of the block: along the blade, into it, across it
    double settle = 1.5, seconds = 2.0;  ///< s before and during the measurement
    double stiffness = 40e3;  ///< N/m
    saw::SawShape shape{};
};

struct SawTrialResult {
    double feed = 0.0;  ///< m/s, mean
    double thrust = 0.0, along = 0.0;  ///< N, means
    double teeth = 0.0;  ///< mean number of teeth in contact
    double removal = 0.0;  ///< m³/s
};

/// A block with its top at z = 0 in its middle.
std::unique_ptr<volume::BoneEditor> saw_block(const SawTrial& trial);

SawTrialResult run_saw_trial(const SawTrial& trial);

/// Carver settings for fronts of that blade.
carve::CarveSettings carve_settings_for(const saw::SawShape& shape);

}  // namespace tactus::analysis
