// SPDX-License-Identifier: Apache-2.0
#include "tools/report/experiment/experiment_result.hpp"

#include "dsp/core/units.hpp"
#include "tools/report/figures/experiment_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace tactus::report {

namespace {

using analysis::AnalysedComparison;
using analysis::AnalysedSubject;
using analysis::ExperimentAnalysis;
using analysis::GroupValue;
using analysis::MixedModel;
using analysis::SubjectThreshold;
using experiment::Protocol;
using Values = std::vector<std::pair<std::string, std::optional<double>>>;

constexpr std::size_t max_printed_thresholds = 24;  // in a terminal

std::string p_text(double p) { return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p); }

std::string with_unit(std::string text, const std::string& unit) { return unit.empty() ? text : text + " " + unit; }

/// Differences of a measure as they are shown.
struct DifferenceUnit {
    bool is_log = false;  ///< differences of logarithms have no unit
    std::string unit;
    double factor = 1.0;  ///< of the unit

    double shown(double difference) const { return is_log ? difference : difference / factor; }
    std::string text(double difference) const {
        return is_log ? fmt::format("×{:.3f}", std::exp(difference)) : fmt::format("{:.4g}", shown(difference));
    }
    std::string with_name(const std::string& number) const { return with_unit(number, is_log ? "" : unit); }
    std::string text(double value, double low, double high) const {
        return with_name(fmt::format("{} ({} to {})", text(value), text(low), text(high)));
    }
};

/// A comparison with the unit of its differences.
struct Compared : DifferenceUnit {
    const AnalysedComparison* of;
    const Protocol* protocol;

    bool is_tested() const { return of->test.has_value(); }
};

Compared compared(const AnalysedComparison& one, const Protocol& protocol) {
    const std::string unit = analysis::unit_of(protocol, one.of.task, one.of.measure);
    return {{one.is_log, unit, parse_unit(unit).factor}, &one, &protocol};
}

/// A number of a comparison that was tested.
template <class Read>
auto tested(Read read) {
    return [read](const Compared& c) { return c.is_tested() ? std::optional<double>(read(c)) : std::nullopt; };
}

const Fields<Compared>& equivalence_fields() {
    using C = Compared;
    static const Fields<C> all =
        Fields<C>("test of equivalence")
            .number("margin_sd", "", significant(3), [](const C& c) { return *c.of->of.margin; })
            .number("p", "", significant(4), [](const C& c) { return c.of->equivalence->p; })
            .number("low_sd", "", significant(4), [](const C& c) { return c.of->effect_interval.first; })
            .number("high_sd", "", significant(4), [](const C& c) { return c.of->effect_interval.second; })
            .number("power_without_effect", "", significant(3), [](const C& c) { return c.of->equivalence_power; });
    return all;
}

const Fields<Compared>& period_fields() {
    using C = Compared;
    static const Fields<C> all =
        Fields<C>("difference adjusted for the period, where both orders occur")
            .number("effect", "", significant(4), [](const C& c) { return c.shown(c.of->cross_over->period); })
            .number("p", "", significant(4), [](const C& c) { return c.of->cross_over->period_p; })
            .number("adjusted_difference", "", significant(4),
                    [](const C& c) { return c.shown(c.of->cross_over->effect); })
            .number("adjusted_low", "", significant(4), [](const C& c) { return c.shown(c.of->cross_over->low); })
            .number("adjusted_high", "", significant(4), [](const C& c) { return c.shown(c.of->cross_over->high); })
            .number("adjusted_p", "", significant(4), [](const C& c) { return c.of->cross_over->p; });
    return all;
}

