// SPDX-License-Identifier: Apache-2.0
// Compares the rendering errors of two motors under all assumptions.
#pragma once

#include "tools/analysis/gripper/rig_report.hpp"

#include <string>
#include <vector>

namespace tactus::analysis {

/// NRMSE, one row per combination of assumptions, one column per rate; NaN: no result.
using RigErrors = std::vector<std::vector<double>>;

/// The crossover rates of two motors over all pairs of their assumptions, with the bands of both errors. `stiffness` in
/// N/m, `amplitude` in m, `rates` in Hz.
RigCrossover find_crossover(const std::vector<double>& rates, double stiffness, double amplitude, const RigErrors& slow,
                            const RigErrors& fast);

/// Counts the pairs of assumptions for which the error of `better` at the first rate is the smaller one.
RigFinding count_cases(std::string claim, const RigErrors& better, const RigErrors& worse);

}  // namespace tactus::analysis
