// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/analysis.hpp"

#include "dsp/core/error.hpp"
#include "dsp/psychophysics/detection.hpp"
#include "dsp/psychophysics/posterior.hpp"
#include "dsp/statistics/distributions.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/port_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace tactus::analysis {

namespace fs = std::filesystem;
using experiment::Phase;
using experiment::Protocol;
using experiment::ResponseKind;
using experiment::TrialRecord;

namespace {

bool is_data(const TrialRecord& trial) { return trial.phase == Phase::main || trial.phase == Phase::repeat; }

std::string key_of(const std::string& task, const std::string& measure, const std::string& condition) {
    return task + " " + measure + " " + condition;
}

struct Answers {
    std::vector<double> levels;
    std::vector<bool> correct;
    double hits = 0.0, signals = 0.0, false_alarms = 0.0, noises = 0.0;
};

Answers answers_of(const Protocol& protocol, const std::vector<TrialRecord>& records, const std::string& condition,
                   bool with_marked) {
    Answers answers;
    for (const TrialRecord& trial : records) {
        if (!is_data(trial) || trial.condition != condition || (!with_marked && !trial.marked.empty())) continue;
        if (trial.interval == 0) {
            answers.noises += 1.0;
            answers.false_alarms += trial.answer == 1 ? 1.0 : 0.0;
            continue;
        }
        answers.levels.push_back(protocol.stimulus->axis(trial.level));
        answers.correct.push_back(trial.is_correct);
        answers.signals += 1.0;
        answers.hits += trial.is_correct ? 1.0 : 0.0;
    }
    return answers;
}

psychophysics::FitSettings fit_settings(const Protocol& protocol, const Answers& answers) {
    psychophysics::FitSettings settings;
    settings.form = protocol.method.form;
    settings.lapse = protocol.method.lapse;
    settings.min_slope = 0.2 * protocol.method.slopes.front();
    settings.max_slope = 20.0 * protocol.method.slopes.back();
    settings.guess = protocol.response.kind == ResponseKind::choice
                         ? protocol.response.guess()
                         : (answers.false_alarms + 0.5) / (answers.noises + 1.0);
    return settings;
}

/// A level on the axis of the stimulus, or why there is none.
struct Estimate {
    std::optional<double> axis;
    std::optional<psychophysics::Interval> interval;
    std::optional<psychophysics::AdjustedLevel> adjusted;
    std::string problem;
    Beyond beyond = Beyond::no;
};

/// The end of the range at which a match lies: the matching level may lie beyond it.
Beyond end_of_range(const experiment::Stimulus& stimulus, double level) {
    const double low = stimulus.axis(stimulus.presentable(stimulus.min)),
                 high = stimulus.axis(stimulus.presentable(stimulus.max)), axis = stimulus.axis(level),
                 near = 1e-9 * (high - low);
    return axis <= low + near ? Beyond::below : axis >= high - near ? Beyond::above : Beyond::no;
}

Beyond both(Beyond a, Beyond b) { return a == Beyond::no || a == b ? b : b == Beyond::no ? a : Beyond::unknown; }

Estimate adjusted_in(const Protocol& protocol, const std::vector<TrialRecord>& records, const std::string& condition,
                     bool with_marked) {
    Estimate result;
    std::vector<double> matches;
    std::vector<bool> began_above;
    std::size_t censored = 0;
    for (const TrialRecord& trial : records) {
        if (!is_data(trial) || trial.condition != condition || !trial.match) continue;
        if (!with_marked && !trial.marked.empty()) continue;
        matches.push_back(protocol.stimulus->axis(*trial.match));
        const Beyond end = end_of_range(*protocol.stimulus, *trial.match);
        censored += end != Beyond::no ? 1 : 0;
        result.beyond = both(result.beyond, end);
        began_above.push_back(protocol.begins_above(trial.level));
    }
    result.adjusted = psychophysics::adjusted_level(matches, began_above);
    if (censored > 0)
        result.problem = fmt::format("{} of {} matches are at an end of the range: the matching level may lie beyond it",
                                     censored, matches.size());
    else if (!result.adjusted)
        result.problem = fmt::format("{} matches: too few from below or from above", matches.size());
    if (!result.problem.empty()) {
        result.adjusted.reset();
        return result;
    }
    result.axis = result.adjusted->match;
    result.interval = result.adjusted->interval;
    return result;
}

/// `samples` of the bootstrap, 0: none.
Estimate estimate_of(const Protocol& protocol, const std::vector<psychophysics::LevelCount>& counts,
                     const psychophysics::FitSettings& settings, const psychophysics::PsychometricFit& fit, int samples,
                     std::uint64_t seed) {
    const experiment::Stimulus& stimulus = *protocol.stimulus;
    const double low = stimulus.axis(stimulus.min), high = stimulus.axis(stimulus.max),
                 target = protocol.method.target;
    Estimate result;
    if (!(target > settings.guess)) {
        result.problem = fmt::format("the rate of false alarms, {:.3g}, is not below the target, {:.3g}: no level has it",
                                     settings.guess, target);
        result.beyond = Beyond::unknown;
        return result;
    }
    const auto posterior = psychophysics::posterior_level(
        counts,
        psychophysics::threshold_prior(settings.form, settings.guess, protocol.method.lapse, protocol.method.slopes, low,
                                       high),
        target);
    const auto side_of = [&](double at) { return at <= low ? Beyond::below : at >= high ? Beyond::above : Beyond::no; };
    double axis = fit.function.level_of(target);
    if (!fit.is_identified || !std::isfinite(axis)) {
        result.problem = "the answers do not exclude that it lies beyond all levels";
        result.beyond = side_of(posterior.median);
        if (result.beyond == Beyond::no) result.beyond = Beyond::unknown;
        return result;
    }
    const bool is_adaptive = protocol.method.kind != experiment::Method::Kind::constant;
    if (is_adaptive) {
        axis = posterior.median;
        result.interval = posterior.interval;
    }
    if (result.beyond = side_of(axis); result.beyond != Beyond::no) {
        result.interval.reset();
        result.problem = "the answers place it at or beyond an end of the range";
        return result;
    }
    result.axis = axis;
    if (!is_adaptive && samples > 0) try {
            result.interval =
                psychophysics::bootstrap_fit(counts, settings, fit, target, samples, 0.95, seed).threshold;
        } catch (const Error&) {
            result.interval.reset();  // too few answers: the threshold has no interval
        }
    return result;
}

void set_estimate(const Protocol& protocol, const Estimate& estimate, SubjectThreshold& threshold) {
    const auto level = [&](double axis) { return protocol.stimulus->level_at(axis); };
    threshold.problem = estimate.problem;
    threshold.beyond = estimate.beyond;
    threshold.adjusted = estimate.adjusted;
    if (estimate.axis) threshold.threshold = level(*estimate.axis);
    if (!estimate.interval) return;
    const auto [low, high] = *estimate.interval;
    threshold.interval = {level(low), level(high)};
    threshold.is_low_beyond = low < protocol.stimulus->axis(protocol.stimulus->min);
    threshold.is_high_beyond = high > protocol.stimulus->axis(protocol.stimulus->max);
}

SubjectThreshold analyse_adjustment(const Protocol& protocol, const AnalysedSubject& subject,
                                    const std::string& condition) {
    SubjectThreshold result;
    result.condition = condition;
    set_estimate(protocol, adjusted_in(protocol, subject.records, condition, false), result);
    if (const Estimate all = adjusted_in(protocol, subject.records, condition, true); all.axis)
        result.with_marked = protocol.stimulus->level_at(*all.axis);
    return result;
}

double max_level_error_of(const AnalysedSubject& subject, const std::string& condition) {
    double greatest = 0.0;
    for (const TrialRecord& trial : subject.records) {
        const double wanted = trial.match.value_or(trial.level);
        if (trial.condition == condition && trial.rendered_level && wanted != 0.0)
            greatest = std::max(greatest, std::abs(*trial.rendered_level / wanted - 1.0));
    }
    return greatest;
}

SubjectThreshold analyse_condition(const Protocol& protocol, const AnalysedSubject& subject,
                                   const std::string& condition, const AnalysisSettings& how, std::uint64_t seed) {
    if (protocol.is_adjustment()) return analyse_adjustment(protocol, subject, condition);
    SubjectThreshold result;
    result.condition = condition;
    const Answers answers = answers_of(protocol, subject.records, condition, false);
    result.counts = psychophysics::count_levels(answers.levels, answers.correct);
    const psychophysics::FitSettings settings = fit_settings(protocol, answers);
    if (result.counts.size() >= 2) {
        result.fit = psychophysics::fit_psychometric(result.counts, settings);
        set_estimate(protocol, estimate_of(protocol, result.counts, settings, *result.fit, how.bootstrap, seed),
                     result);
        const Answers all = answers_of(protocol, subject.records, condition, true);
        const auto counts = psychophysics::count_levels(all.levels, all.correct);
        const psychophysics::FitSettings with_all = fit_settings(protocol, all);
        const auto fit = psychophysics::fit_psychometric(counts, with_all);
        if (const Estimate estimate = estimate_of(protocol, counts, with_all, fit, 0, seed); estimate.axis)
            result.with_marked = protocol.stimulus->level_at(*estimate.axis);
    } else {
        result.problem = "there are answers at fewer than two levels";
        if (!result.counts.empty()) result.beyond = Beyond::unknown;
    }
    if (protocol.response.kind == ResponseKind::yes_no && answers.signals > 0.0 && answers.noises > 0.0) {
        const auto detection =
            psychophysics::yes_no(answers.hits, answers.signals, answers.false_alarms, answers.noises);
        result.d_prime = detection.d_prime;
        result.criterion = detection.criterion;
    }
    return result;
}

void analyse_tasks(const Protocol& protocol, AnalysedSubject& subject) {
    for (const experiment::Task& task : protocol.tasks)
        for (const experiment::Measure& measure : task.measures)
            for (const experiment::Condition& condition : protocol.conditions) {
                double sum = 0.0, n = 0.0, unmarked_sum = 0.0, unmarked = 0.0;
                for (const TrialRecord& trial : subject.records) {
                    const auto value = trial.measures.find(measure.name);
                    if (!is_data(trial) || trial.task != task.name || trial.condition != condition.name ||
                        value == trial.measures.end())
                        continue;
                    if (measure.is_log && !(value->second > 0.0)) continue;
                    const double one = measure.is_log ? std::log(value->second) : value->second;
                    sum += one;
                    n += 1.0;
                    if (!trial.marked.empty()) continue;
                    unmarked_sum += one;
                    unmarked += 1.0;
                }
                const std::string key = key_of(task.name, measure.name, condition.name);
                if (n > 0.0) subject.means[key] = sum / n;
                if (unmarked > 0.0) subject.unmarked_means[key] = unmarked_sum / unmarked;
            }
}

std::string exclusion_of(const Protocol& protocol, const AnalysedSubject& subject) {
    if (!subject.entry.is_complete) return "the session is not complete";
    if (subject.trials == 0) return "there are no trials";
    const experiment::Limits& limits = protocol.limits;
    // Beyond the rounding of the product: 55 of 100 are enough for 0.55.
    if (subject.catch_trials > 0 && subject.catch_correct < limits.min_catch * subject.catch_trials - 1e-9)
        return fmt::format("{} of {} catch trials were correct", subject.catch_correct, subject.catch_trials);
    if (subject.trials > 0 && subject.marked > limits.max_marked * subject.trials + 1e-9)
        return fmt::format("{} of {} trials were marked", subject.marked, subject.trials);
    return {};
}

bool is_log_measure(const Protocol& protocol, const std::string& task, const std::string& measure) {
    if (protocol.is_psychophysics()) return protocol.stimulus->is_log;
    for (const experiment::Task& one : protocol.tasks)
        for (const experiment::Measure& other : one.measures)
            if (one.name == task && other.name == measure) return other.is_log;
    return false;
}

/// Conditions with a level of the comparison's factor, within its other level.
std::vector<std::string> conditions_of(const Protocol& protocol, const experiment::Comparison& comparison,
                                       const std::string& level) {
    std::vector<std::string> names;
    for (const experiment::Condition& condition : protocol.conditions)
        if (condition.factors.at(comparison.factor) == level &&
            (comparison.within_factor.empty() || condition.factors.at(comparison.within_factor) == comparison.within))
            names.push_back(condition.name);
    return names;
}

/// Mean over conditions; none when one is missing.
std::optional<double> mean_over(const Protocol& protocol, const AnalysedSubject& subject,
                                const experiment::Comparison& comparison, const std::string& level,
                                Marked marked = Marked::as_analysed) {
    double sum = 0.0;
    const std::vector<std::string> names = conditions_of(protocol, comparison, level);
    if (names.empty()) return std::nullopt;
    for (const std::string& name : names) {
        const std::optional<double> value =
            value_of(protocol, subject, comparison.task, comparison.measure, name, marked);
        if (!value) return std::nullopt;
        sum += *value;
    }
    return sum / static_cast<double>(names.size());
}

/// Side of a subject's value in a condition.
Beyond beyond_of(const AnalysedSubject& subject, const std::string& condition) {
    for (const SubjectThreshold& one : subject.thresholds)
        if (one.condition == condition) return one.beyond;
    return Beyond::no;
}

/// As mean_over, with the end of the range in place of a value beyond it, and the side on which the mean lies of that.
struct BoundedMean {
    double value = 0.0;
    Beyond beyond = Beyond::no;
};
std::optional<BoundedMean> bounded_mean(const Protocol& protocol, const AnalysedSubject& subject,
                                        const experiment::Comparison& comparison, const std::string& level) {
    BoundedMean mean;
    const std::vector<std::string> names = conditions_of(protocol, comparison, level);
    if (names.empty()) return std::nullopt;
    for (const std::string& name : names) {
        std::optional<double> value = value_of(protocol, subject, comparison.task, comparison.measure, name);
        if (!value) {
            const Beyond side = beyond_of(subject, name);
            if (side == Beyond::no) return std::nullopt;
            mean.beyond = both(mean.beyond, side);
            const double end = side == Beyond::below ? protocol.stimulus->min : protocol.stimulus->max;
            value = protocol.stimulus->is_log ? std::log(end) : end;
        }
        mean.value += *value / static_cast<double>(names.size());
    }
    return mean;
}

/// Side of a difference b - a.
Beyond side_of_difference(Beyond a, Beyond b) {
    return both(b, a == Beyond::below ? Beyond::above : a == Beyond::above ? Beyond::below : a);
}

/// Mean place of the level's conditions in the subject's order.
double place_of(const Protocol& protocol, std::size_t row, const experiment::Comparison& comparison,
                const std::string& level) {
    const std::vector<std::string> names = conditions_of(protocol, comparison, level);
    const std::vector<std::size_t> order = experiment::condition_order(protocol, row);
    double sum = 0.0, n = 0.0;
    for (std::size_t place = 0; place < order.size(); ++place)
        if (std::ranges::find(names, protocol.conditions[order[place]].name) != names.end()) {
            sum += static_cast<double>(place);
            n += 1.0;
        }
    return n > 0.0 ? sum / n : 0.0;
}

/// The comparison as a contrast of conditions in the model with periods and carry-over of its factor. Throws Error.
statistics::CarryOver carry_over_of(const ExperimentAnalysis& analysis, const experiment::Comparison& comparison) {
    const Protocol& protocol = analysis.protocol;
    const std::size_t count = protocol.conditions.size();
    std::vector<double> contrast(count, 0.0), left(count, 0.0);
    const std::vector<std::string> a = conditions_of(protocol, comparison, comparison.a),
                                   b = conditions_of(protocol, comparison, comparison.b);
    for (std::size_t i = 0; i < count; ++i) {
        const experiment::Condition& condition = protocol.conditions[i];
        if (std::ranges::find(a, condition.name) != a.end()) contrast[i] = -1.0 / static_cast<double>(a.size());
        if (std::ranges::find(b, condition.name) != b.end()) contrast[i] = 1.0 / static_cast<double>(b.size());
        const std::string& level = condition.factors.at(comparison.factor);
        left[i] = level == comparison.a ? -0.5 : level == comparison.b ? 0.5 : 0.0;
    }
    std::vector<statistics::PeriodValue> values;
    std::size_t subjects = 0;
    for (const AnalysedSubject& subject : analysis.subjects) {
        if (!subject.excluded.empty()) continue;
        const std::vector<std::size_t> order = experiment::condition_order(protocol, subject.entry.row);
        if (order.size() != count)
            throw Error("the conditions are repeated: a period has no single condition before it");
        std::vector<statistics::PeriodValue> own;
        for (std::size_t period = 0; period < count; ++period)
            if (const auto value = value_of(protocol, subject, comparison.task, comparison.measure,
                                            protocol.conditions[order[period]].name))
                own.push_back({subjects, period, order[period], *value, period == 0 ? 0.0 : left[order[period - 1]]});
        if (std::ranges::any_of(subject.thresholds, [](const SubjectThreshold& t) { return t.beyond != Beyond::no; }))
            throw Error(fmt::format("a value of {} lies beyond the range", subject.entry.pseudonym));
        if (own.size() != count) continue;  // as the paired tests: subjects with all values
        values.insert(values.end(), own.begin(), own.end());
        ++subjects;
    }
    return statistics::carry_over(values, contrast);
}

/// The test with the marked trials treated the other way; none where no trial is marked.
std::optional<statistics::PairedTest> other_test(const ExperimentAnalysis& analysis,
                                                 const experiment::Comparison& comparison) {
    std::vector<double> differences;
    int marked = 0;
    for (const AnalysedSubject& subject : analysis.subjects) {
        if (!subject.excluded.empty()) continue;
        marked += subject.marked;
        const auto a = mean_over(analysis.protocol, subject, comparison, comparison.a, Marked::other),
                   b = mean_over(analysis.protocol, subject, comparison, comparison.b, Marked::other);
        if (a && b) differences.push_back(*b - *a);
        // With its marked trials a threshold may lie beyond the range: the others do not represent it.
        else if (analysis.protocol.is_psychophysics() && mean_over(analysis.protocol, subject, comparison, comparison.a) &&
                 mean_over(analysis.protocol, subject, comparison, comparison.b))
            return std::nullopt;
    }
    if (marked == 0) return std::nullopt;
    try {
        return statistics::paired_t(differences);
    } catch (const Error&) {
        return std::nullopt;  // too few are left, or all are equal
    }
}

AnalysedComparison compare(const ExperimentAnalysis& analysis, const experiment::Comparison& comparison,
                           const AnalysisSettings& settings) {
    const Protocol& protocol = analysis.protocol;
    AnalysedComparison result;
    result.of = comparison;
    result.is_log = is_log_measure(protocol, comparison.task, comparison.measure);
    result.label = fmt::format("{}{}: {} {} - {}{}", comparison.task.empty() ? "" : comparison.task + " ",
                               comparison.measure, comparison.factor, comparison.b, comparison.a,
                               comparison.within.empty() ? "" : fmt::format(" ({})", comparison.within));
    std::vector<bool> b_second;
    bool is_crossed = true;
    double bounds = 0.0;
    Beyond side = Beyond::no;
    for (const AnalysedSubject& subject : analysis.subjects) {
        if (!subject.excluded.empty()) continue;
        const auto a = bounded_mean(protocol, subject, comparison, comparison.a),
                   b = bounded_mean(protocol, subject, comparison, comparison.b);
        if (!a || !b) continue;
        bounds += b->value - a->value;
        if (a->beyond != Beyond::no || b->beyond != Beyond::no) {
            ++result.beyond;
            side = both(side, side_of_difference(a->beyond, b->beyond));
            continue;
        }
        result.subjects.push_back(subject.entry.pseudonym);
        result.differences.push_back(b->value - a->value);
        const double place_a = place_of(protocol, subject.entry.row, comparison, comparison.a),
                     place_b = place_of(protocol, subject.entry.row, comparison, comparison.b);
        if (place_a == place_b) is_crossed = false;
        b_second.push_back(place_b > place_a);
    }
    const std::size_t n = result.differences.size();
    if (analysis.is_rehearsal && (comparison.factor == "mode" || comparison.factor == "display")) {
        result.problem = "a rehearsal: without a haptic device and a registered display nothing is tested";
        return result;
    }
    if (result.beyond > 0) {
        // Values are missing because they are large or small: a mean of the others would be biased.
        const std::size_t all = n + result.beyond;
        result.problem = fmt::format("{} of {} subjects have a value beyond an end of the range", result.beyond, all);
        if (side != Beyond::unknown) result.bound = bounds / static_cast<double>(all);
        result.is_lower_bound = side == Beyond::above;
        return result;
    }
    if (n < 2) {
        result.problem = fmt::format("{} subject{} with both values", n, n == 1 ? "" : "s");
        return result;
    }
    try {
        result.test = statistics::paired_t(result.differences);
        result.permutation = statistics::permutation_test(result.differences, protocol.seed);
        result.effect_interval = statistics::standardised_interval(result.differences, 1.0 - 2.0 * protocol.alpha);
        if (comparison.margin) {
            result.equivalence =
                statistics::standardised_equivalence(result.differences, *comparison.margin, protocol.alpha);
            result.equivalence_power =
                statistics::power_of_standardised_equivalence(n, *comparison.margin, 0.0, protocol.alpha);
        }
        result.detectable = statistics::detectable_effect(n, 0.8, protocol.alpha);
    } catch (const Error& error) {
        result.problem = error.message();
        return result;
    }
    const auto seconds = std::ranges::count(b_second, true);
    if (is_crossed && n >= 4 && seconds >= 2 && n - static_cast<std::size_t>(seconds) >= 2) try {
            result.cross_over = statistics::cross_over(result.differences, b_second);
        } catch (const Error&) {  // equal differences within both orders: no period effect is stated
        }
    result.other_marked = other_test(analysis, comparison);
    if (settings.has_carry_over) try {
            result.carry_over = carry_over_of(analysis, comparison);
        } catch (const Error& error) {
            result.carry_over_problem = error.message();
        }
    return result;
}

GroupValue group_value(const ExperimentAnalysis& analysis, const std::string& task, const std::string& measure,
                       const std::string& condition) {
    GroupValue group{task, measure, condition, is_log_measure(analysis.protocol, task, measure)};
    std::vector<double> values;
    for (const AnalysedSubject& subject : analysis.subjects) {
        if (!subject.excluded.empty()) continue;
        if (const auto value = value_of(analysis.protocol, subject, task, measure, condition)) values.push_back(*value);
        const Beyond side = beyond_of(subject, condition);
        group.below += side == Beyond::below ? 1 : 0;
        group.above += side == Beyond::above ? 1 : 0;
        group.unknown += side == Beyond::unknown ? 1 : 0;
        group.marked += static_cast<std::size_t>(std::ranges::count_if(subject.records, [&](const TrialRecord& trial) {
            return is_data(trial) && !trial.marked.empty() && trial.task == task && trial.condition == condition;
        }));
    }
    const statistics::Moments of = statistics::moments(values);
    group.count = of.count;
    const double reach = of.count > 1 ? of.deviation / std::sqrt(static_cast<double>(of.count)) *
                                            statistics::student_quantile(0.975, static_cast<double>(of.count) - 1.0)
                                      : 0.0;
    const auto back = [&](double value) { return group.is_log ? std::exp(value) : value; };
    group.mean = back(of.mean);
    group.low = back(of.mean - reach);
    group.high = back(of.mean + reach);
    return group;
}

AnalysedSubject analyse_subject(const Protocol& protocol, const fs::path& folder, const experiment::SubjectEntry& entry,
                                const AnalysisSettings& settings) {
    AnalysedSubject subject;
    subject.entry = entry;
    subject.records = experiment::load_trials(folder / ("sub-" + entry.pseudonym) / "trials.jsonl");
    for (const TrialRecord& trial : subject.records) {
        subject.is_rehearsal = subject.is_rehearsal || trial.is_rehearsal;
        if (trial.phase == Phase::practice) continue;
        if (trial.phase == Phase::catch_trial) {
            ++subject.catch_trials;
            subject.catch_correct += trial.is_correct ? 1 : 0;
        }
        ++subject.trials;
        if (!trial.marked.empty()) {
            ++subject.marked;
            ++subject.marked_in[trial.condition];
        }
    }
    subject.excluded = exclusion_of(protocol, subject);
    if (protocol.is_psychophysics()) {
        for (std::size_t i = 0; i < protocol.conditions.size(); ++i)
            subject.thresholds.push_back(analyse_condition(protocol, subject, protocol.conditions[i].name, settings,
                                                           protocol.seed + 1000 * entry.row + i));
        for (SubjectThreshold& threshold : subject.thresholds)
            threshold.max_level_error = max_level_error_of(subject, threshold.condition);
    } else {
        analyse_tasks(protocol, subject);
    }
    return subject;
}

}  // namespace

