// SPDX-License-Identifier: Apache-2.0
// QUEST+ (Watson 2017): the next level is the one whose answer is expected to leave the least entropy.
#pragma once

#include "dsp/psychophysics/psychometric.hpp"

#include <cstddef>
#include <vector>

namespace tactus::psychophysics {

struct QuestSettings {
    Form form = Form::weibull;
    std::vector<double> levels;      ///< that may be shown
    std::vector<double> thresholds;  ///< prior: uniform over all combinations
    std::vector<double> slopes;
    std::vector<double> lapses{0.02};
    double guess = 0.5;
};

class QuestPlus {
public:
    /// Throws Error when a list is empty, not ascending, or when a probability would be outside of [0, 1].
    explicit QuestPlus(const QuestSettings& settings);

    /// Level with the least expected entropy; of equal ones the lowest.
    double level() const { return settings_.levels[next_]; }
    /// Updates the posterior with the answer at `level`, which need not be the proposed one: a device may have rendered
    /// another. Throws Error for a level that is not finite.
    void answer(double level, bool correct);

    Psychometric mean() const;  ///< of the posterior
    double threshold_deviation() const;  ///< standard deviation of the posterior threshold
    double entropy() const;  ///< of the posterior, nats

private:
    void choose();
    Psychometric parameters(std::size_t index) const;

    QuestSettings settings_;
    std::vector<double> posterior_;
    std::vector<double> likelihood_;  // of a correct answer: row per level, column per combination
    std::vector<double> likelihood_entropy_;  // of the answer, same shape
    std::size_t next_ = 0;
};

}  // namespace tactus::psychophysics
