// SPDX-License-Identifier: Apache-2.0
// Scores of several attempts: one list of measures, learning curves, and a reference group.
#pragma once

#include "tools/analysis/training/score.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

struct Measure {
    std::string name;  ///< "plane.rms_mm"
    std::string label;  ///< for pages, with the unit
    enum class Better { less, more, unknown } better;
    std::optional<double> (*of)(const Score&);
};

/// All measures, in the order of a score. Those of spared structures are the sum of the injured volumes and the
/// smallest distance.
std::span<const Measure> measures();

/// Values of one measure over the attempts at one task, in the given order.
struct LearningCurve {
    std::string task, measure;
    std::vector<std::optional<double>> values;
    std::optional<double>
        exponent;  ///< b of value = a n^b (power law of practice), by least squares of the logarithms;
                                     ///< none for fewer than three values or if one is not above 0
};
std::vector<LearningCurve> learning_curves(std::span<const ScoredRun> runs);

/// Values of a group of attempts in one measure.
struct ReferenceMeasure {
    std::string measure;
    std::vector<double> values;  ///< ascending; attempts without a value are excluded
    double mean = 0.0;
    std::optional<double> deviation;  ///< standard deviation of the sample; none for fewer than two values
};
std::vector<ReferenceMeasure> reference_of(std::span<const ScoredRun> runs);

/// Returns the percentage of the group with a worse value, counting half of those with an equal one. Empty without a
/// value or a group, or if the measure has no better direction.
std::optional<double> percentile(const Measure& measure, const std::optional<double>& value,
                                 const ReferenceMeasure& group);

}  // namespace tactus::analysis
