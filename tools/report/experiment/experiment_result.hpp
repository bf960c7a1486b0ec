// SPDX-License-Identifier: Apache-2.0
// What an experiment found, as a result.
#pragma once

#include "tools/analysis/experiment/analysis.hpp"
#include "tools/analysis/experiment/mixed_models.hpp"
#include "tools/report/result/fields.hpp"

#include <optional>

namespace tactus::report {

struct FoundExperiment {
    const analysis::ExperimentAnalysis* analysis;
    std::optional<analysis::MixedModels> mixed;  ///< if asked for
};

const Fields<FoundExperiment>& experiment_fields();

}  // namespace tactus::report