std::optional<double> value_of(const Protocol& protocol, const AnalysedSubject& subject, const std::string& task,
                               const std::string& measure, const std::string& condition, Marked marked) {
    if (!protocol.is_psychophysics()) {
        const auto& means = marked == Marked::other ? subject.unmarked_means : subject.means;
        const auto found = means.find(key_of(task, measure, condition));
        return found == means.end() ? std::nullopt : std::optional(found->second);
    }
    for (const SubjectThreshold& one : subject.thresholds) {
        const std::optional<double>& threshold = marked == Marked::other ? one.with_marked : one.threshold;
        if (one.condition == condition && threshold)
            return protocol.stimulus->is_log ? std::log(*threshold) : *threshold;
    }
    return std::nullopt;
}

std::string unit_of(const Protocol& protocol, const std::string& task_name, const std::string& measure_name) {
    if (protocol.is_psychophysics()) return protocol.stimulus->level_unit();
    for (const experiment::Task& task : protocol.tasks)
        for (const experiment::Measure& measure : task.measures)
            if (task.name == task_name && measure.name == measure_name) return measure.unit;
    return {};
}

ExperimentAnalysis analyse_experiment(const fs::path& folder, const AnalysisSettings& settings) {
    ExperimentAnalysis analysis;
    analysis.protocol = frozen_protocol(folder);
    const experiment::ExperimentFile file = experiment::load_experiment_file(folder / "experiment.json");
    if (file.subjects.empty()) throw Error(fmt::format("{}: has no subjects", folder.string()));
    for (const experiment::SubjectEntry& entry : file.subjects) {
        analysis.subjects.push_back(analyse_subject(analysis.protocol, folder, entry, settings));
        const AnalysedSubject& subject = analysis.subjects.back();
        analysis.is_simulated = analysis.is_simulated || entry.is_simulated;
        if (!subject.excluded.empty()) continue;
        ++analysis.included;
        analysis.is_rehearsal = analysis.is_rehearsal || subject.is_rehearsal;
    }
    const Protocol& protocol = analysis.protocol;
    for (const experiment::Condition& condition : protocol.conditions) {
        if (protocol.is_psychophysics())
            analysis.groups.push_back(group_value(analysis, "", "threshold", condition.name));
        for (const experiment::Task& task : protocol.tasks)
            for (const experiment::Measure& measure : task.measures)
                analysis.groups.push_back(group_value(analysis, task.name, measure.name, condition.name));
    }
    std::vector<double> p;
    for (const experiment::Comparison& comparison : protocol.comparisons) {
        analysis.comparisons.push_back(compare(analysis, comparison, settings));
        // What cannot be tested counts as a comparison without effect, so that the others do not gain by it.
        const auto& test = analysis.comparisons.back().test;
        p.push_back(test ? test->p : 1.0);
    }
    const std::vector<double> adjusted = statistics::holm(p);
    for (std::size_t n = 0; n < adjusted.size(); ++n)
        if (analysis.comparisons[n].test) analysis.comparisons[n].adjusted_p = adjusted[n];
    return analysis;
}

