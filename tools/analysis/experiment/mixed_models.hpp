// SPDX-License-Identifier: Apache-2.0
// Mixed models of an experiment's comparisons, by R with lmerTest (Kuznetsova, Brockhoff and Christensen 2017): the data and the script
// are written, so that a statistician can change and repeat them, and the script is run where R is installed.
#pragma once

#include "tools/analysis/experiment/analysis.hpp"

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct MixedModel {
    std::string label;  ///< of the comparison
    std::string formula;  ///< of lme4
    bool is_log = false;
    std::size_t values = 0;  ///< rows of data
    std::optional<double> effect, low, high, p, freedom;  ///< b − a, 95 %, degrees of freedom by Satterthwaite
    std::optional<double> subject_deviation, effect_deviation, residual_deviation;  ///< of the random effects
    std::string note;  ///< a singular fit, or why there is none
};

struct MixedModels {
    std::filesystem::path folder;  ///< with data.tsv, model.R and models.tsv
    std::string problem;  ///< why the script did not run; empty: it ran
    std::vector<MixedModel> models;
};

/// Writes FOLDER/mixed and runs its script. Throws Error when a file cannot be written, or when the script fails for another reason
/// than that R or lmerTest is not installed.
MixedModels fit_mixed_models(const ExperimentAnalysis& analysis, const std::filesystem::path& folder,
                             bool has_carry_over, const std::atomic<bool>& stop);

}  // namespace tactus::analysis
