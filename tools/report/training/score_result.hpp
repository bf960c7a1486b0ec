// SPDX-License-Identifier: Apache-2.0
// Scores of attempts at a training task as results. All of them state that they are not validated.
#pragma once

#include "tools/analysis/training/measures.hpp"
#include "tools/report/result/fields.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::report {

/// Pictures of one cut of an attempt.
struct CutPictures {
    std::string title;
    display::Figure bone, face;
    std::string face_caption;
};

/// Of the last attempt, if asked for.
struct AttemptPictures {
    std::vector<CutPictures> cuts;
    std::string missing;  ///< why there are none
    bool is_drawn = false;
};

/// Without a display that can draw there are no pictures.
AttemptPictures pictures_of(const analysis::ScoredRun& run);

struct ScoredRuns {
    std::span<const analysis::ScoredRun> runs;  ///< at least one
    std::span<const analysis::ReferenceMeasure> reference;  ///< of a group; may be empty
    AttemptPictures pictures{};
};

/// One run without a reference group: the object of its scores. Otherwise {"rows": [...], "learning": [...],
/// "reference": [...]}.
Result score_result(const ScoredRuns& runs);
std::vector<file::Json> score_schemas();

/// A row per run.
std::string score_table(std::span<const analysis::ScoredRun> runs);

}  // namespace tactus::report
