// SPDX-License-Identifier: Apache-2.0
// Thresholds that a fit of two painted faces must reach to be accepted. The live search, the verbs of plans and the
// assembly of a case all use these values.
#pragma once

namespace tactus::fit {

/// Set by `tactus bench fits --half set --groups 28`: 14 broken bones, 413 pairs of fragments that do not belong
/// together, each in two modes, and 212 true fits. Evaluated by `--half judge`. In brackets: the value that 98 % of the
/// true fits reach, and the best value of a false fit that passes all other thresholds.
/// strongest false one that the other thresholds let pass.
struct Acceptance {
    static constexpr double min_score = 0.30;  ///< (0.34; 0.28)
    static constexpr double max_rms = 0.68;  ///< of the distances within the overlap, in units of sigma (0.59; 0.75)
    static constexpr double min_margin = 0.12;  ///< to the second best pose, as fraction of the best score (0.18)
    static constexpr double min_share = 0.35;  ///< of the smaller of the two faces (0.41)
    static constexpr double min_area = 20e-6;  ///< m² in contact (25; 14); coarse scans need more, see widen_for
    /// m, two standard deviations at the far end of the moving fragment, see fit_precision.hpp. For bones with known
    /// positions, faces up to 0.60 mm had errors of at most 0.31 mm; the next one, at 0.68 mm, had 0.62 mm.
    static constexpr double max_far = 0.65e-3;
    /// A match that fails a limit above is still reported as uncertain if its score and its margin are both beyond
    /// those of fragments that do not belong together. The reason: chips lower the quality of a face but do not shift
    /// its pose.
    static constexpr double likely_score = 0.42;
    static constexpr double likely_margin = 0.3;
    static constexpr double likely_rms = 0.9;  ///< fraction of sigma
    static constexpr double min_paint_share = 0.1;  ///< of the paint of the fragment with less paint
};

}  // namespace tactus::fit