TakeCheck check_takes(const fs::path& folder) {
    const Protocol protocol = frozen_protocol(folder);
    const experiment::ExperimentFile file = experiment::load_experiment_file(folder / "experiment.json");
    TakeCheck check;
    for (const experiment::SubjectEntry& entry : file.subjects) {
        const fs::path home = folder / ("sub-" + entry.pseudonym);
        for (const TrialRecord& trial : experiment::load_trials(home / "trials.jsonl")) {
            const fs::path take = home / trial.folder / "take";
            if (!fs::exists(take / "take.json")) continue;
            ++check.trials;
            std::size_t task = 0;
            while (task < protocol.tasks.size() && protocol.tasks[task].name != trial.task) ++task;
            const bool is_known = protocol.is_psychophysics()
                                      ? trial.rendered.size() <= protocol.stimulus->windows.size()
                                      : task < protocol.tasks.size();
            if (!is_known) {
                check.differences.push_back(
                    fmt::format("{} trial {}: is not of this protocol", entry.pseudonym, trial.number));
                continue;
            }
            if (protocol.is_psychophysics()) task = 0;
            const PortValues values = port_values_of(take, ports_of(protocol, task));
            const auto expect = [&](const std::string& name, double before, double now) {
                ++check.values;
                if (std::bit_cast<std::uint64_t>(before) != std::bit_cast<std::uint64_t>(now))
                    check.differences.push_back(fmt::format("{} trial {}: {} was {}, the take gives {}",
                                                            entry.pseudonym, trial.number, name, before, now));
            };
            if (protocol.is_psychophysics()) {
                const std::vector<double> now = rendered_of(protocol, trial, values);
                for (std::size_t i = 0; i < trial.rendered.size(); ++i)
                    expect(fmt::format("interval {}", i + 1), trial.rendered[i], now[i]);
            } else {
                for (const experiment::Measure& measure : protocol.tasks[task].measures)
                    if (const auto found = trial.measures.find(measure.name); found != trial.measures.end())
                        expect(measure.name, found->second, measure_of(measure, values));
            }
        }
    }
    return check;
}

std::string verdict_of(const AnalysedComparison& comparison, double alpha) {
    if (comparison.beyond > 0) return "not judged";
    if (!comparison.test) return "not tested";
    const bool is_effect = comparison.adjusted_p < alpha;
    const bool is_equivalent =
        comparison.equivalence && comparison.equivalence->verdict == statistics::Equivalence::equivalent;
    if (is_effect) return is_equivalent ? "effect within the margin" : "effect";
    return is_equivalent ? "equivalent" : "inconclusive";
}

}  // namespace tactus::analysis
