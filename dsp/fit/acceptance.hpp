// SPDX-License-Identifier: Apache-2.0
// What a fit of two painted faces must show before anything believes it. The live search, the verbs of plans and the
// assembly of a case take their thresholds from here, and from nowhere else.
#pragma once

namespace tactus::fit {

/// Set by `tactus bench fits --half set --groups 28`: 14 broken bones, 413 pairs of pieces that do not belong together,
/// each in two modes, and 212 true fits. Judged by `--half judge`. In brackets: the weakest true fit but for 2 %, and the
/// strongest false one that the other thresholds let pass.
struct Acceptance {
    static constexpr double least_score = 0.30;  ///< (0.34; 0.28)
    static constexpr double most_rms = 0.68;  ///< of the distances within the overlap, as share of sigma (0.59; 0.75)
    static constexpr double least_margin = 0.12;  ///< to the second best pose, as share of the best score (0.18)
    static constexpr double least_share = 0.35;  ///< of the smaller face of the two (0.41)
    static constexpr double least_area = 20e-6;  ///< m² on each other (25; 14); coarse scans need more, see widen_for
    /// m, two standard deviations at the far end of the moving fragment, see fit_precision.hpp. Of faces of bones whose
    /// place was known, those up to 0.60 mm were within 0.31 mm of it; the next one, at 0.68 mm, was 0.62 mm off.
    static constexpr double most_far = 0.65e-3;
    /// What a match must show that fails a limit above and is still reported as uncertain, because chips spoil a face and
    /// do not move it: the score and the margin together are then beyond those of pieces that do not belong together.
    static constexpr double likely_score = 0.42;
    static constexpr double likely_margin = 0.3;
    static constexpr double likely_rms = 0.9;  ///< share of sigma
    static constexpr double least_paint_share = 0.1;  ///< of all paint of the fragment that has less
};

}  // namespace tactus::fit