const Fields<Compared>& carry_over_fields() {
    using C = Compared;
    static const Fields<C> all =
        Fields<C>("difference adjusted for periods and carry-over")
            .number("effect", "", significant(4), [](const C& c) { return c.shown(c.of->carry_over->carried); })
            .number("p", "", significant(4), [](const C& c) { return c.of->carry_over->carried_p; })
            .number("adjusted_difference", "", significant(4),
                    [](const C& c) { return c.shown(c.of->carry_over->effect); })
            .number("adjusted_low", "", significant(4), [](const C& c) { return c.shown(c.of->carry_over->low); })
            .number("adjusted_high", "", significant(4), [](const C& c) { return c.shown(c.of->carry_over->high); })
            .number("adjusted_p", "", significant(4), [](const C& c) { return c.of->carry_over->p; })
            .number("degrees_of_freedom", "", significant(4), [](const C& c) { return c.of->carry_over->freedom; })
            .number("variance_factor", "", significant(4),
                    [](const C& c) { return c.of->carry_over->variance_factor; });
    return all;
}

const Fields<Compared>& marked_fields() {
    using C = Compared;
    static const Fields<C> all =
        Fields<C>("the test with the marked trials treated the other way")
            .number("difference", "", significant(4), [](const C& c) { return c.shown(c.of->other_marked->of.mean); })
            .number("low", "", significant(4), [](const C& c) { return c.shown(c.of->other_marked->low); })
            .number("high", "", significant(4), [](const C& c) { return c.shown(c.of->other_marked->high); })
            .number("p", "", significant(4), [](const C& c) { return c.of->other_marked->p; });
    return all;
}

/// The member `read` of a comparison, if it has one.
template <class Read>
auto if_has(Read read) {
    return [read](const Compared& c) { return read(*c.of) ? &c : nullptr; };
}

const Fields<Compared>& comparison_fields() {
    using C = Compared;
    static const Fields<C> all =
        Fields<C>("comparison of two levels of a factor")
            .text("comparison", "comparison", [](const C& c) { return c.of->label; })
            .integer("subjects", "n", [](const C& c) { return c.of->differences.size(); })
            .flag("logarithms", "", [](const C& c) { return c.of->is_log; })
            .text("unit", "", [](const C& c) { return c.of->is_log ? std::string() : c.unit; })
            .number("difference", "", significant(4), tested([](const C& c) { return c.shown(c.of->test->of.mean); }))
            .number("low", "", significant(4), tested([](const C& c) { return c.shown(c.of->test->low); }))
            .number("high", "", significant(4), tested([](const C& c) { return c.shown(c.of->test->high); }))
            .number("deviation", "", significant(4),
                    tested([](const C& c) { return c.shown(c.of->test->of.deviation); }))
            .number("t", "", significant(4), tested([](const C& c) { return c.of->test->t; }))
            .number("degrees_of_freedom", "", significant(4), tested([](const C& c) { return c.of->test->freedom; }))
            .number("p", "", significant(4), tested([](const C& c) { return c.of->test->p; }))
            .number("p_permutation", "", significant(4), tested([](const C& c) { return c.of->permutation->p; }))
            .number("p_holm", "", significant(4), tested([](const C& c) { return c.of->adjusted_p; }))
            .integer("beyond_range", "", [](const C& c) { return c.of->beyond; })
            .number("at_least", "", significant(4),
                    [](const C& c) {
                        return c.of->is_lower_bound && c.of->bound ? std::optional(c.shown(*c.of->bound)) : std::nullopt;
                    })
            .number("at_most", "", significant(4),
                    [](const C& c) {
                        return !c.of->is_lower_bound && c.of->bound ? std::optional(c.shown(*c.of->bound))
                                                                    : std::nullopt;
                    })
            .number("effect_of_80_percent_power_sd", "", significant(4),
                    tested([](const C& c) { return c.of->detectable; }))
            .child("equivalence", "", equivalence_fields(),
                   if_has([](const AnalysedComparison& o) { return o.equivalence.has_value(); }))
            .child("period", "", period_fields(),
                   if_has([](const AnalysedComparison& o) { return o.cross_over.has_value(); }))
            .child("carry_over", "", carry_over_fields(),
                   if_has([](const AnalysedComparison& o) { return o.carry_over.has_value(); }))
            .omitted()
            .child("other_marked", "", marked_fields(),
                   if_has([](const AnalysedComparison& o) { return o.other_marked.has_value(); }))
            .omitted()
            .text("", "difference (95 %)",
                  [](const C& c) {
                      if (c.is_tested()) return c.text(c.of->test->of.mean, c.of->test->low, c.of->test->high);
                      if (c.of->beyond == 0) return "not tested: " + c.of->problem;
                      const std::string bound =
                          c.of->bound ? fmt::format("the difference is at {} {}", c.of->is_lower_bound ? "least" : "most",
                                                    c.with_name(c.text(*c.of->bound)))
                                      : "the difference has no bound";
                      return fmt::format("not judged: {}: {}", c.of->problem, bound);
                  })
            .text("", "p", [](const C& c) { return c.is_tested() ? p_text(c.of->test->p) : std::string(); })
            .text("", "permutation",
                  [](const C& c) { return c.is_tested() ? p_text(c.of->permutation->p) : std::string(); })
            .text("", "Holm", [](const C& c) { return c.is_tested() ? p_text(c.of->adjusted_p) : std::string(); })
            .text("", "equivalence",
                  [](const C& c) { return c.of->equivalence ? p_text(c.of->equivalence->p) : std::string(); })
            .text("verdict", "verdict", [](const C& c) { return analysis::verdict_of(*c.of, c.protocol->alpha); })
            .text("problem", "", [](const C& c) { return c.of->problem; });
    return all;
}

