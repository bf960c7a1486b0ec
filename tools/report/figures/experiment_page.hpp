// SPDX-License-Identifier: Apache-2.0
// The report of an experiment as one HTML page.
#pragma once

#include "tools/analysis/experiment/analysis.hpp"

#include <string>

namespace tactus::report {

/// A complete page: subjects, figures of each subject and of the group, comparisons with intervals, equivalence and what this number
/// of subjects could show. Simulated data and rehearsals are labelled.
std::string experiment_page(const analysis::ExperimentAnalysis& analysis);

}  // namespace tactus::report
