// SPDX-License-Identifier: Apache-2.0
// Measured elastic objects and calibrations of force sensors on disk.
#pragma once

#include "dsp/control/deflection_table.hpp"
#include "dsp/simulate/gripper/sensors.hpp"

#include <filesystem>

namespace tactus::table {

/// CSV with the columns force_N, loading_mm and unloading_mm; see DeflectionTable. Throws Error.
control::DeflectionTable load_deflection_table(const std::filesystem::path& path);

/// The constant of a force sensor by linear regression over a CSV with the columns reading and force_N: readings taken
/// under known forces, each as often as you like. Throws Error when fewer than three forces differ or the line explains
/// less than 99 % of their variance: such a sensor is broken, overloaded or not linear.
simulate::LineFit load_force_calibration(const std::filesystem::path& path);

}  // namespace tactus::table
