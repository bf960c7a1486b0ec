// SPDX-License-Identifier: Apache-2.0
// Results of a rig study.
#pragma once

#include "tools/analysis/gripper/rig_run.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// The rate above which the second motor renders better, over all assumptions about both motors.
struct RigCrossover {
    double stiffness = 0.0, amplitude = 0.0;  ///< N/m, m
    std::optional<double> low, high;          ///< Hz; none: not within the tested rates
    int crossed = 0, of = 0;                  ///< pairs of assumptions
    std::vector<double> rates;                ///< Hz
    std::vector<std::pair<double, double>> slow_motor, fast_motor;  ///< minimum and maximum NRMSE per rate
};

/// A statement of the thesis, and the number of assumptions for which it holds.
struct RigFinding {
    std::string claim;
    int holds = 0, of = 0;
};

/// The loop of the thesis compared with one with feed-forward.
struct RigLead {
    RigCell cell;
    double nrmse = 0.0, led_nrmse = 0.0;
    double ratio() const { return nrmse / led_nrmse; }
};

struct RigExample {
    std::string title;
    control::RigSeries series;
    RigCell cell;
};

struct RigReport {
    std::string title, source;                   ///< title of the patch; description of the source
    std::vector<RigRow> rows;
    double peak_cord_speed = 0.0;                ///< m/s at 1 Hz with the largest amplitude
    std::optional<double> saturation_rate;       ///< Hz, free motion of the slowest motor, measured
    std::optional<double> saturation_closed_form;
    std::vector<RigCrossover> crossover;
    std::vector<RigFinding> findings;
    std::vector<RigLead> leads;
    std::vector<RigAssumption> assumptions;
    std::vector<RigExample> examples;
    std::vector<std::string> notes;
};

}  // namespace tactus::analysis
