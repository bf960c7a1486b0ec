// SPDX-License-Identifier: Apache-2.0
// Simulated subjects with known parameters, in TOML. docs/reference/experiment-file.md describes the format.
#pragma once

#include "dsp/psychophysics/psychometric.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tactus::experiment {

inline constexpr int observer_format = 1;

/// Answers in a psychophysics trial.
struct SimulatedObserver {
    psychophysics::Form form = psychophysics::Form::weibull;
    double threshold = 1.0;  ///< level, in SI or as a fraction; per condition in `thresholds`
    std::map<std::string, double> thresholds;
    double slope = 3.0;
    double lapse = 0.02;
    double false_alarms = 0.1;  ///< of yes/no and same–different tasks
    double spread = 0.0;        ///< standard deviation of log10 of the threshold between subjects
    double response_time = 0.6; ///< median, s
    /// Of adjustments, on the axis of the stimulus (log10, or level): standard deviation of the level that matches between
    /// trials, and by how much the subject stops before it, coming from either end.
    double match_spread = 0.0, match_lag = 0.0;
};

/// Factors on what a simulated hand does, in the conditions that have this level of this factor.
struct HandEffect {
    std::string factor, level, task;  ///< empty task: all
    double time = 1.0, error = 1.0;
};

/// How a simulated hand does a task: the ideal movement, slower, with errors and late.
struct SimulatedHand {
    double error = 2e-3;  ///< standard deviation of each target on each axis, m
    double lag = 0.0;  ///< s
    double time = 1.0;  ///< factor on the duration of self-paced tasks
    double spread_time = 0.0, spread_error = 0.0;  ///< standard deviations of the logarithms between subjects
    double trial_time = 0.0, trial_error = 0.0;  ///< and between trials of a subject
    std::vector<HandEffect> effects;
};

struct ObserverModel {
    std::filesystem::path file;
    std::string title;
    std::uint64_t seed = 1;
    SimulatedObserver observer;
    SimulatedHand hand;
    bool has_observer = false, has_hand = false;
};

/// `level_unit` is that of the experiment's levels. Throws Error with file:line:column.
ObserverModel load_observer_model(const std::filesystem::path& path, const std::string& level_unit);

}  // namespace tactus::experiment
