// SPDX-License-Identifier: Apache-2.0
// QUEST+ (Watson 2017) for one threshold: the next level is the one whose answer is expected to inform most
// about it.
#pragma once

#include "dsp/psychophysics/psychometric.hpp"

#include <cstddef>
#include <vector>

namespace tactus::psychophysics {

struct QuestSettings {
    Form form = Form::weibull;
    std::vector<double> levels;      ///< that may be shown
    std::vector<double>
        thresholds;  ///< levels at which an answer is correct with `target`; prior: uniform over all combinations
    std::vector<double> slopes;
    std::vector<double> lapses{0.02};
    double guess = 0.5;
    double target = 0.75;  ///< probability of a correct answer at the threshold, between guess and 1 - lapse
};

/// Slopes and lapses are not reported: the entropy is that of the threshold alone (psi-marginal, Prins 2013). With the
/// entropy of all parameters many trials go to levels that inform about the slope; after 60 trials the error of the
/// threshold was then 0.088 in log10 instead of 0.073 (`tactus bench experiments`).
class QuestPlus {
public:
    /// Throws Error when a list is empty, not ascending, when a probability would be outside of [0, 1], or when no level has
    /// `target`.
    explicit QuestPlus(const QuestSettings& settings);

    /// Level with the least expected entropy; of equal ones the lowest.
    double level() const { return settings_.levels[next_]; }
    /// Updates the posterior with the answer at `level`, which need not be the proposed one: a device may have rendered
    /// another. Throws Error for a level that is not finite.
    void answer(double level, bool correct);

    double entropy() const;  ///< of the posterior of the threshold, nats

private:
    std::size_t nuisances() const { return settings_.slopes.size() * settings_.lapses.size(); }
    void choose();

    QuestSettings settings_;
    std::vector<Psychometric> functions_;  // a row per threshold, a column per slope and lapse
    std::vector<double> posterior_;  // of functions_
    std::vector<double> likelihood_;  // of a correct answer: a row per level, a column per function
    std::size_t next_ = 0;
};

}  // namespace tactus::psychophysics
