// SPDX-License-Identifier: Apache-2.0
// Scores as JSON, CSV and lines of text. All of them say that they are not validated.
#pragma once

#include "tools/analysis/training/measures.hpp"

#include <span>
#include <string>

namespace tactus::command {

/// One run without a reference group: the object of its scores. Otherwise {"version": 1, "rows": [...], "learning":
/// [...], "reference": [...]}.
std::string score_json(std::span<const analysis::ScoredRun> runs,
                       std::span<const analysis::ReferenceMeasure> reference);

/// The object of one run alone.
std::string score_json(const analysis::ScoredRun& run);

std::string score_csv(std::span<const analysis::ScoredRun> runs);

std::string score_text(std::span<const analysis::ScoredRun> runs,
                       std::span<const analysis::ReferenceMeasure> reference);

}  // namespace tactus::command