/// What a comparison could have shown, and how it changes with its adjustments.
std::vector<std::string> notes_of(const ExperimentAnalysis& analysis) {
    std::vector<std::string> notes;
    for (const AnalysedComparison& one : analysis.comparisons) {
        if (!one.test) continue;
        const Compared c = compared(one, analysis.protocol);
        const double found = one.detectable * one.test->of.deviation;
        std::string text = fmt::format(
            "{}: with {} subjects the t test finds {:.2f} standard deviations of the difference ({}) with 80 % power",
            one.label, one.differences.size(), one.detectable, c.with_name(c.text(found)));
        if (one.differences.size() < analysis.included)
            text += fmt::format("; {} of {} subjects have no value in one of the conditions",
                                analysis.included - one.differences.size(), analysis.included);
        if (one.of.margin)
            text += fmt::format(
                "; equivalence within {:.2g} standard deviations is shown in {:.0f} % of studies without an effect",
                *one.of.margin, 100.0 * one.equivalence_power);
        if (one.cross_over)
            text += fmt::format(
                "; period effect p {}, difference adjusted for it {}, p {}", p_text(one.cross_over->period_p),
                c.text(one.cross_over->effect, one.cross_over->low, one.cross_over->high), p_text(one.cross_over->p));
        notes.push_back(std::move(text));
        if (one.carry_over)
            notes.push_back(fmt::format(
                "{}: carry-over {}, p {}; difference adjusted for it {}, p {}; the adjustment widens the variance by "
                "{:.0f} %",
                one.label, c.text(one.carry_over->carried, one.carry_over->carried_low, one.carry_over->carried_high),
                p_text(one.carry_over->carried_p),
                c.text(one.carry_over->effect, one.carry_over->low, one.carry_over->high), p_text(one.carry_over->p),
                100.0 * (one.carry_over->variance_factor - 1.0)));
        if (!one.carry_over_problem.empty())
            notes.push_back(fmt::format("{}: no adjustment for carry-over: {}", one.label, one.carry_over_problem));
        if (one.other_marked)
            notes.push_back(
                fmt::format("{}: {} the marked trials {}, p {}", one.label,
                            analysis.protocol.is_psychophysics() ? "with" : "without",
                            c.text(one.other_marked->of.mean, one.other_marked->low, one.other_marked->high),
                            p_text(one.other_marked->p)));
    }
    return notes;
}

struct Group {
    const GroupValue* of;
    std::string unit;
    double factor = 1.0;
};

