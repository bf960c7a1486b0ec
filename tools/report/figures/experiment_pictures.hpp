// SPDX-License-Identifier: Apache-2.0
// Figures of an experiment: answers and matches of each subject, values of the group, and the comparisons.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/experiment/analysis.hpp"

#include <string>

namespace tactus::report {

/// One panel for each of the first 24 subjects: answers by level, and the fitted function of each condition.
display::Figure draw_psychometric(const analysis::ExperimentAnalysis& analysis);

/// The same of adjustments: the matches of each condition by the direction from which they began, and their mean with its interval.
display::Figure draw_matches(const analysis::ExperimentAnalysis& analysis);

/// Values of all subjects by condition, with the mean and its interval of 95 %. Psychophysics: no task, measure "threshold".
display::Figure draw_group(const analysis::ExperimentAnalysis& analysis, const std::string& task,
                           const std::string& measure);

/// A row for each comparison: interval of the standardised difference, and the margin.
display::Figure draw_effects(const analysis::ExperimentAnalysis& analysis);

}  // namespace tactus::report
