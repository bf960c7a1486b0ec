// SPDX-License-Identifier: Apache-2.0
// What an experiment found: thresholds and measures of each subject, the comparisons that its protocol states, and what this
// number of subjects could have shown.
#pragma once

#include "assets/experiment/protocol.hpp"
#include "assets/experiment/records.hpp"
#include "dsp/psychophysics/adjustment.hpp"
#include "dsp/psychophysics/fit.hpp"
#include "dsp/statistics/carry_over.hpp"
#include "dsp/statistics/paired.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// Where a value lies that the range of the stimulus does not hold.
enum class Beyond : std::uint8_t { no, below, above, unknown };

/// Answers of a subject in a condition, fitted.
struct SubjectThreshold {
    std::string condition;
    std::vector<psychophysics::LevelCount> counts;  ///< levels on the axis of the stimulus
    std::optional<psychophysics::PsychometricFit> fit;
    std::optional<double> threshold;  ///< level with the target probability; none: not identified
    std::string problem;  ///< why it is not identified
    Beyond beyond = Beyond::no;  ///< of one that is not identified; no: answers are missing
    std::optional<double> with_marked;  ///< the same with the marked trials
    /// 95 %: constant stimuli by a parametric bootstrap, adaptive methods by the posterior.
    std::optional<psychophysics::Interval> interval;
    bool is_low_beyond = false, is_high_beyond = false;  ///< that end of the interval lies beyond the range
    std::optional<double> d_prime, criterion;  ///< of yes/no tasks
    std::optional<psychophysics::AdjustedLevel> adjusted;  ///< of identified matches: `threshold` is its match
    double max_level_error = 0.0;  ///< largest deviation of the rendered level from the wanted one, a fraction
};

struct AnalysedSubject {
    experiment::SubjectEntry entry;
    int trials = 0, marked = 0, catch_trials = 0, catch_correct = 0;
    std::map<std::string, int> marked_in;  ///< by condition
    bool is_rehearsal = false;
    std::string excluded;  ///< why, by the rules of the protocol; empty: included
    std::vector<SubjectThreshold> thresholds;
    /// Mean of a measure over the trials of a task in a condition: "task measure condition". Logarithms where the protocol
    /// states so.
    std::map<std::string, double> means;
    std::map<std::string, double> unmarked_means;  ///< the same without the marked trials
    std::vector<experiment::TrialRecord> records;
};

struct AnalysedComparison {
    experiment::Comparison of;
    std::string label;
    bool is_log = false;  ///< differences are of natural logarithms
    std::vector<std::string> subjects;
    std::vector<double> differences;  ///< b − a
    std::string problem;  ///< why there is no test; empty: there is one
    std::size_t beyond = 0;  ///< subjects with a value beyond the range of the stimulus; above 0: not judged
    /// Mean difference with the ends of the range in place of the values beyond them; none: their sides do not agree.
    std::optional<double> bound;
    bool is_lower_bound = false;  ///< the mean difference is at least `bound`; else at most
    std::optional<statistics::PairedTest> test;
    std::optional<statistics::PermutationTest> permutation;
    double adjusted_p = 1.0;  ///< Holm, over all comparisons that were tested
    /// The same test with the marked trials, where the analysis leaves them out (psychophysics), or without them (tasks). None:
    /// no trial is marked, or too few values are left.
    std::optional<statistics::PairedTest> other_marked;
    std::optional<statistics::EquivalenceTest> equivalence;
    std::pair<double, double> effect_interval;  ///< of the difference in standard deviations, confidence 1 - 2 alpha
    std::optional<statistics::CrossOver> cross_over;
    std::optional<statistics::CarryOver>
        carry_over;  ///< if asked for; per difference of `b` and `a` in the period before
    std::string carry_over_problem;  ///< why there is none
    double detectable = 0.0;  ///< standardised effect found with 80 % power at this n
    double equivalence_power = 0.0;  ///< at no effect
};

struct GroupValue {
    std::string task, measure, condition;
    bool is_log = false;  ///< mean and interval are geometric
    std::size_t count = 0;
    double mean = 0.0, low = 0.0, high = 0.0;
    std::size_t marked = 0;  ///< trials, of all included subjects
    std::size_t below = 0, above = 0, unknown = 0;  ///< subjects beyond the range of the stimulus, not in `count`

    /// Whether the mean lacks values because of their size: then it has no interval.
    bool is_bound() const { return below + above + unknown > 0; }
};

struct ExperimentAnalysis {
    experiment::Protocol protocol;
    std::vector<AnalysedSubject> subjects;
    std::vector<GroupValue> groups;
    std::vector<AnalysedComparison> comparisons;
    bool is_simulated = false, is_rehearsal = false;
    std::size_t included = 0;
};

struct AnalysisSettings {
    int bootstrap = 499;  ///< samples for the intervals of constant stimuli; 0: none
    bool has_carry_over = false;  ///< also adjust each comparison for carry-over
};

/// Marked trials: psychophysics leaves them out and tasks include them, or the other way round.
enum class Marked : std::uint8_t { as_analysed, other };

/// Natural logarithm of a threshold on a log axis or of a measure with `log`, else the value itself; none: there is none.
std::optional<double> value_of(const experiment::Protocol& protocol, const AnalysedSubject& subject,
                               const std::string& task, const std::string& measure, const std::string& condition,
                               Marked marked = Marked::as_analysed);

/// Unit in which a measure or a threshold is shown; empty: none.
std::string unit_of(const experiment::Protocol& protocol, const std::string& task, const std::string& measure);

/// Reads and analyses. Throws Error when the folder is none, or holds no subject.
ExperimentAnalysis analyse_experiment(const std::filesystem::path& folder, const AnalysisSettings& settings);

/// Measures computed again from the takes of all trials that have one.
struct TakeCheck {
    std::size_t trials = 0, values = 0;
    std::vector<std::string> differences;
};
TakeCheck check_takes(const std::filesystem::path& folder);

/// participants.tsv and .json, dataset_description.json, and for each subject beh/*_beh.tsv with .json (BIDS 1.9).
void write_bids(const ExperimentAnalysis& analysis, const std::filesystem::path& folder);

/// "effect", "equivalent", "effect within the margin" or "inconclusive": never "no effect". "not judged" where values lie
/// beyond the range of the stimulus, "not tested" without a test.
std::string verdict_of(const AnalysedComparison& comparison, double alpha);

}  // namespace tactus::analysis