/// How many subjects the mean lacks because of the size of their values, and what it is then.
std::string beyond_text(const GroupValue& group) {
    if (!group.is_bound()) return {};
    const bool is_lower = group.below + group.unknown == 0, is_upper = group.above + group.unknown == 0;
    return fmt::format("{}{}", group.below + group.above + group.unknown,
                       group.count == 0 ? ""
                       : is_lower       ? ": the mean is a lower bound"
                       : is_upper       ? ": the mean is an upper bound"
                                        : ": the mean lacks them");
}

const Fields<Group>& group_fields() {
    using G = Group;
    const auto in_unit = [](double GroupValue::* member, std::size_t needed) {
        return [member, needed](const G& g) {
            const bool is_shown = g.of->count >= needed && (needed < 2 || !g.of->is_bound());
            return is_shown ? std::optional(g.of->*member / g.factor) : std::nullopt;
        };
    };
    static const Fields<G> all =
        Fields<G>("values of the group in one condition")
            .text("task", "task", [](const G& g) { return g.of->task; })
            .text("measure", "measure", [](const G& g) { return g.of->measure; })
            .text("condition", "condition", [](const G& g) { return g.of->condition; })
            .integer("subjects", "n", [](const G& g) { return g.of->count; })
            .number("mean", "mean", significant(4), in_unit(&GroupValue::mean, 1))
            .number("low", "", significant(4), in_unit(&GroupValue::low, 2))
            .number("high", "", significant(4), in_unit(&GroupValue::high, 2))
            .text("", "95 %",
                  [](const G& g) {
                      return g.of->count > 1 && !g.of->is_bound()
                                 ? fmt::format("{:.4g} to {:.4g}", g.of->low / g.factor, g.of->high / g.factor)
                                 : std::string();
                  })
            .text("unit", "unit", [](const G& g) { return g.unit; })
            .text("", "beyond the range", [](const G& g) { return beyond_text(*g.of); })
            .integer("below_range", "", [](const G& g) { return g.of->below; })
            .integer("above_range", "", [](const G& g) { return g.of->above; })
            .integer("side_unknown", "", [](const G& g) { return g.of->unknown; })
            .integer("marked", "marked trials", [](const G& g) { return g.of->marked; })
            .flag("geometric", "", [](const G& g) { return g.of->is_log; });
    return all;
}

/// A subject in one condition.
struct LevelOfSubject {
    std::string subject;
    const SubjectThreshold* of;
    const Protocol* protocol;
    double factor = 1.0;

    std::optional<double> shown(const std::optional<double>& level) const {
        return level ? std::optional(*level / factor) : std::nullopt;
    }
    /// Of a match, on the axis of the stimulus: of logarithms it has no unit.
    std::optional<double> deviation() const {
        if (!of->adjusted) return std::nullopt;
        return protocol->stimulus->is_log ? of->adjusted->deviation : of->adjusted->deviation / factor;
    }
    /// Mean match of a direction, in the unit of levels.
    std::optional<double> match(double psychophysics::AdjustedLevel::* member) const {
        return of->adjusted ? shown(protocol->stimulus->level_at((*of->adjusted).*member)) : std::nullopt;
    }
};

std::optional<double> low_of(const LevelOfSubject& t) {
    return t.of->interval && !t.of->is_low_beyond ? t.shown(t.of->interval->low) : std::nullopt;
}
std::optional<double> high_of(const LevelOfSubject& t) {
    return t.of->interval && !t.of->is_high_beyond ? t.shown(t.of->interval->high) : std::nullopt;
}

/// "0.2 to 0.4"; an end beyond the range comes from the prior, and has no number.
std::string interval_text(const LevelOfSubject& t) {
    if (!t.of->interval) return {};
    const auto end = [&](const std::optional<double>& level, double limit) {
        return level ? fmt::format("{:.4g}", *level) : fmt::format("beyond {:.4g}", *t.shown(limit));
    };
    return fmt::format("{} to {}", end(low_of(t), t.protocol->stimulus->min),
                       end(high_of(t), t.protocol->stimulus->max));
}

