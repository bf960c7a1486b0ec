// SPDX-License-Identifier: Apache-2.0
// Files of measured elastic objects and of force sensor calibrations.
#pragma once

#include "dsp/control/deflection_table.hpp"
#include "dsp/simulate/gripper/sensors.hpp"

#include <filesystem>

namespace tactus::table {

/// CSV with the columns force_N, loading_mm and unloading_mm; see DeflectionTable. Throws Error.
control::DeflectionTable load_deflection_table(const std::filesystem::path& path);

/// The constant of a force sensor by linear regression over a CSV with the columns reading and force_N: readings under
/// known forces, with any number of repetitions. Throws Error for fewer than three different forces, or when the line
/// explains less than 99 % of the variance: the sensor is then broken, overloaded or not linear.
simulate::LineFit load_force_calibration(const std::filesystem::path& path);

}  // namespace tactus::table
