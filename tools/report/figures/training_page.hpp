// SPDX-License-Identifier: Apache-2.0
// The page of a debriefing: what was cut, and how it was scored.
#pragma once

#include "tools/analysis/training/measures.hpp"

#include <span>
#include <string>

namespace tactus::report {

/// A page with the scores of all runs (at least one), learning curves of several, what a reference group scored
/// (may be empty), and pictures of the last run. Says that the scores are not validated. Without a display that can
/// draw, the page has no pictures of the bone and says why.
std::string training_page(std::span<const analysis::ScoredRun> runs,
                          std::span<const analysis::ReferenceMeasure> reference);

}  // namespace tactus::report