const Fields<LevelOfSubject>& subject_level_fields() {
    using T = LevelOfSubject;
    using psychophysics::AdjustedLevel;
    static const Fields<T> all =
        Fields<T>("threshold, or match by adjustment, of a subject in one condition")
            .text("subject", "subject", &T::subject)
            .text("condition", "condition", [](const T& t) { return t.of->condition; })
            .number("threshold", "", significant(4), [](const T& t) { return t.shown(t.of->threshold); })
            .text("", "level",
                  [](const T& t) {
                      return t.of->threshold ? fmt::format("{:.4g}", *t.shown(t.of->threshold)) : "not identified";
                  })
            .number("low", "", significant(4), low_of)
            .number("high", "", significant(4), high_of)
            .flag("low_beyond_range", "", [](const T& t) { return t.of->is_low_beyond; })
            .flag("high_beyond_range", "", [](const T& t) { return t.of->is_high_beyond; })
            .text("", "95 %", interval_text)
            .number("with_marked", "with marked trials", significant(4),
                    [](const T& t) { return t.shown(t.of->with_marked); })
            .number("slope", "slope", significant(3),
                    [](const T& t) { return t.of->fit ? std::optional(t.of->fit->function.slope) : std::nullopt; })
            .number("d_prime", "d′", significant(3), [](const T& t) { return t.of->d_prime; })
            .number("criterion", "criterion", significant(3), [](const T& t) { return t.of->criterion; })
            .number("from_below", "from below", significant(4),
                    [](const T& t) { return t.match(&AdjustedLevel::below); })
            .number("from_above", "from above", significant(4),
                    [](const T& t) { return t.match(&AdjustedLevel::above); })
            .number("match_deviation", "deviation", significant(3), [](const T& t) { return t.deviation(); })
            .number("max_level_error", "", significant(3), [](const T& t) { return t.of->max_level_error; })
            .text("problem", "problem", [](const T& t) { return t.of->problem; });
    return all;
}

struct Subject {
    const AnalysedSubject* of;
    const Protocol* protocol;
};

Values marked_in(const Subject& s) {
    Values all;
    for (const auto& [condition, count] : s.of->marked_in) all.emplace_back(condition, count);
    return all;
}

/// In the units of the protocol; logarithms have none.
Values means_of(const Subject& s) {
    Values all;
    for (const experiment::Task& task : s.protocol->tasks)
        for (const experiment::Measure& measure : task.measures)
            for (const experiment::Condition& condition : s.protocol->conditions) {
                const auto mean = analysis::value_of(*s.protocol, *s.of, task.name, measure.name, condition.name);
                const double factor = measure.is_log ? 1.0 : parse_unit(measure.unit).factor;
                if (mean)
                    all.emplace_back(fmt::format("{} {} {}", task.name, measure.name, condition.name), *mean / factor);
            }
    return all;
}

const Fields<Subject>& subject_fields() {
    using S = Subject;
    static const Fields<S> all =
        Fields<S>("a subject")
            .text("subject", "subject", [](const S& s) { return s.of->entry.pseudonym; })
            .integer("order_row", "order", [](const S& s) { return s.of->entry.row + 1; })
            .integer("trials", "trials", [](const S& s) { return s.of->trials; })
            .integer("marked", "marked", [](const S& s) { return s.of->marked; })
            .numbers("marked_in", marked_in)
            .text("", "catch trials correct",
                  [](const S& s) {
                      return s.of->catch_trials > 0 ? fmt::format("{} of {}", s.of->catch_correct, s.of->catch_trials)
                                                    : std::string();
                  })
            .text("excluded", "left out", [](const S& s) { return s.of->excluded; })
            .numbers("means", means_of);
    return all;
}

/// A fitted model with the unit of its comparison.
struct Modelled : DifferenceUnit {
    const MixedModel* of;

    std::optional<double> shown_if(const std::optional<double>& difference) const {
        return difference ? std::optional(shown(*difference)) : std::nullopt;
    }
};

const Fields<Modelled>& model_fields() {
    using M = Modelled;
    static const Fields<M> all =
        Fields<M>("mixed model of a comparison, by R with lmerTest")
            .text("comparison", "comparison", [](const M& m) { return m.of->label; })
            .integer("values", "values", [](const M& m) { return m.of->values; })
            .number("difference", "", significant(4), [](const M& m) { return m.shown_if(m.of->effect); })
            .number("low", "", significant(4), [](const M& m) { return m.shown_if(m.of->low); })
            .number("high", "", significant(4), [](const M& m) { return m.shown_if(m.of->high); })
            .text("", "difference (95 %)",
                  [](const M& m) {
                      return m.of->effect && m.of->low && m.of->high
                                 ? m.text(*m.of->effect, *m.of->low, *m.of->high)
                                 : std::string();
                  })
            .number("degrees_of_freedom", "df", fixed(1), [](const M& m) { return m.of->freedom; })
            .number("p", "", significant(4), [](const M& m) { return m.of->p; })
            .text("", "p", [](const M& m) { return m.of->p ? p_text(*m.of->p) : std::string(); })
            .number("subject_deviation", "", significant(4),
                    [](const M& m) { return m.shown_if(m.of->subject_deviation); })
            .number("effect_deviation", "", significant(4), [](const M& m) { return m.shown_if(m.of->effect_deviation); })
            .number("residual_deviation", "", significant(4),
                    [](const M& m) { return m.shown_if(m.of->residual_deviation); })
            .text("formula", "formula", [](const M& m) { return m.of->formula; })
            .text("note", "note", [](const M& m) { return m.of->note; });
    return all;
}

struct Mixed {
    const analysis::MixedModels* of;
    const ExperimentAnalysis* analysis;
};

const Fields<Mixed>& mixed_fields() {
    using M = Mixed;
    static const Fields<M> all =
        Fields<M>("mixed models by R")
            .titled([](const M&) { return "Mixed models"; })
            .warnings("problem",
                      [](const M& m) {
                          return m.of->problem.empty() ? std::vector<std::string>() : std::vector{m.of->problem};
                      })
            .rows("models", "models", model_fields(), [](const M& m) {
                std::vector<Modelled> models;
                for (const MixedModel& one : m.of->models)
                    for (const AnalysedComparison& comparison : m.analysis->comparisons)
                        if (comparison.label == one.label) {
                            models.push_back({compared(comparison, m.analysis->protocol), &one});
                            break;
                        }
                return models;
            });
    return all;
}

/// A figure of one measure, drawn when a format shows it: what it needs lives as long as the analysis.
Result figure_of(const ExperimentAnalysis& analysis, const std::string& task, const std::string& measure) {
    Result result;
    result.entries.push_back(
        {"", "Blue: subjects. Orange: mean with its interval of 95 %, of logarithms where the axis is logarithmic",
         false, Severity::none, ResultEntry::Picture{[&analysis, task, measure](const FigureStyle&) {
             return draw_group(analysis, task, measure);
         }}});
    return result;
}

std::vector<std::string> warnings_of(const FoundExperiment& f) {
    std::vector<std::string> all;
    if (f.analysis->is_simulated)
        all.emplace_back(
            "simulated data: some or all subjects are models; this shows that the experiment and its analysis "
            "work, and nothing about people");
    if (f.analysis->is_rehearsal)
        all.emplace_back("rehearsal: some sessions had no haptic device or no registered display");
    const AnalysedSubject* first = nullptr;
    for (const AnalysedSubject& subject : f.analysis->subjects) {
        if (!subject.excluded.empty()) continue;
        if (!first) first = &subject;
        if (subject.entry.settings == first->entry.settings) continue;
        all.push_back(fmt::format("{} and {} differ in --set or --asset: the group mixes them", first->entry.pseudonym,
                                  subject.entry.pseudonym));
        break;
    }
    for (const AnalysedSubject& subject : f.analysis->subjects)
        if (!subject.excluded.empty())
            all.push_back(fmt::format("{} is left out: {}", subject.entry.pseudonym, subject.excluded));
    for (const AnalysedSubject& subject : f.analysis->subjects)
        for (const SubjectThreshold& one : subject.thresholds)
            if (subject.excluded.empty() && !one.problem.empty())
                all.push_back(fmt::format("{} in '{}': not identified: {}", subject.entry.pseudonym, one.condition,
                                          one.problem));
    return all;
}

std::vector<std::string> meanings_of(const FoundExperiment& f) {
    const Protocol& protocol = f.analysis->protocol;
    std::vector<std::string> all;
    if (!protocol.comparisons.empty())
        all.insert(
            all.end(),
            {"Paired t tests, two-sided; permutation tests flip signs. Holm's adjustment is over all comparisons of "
             "the "
             "table. Equivalence: the t statistic against the non-central t at the margin that the protocol states.",
             "Inconclusive means that neither an effect nor its absence was shown."});
    if (protocol.is_adjustment())
        all.emplace_back(
            "Level: mean of the matches from below and from above. Deviation: of a match about the mean of its "
            "direction, on the axis of the stimulus.");
    else if (protocol.is_psychophysics())
        all.push_back(fmt::format(
            "Level with a probability of {:.3g}. {}", protocol.method.target,
            protocol.method.kind == experiment::Method::Kind::constant
                ? "Maximum of the likelihood; intervals: parametric bootstrap."
                : "Median of the posterior, intervals: its quantiles. The prior is uniform over the axis, over half of it "
                  "more at each end, and over slopes from the least of the protocol to four times its greatest; the "
                  "posterior does not depend on the rule that chose the levels."));
    const bool has_carry_over = std::ranges::any_of(
        f.analysis->comparisons, [](const AnalysedComparison& one) { return one.carry_over.has_value(); });
    if (f.mixed)
        all.push_back(fmt::format(
            "The mixed model uses {} of the conditions of its comparison, also of subjects who lack others{}. A carry-over "
            "term is coded by the factor's level in the previous period and is 0 in the first.",
            protocol.is_psychophysics() ? "one threshold of each subject" : "each trial",
            protocol.is_psychophysics() ? ""
                                        : ", and has the spread of the effect between subjects as a term of its own where "
                                          "they have several trials of each level"));
    if (f.mixed || has_carry_over) {
        all.insert(all.end(),
                   {"The paired test estimates the mean difference of the subjects that have a value in each of its "
                    "conditions; its error is the spread of this one difference. The adjustment for the period "
                    "averages both orders with equal weights.",
                    "The carry-over model is least squares on the same means of all conditions: subject + period + "
                    "condition + carry-over. Its error is one residual, pooled over all conditions and effects, with "
                    "more degrees of freedom; the spread of the effect between subjects is part of that residual.",
                    "Without carry-over their expectations agree for complete, balanced data; the estimates of one study "
                    "need not. They differ more where subjects lack values, orders are not balanced, or the spread of "
                    "this difference is not that of the others. If they lead to different verdicts, the paired test is "
                    "the one that the protocol states beforehand."});
    }
    return all;
}

}  // namespace

const Fields<FoundExperiment>& experiment_fields() {
    using F = FoundExperiment;
    static const Fields<F> all =
        Fields<F>("analysis of an experiment")
            .titled([](const F& f) { return f.analysis->protocol.title; })
            .warnings("warnings", warnings_of)
            .text("experiment", "", [](const F& f) { return f.analysis->protocol.name; })
            .text("", "experiment", [](const F& f) { return f.analysis->protocol.about; })
            .on_pages()
            .flag("simulated", "", [](const F& f) { return f.analysis->is_simulated; })
            .flag("rehearsal", "", [](const F& f) { return f.analysis->is_rehearsal; })
            .integer("included", "", [](const F& f) { return f.analysis->included; })
            .text("", "subjects in the group",
                  [](const F& f) { return fmt::format("{} of {}", f.analysis->included, f.analysis->subjects.size()); })
            .rows("groups", "group", group_fields(),
                  [](const F& f) {
                      std::vector<Group> groups;
                      for (const GroupValue& one : f.analysis->groups) {
                          const std::string unit = analysis::unit_of(f.analysis->protocol, one.task, one.measure);
                          groups.push_back({&one, unit, parse_unit(unit).factor});
                      }
                      return groups;
                  })
            .rows("comparisons", "comparisons", comparison_fields(),
                  [](const F& f) {
                      std::vector<Compared> comparisons;
                      for (const AnalysedComparison& one : f.analysis->comparisons)
                          comparisons.push_back(compared(one, f.analysis->protocol));
                      return comparisons;
                  })
            .figure(
                "Differences of the comparisons",
                [](const F& f) {
                    return std::ranges::any_of(f.analysis->comparisons,
                                               [](const AnalysedComparison& one) { return one.test.has_value(); });
                },
                [](const F& f) { return draw_effects(*f.analysis); })
            .notes("", "what this number of subjects can show", [](const F& f) { return notes_of(*f.analysis); })
            .child("mixed_models", "mixed models", mixed_fields(),
                   [](const F& f) { return f.mixed ? std::optional(Mixed{&*f.mixed, f.analysis}) : std::nullopt; })
            .omitted()
            .sections("figures",
                      [](const F& f) {
                          ResultEntry::Children figures{{}, true};
                          const Protocol& protocol = f.analysis->protocol;
                          if (protocol.is_psychophysics())
                              figures.results.push_back(figure_of(*f.analysis, "", "threshold"));
                          for (const experiment::Task& task : protocol.tasks)
                              for (const experiment::Measure& measure : task.measures)
                                  figures.results.push_back(figure_of(*f.analysis, task.name, measure.name));
                          return figures;
                      })
            .on_pages()
            .figure(
                "Answers of each subject, and fitted functions",
                [](const F& f) {
                    return f.analysis->protocol.is_psychophysics() && !f.analysis->protocol.is_adjustment();
                },
                [](const F& f) { return draw_psychometric(*f.analysis); })
            .figure(
                "Matches of each subject", [](const F& f) { return f.analysis->protocol.is_adjustment(); },
                [](const F& f) { return draw_matches(*f.analysis); })
            .rows("thresholds", "thresholds", subject_level_fields(),
                  [](const F& f) {
                      std::vector<LevelOfSubject> thresholds;
                      const Protocol& protocol = f.analysis->protocol;
                      for (const AnalysedSubject& subject : f.analysis->subjects)
                          for (const SubjectThreshold& one : subject.thresholds)
                              thresholds.push_back({subject.entry.pseudonym, &one, &protocol,
                                                    parse_unit(protocol.stimulus->level_unit()).factor});
                      return thresholds;
                  })
            .printed([](const F& f) {
                std::size_t rows = 0;
                for (const AnalysedSubject& subject : f.analysis->subjects) rows += subject.thresholds.size();
                return rows > max_printed_thresholds ? Where::pages : Where::everywhere;
            })
            .text("level_unit", "",
                  [](const F& f) {
                      return f.analysis->protocol.stimulus ? f.analysis->protocol.stimulus->level_unit()
                                                           : std::string();
                  })
            .rows("subjects", "subjects", subject_fields(),
                  [](const F& f) {
                      std::vector<Subject> subjects;
                      for (const AnalysedSubject& one : f.analysis->subjects)
                          subjects.push_back({&one, &f.analysis->protocol});
                      return subjects;
                  })
            .on_pages()
            .notes("", "how to read the tests", meanings_of)
            .on_pages();
    return all;
}

}  // namespace tactus::report
