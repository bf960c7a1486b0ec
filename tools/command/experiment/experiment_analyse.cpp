// SPDX-License-Identifier: Apache-2.0
// tactus experiment analyse: tables, tests and a report.
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/units.hpp"
#include "tools/analysis/experiment/analysis.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/experiment_page.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace tactus::command {

namespace {

using file::Json;

struct AnalyseChoice {
    std::filesystem::path folder;
    int bootstrap = 499;
    bool json = false, checks_takes = false;
};

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json comparison_result(const analysis::AnalysedComparison& one, double alpha) {
    Json json{{"comparison", one.label},
              {"subjects", one.differences.size()},
              {"logarithms", one.is_log},
              {"verdict", analysis::verdict_of(one, alpha)},
              {"problem", one.problem}};
    if (!one.test) return json;
    json.update({{"difference", one.test->of.mean},
                 {"low", one.test->low},
                 {"high", one.test->high},
                 {"deviation", one.test->of.deviation},
                 {"t", one.test->t},
                 {"degrees_of_freedom", one.test->freedom},
                 {"p", one.test->p},
                 {"p_permutation", one.permutation->p},
                 {"p_holm", one.adjusted_p},
                 {"effect_of_80_percent_power_sd", one.detectable}});
    if (one.equivalence)
        json["equivalence"] = {{"margin_sd", *one.of.margin},
                               {"p", one.equivalence->p},
                               {"low_sd", one.effect_interval.first},
                               {"high_sd", one.effect_interval.second},
                               {"power_without_effect", one.equivalence_power}};
    if (one.cross_over)
        json["period"] = {{"effect", one.cross_over->period},
                          {"p", one.cross_over->period_p},
                          {"adjusted_difference", one.cross_over->effect},
                          {"adjusted_low", one.cross_over->low},
                          {"adjusted_high", one.cross_over->high},
                          {"adjusted_p", one.cross_over->p}};
    return json;
}

Json analysis_json(const analysis::ExperimentAnalysis& analysis) {
    Json json{{"experiment", analysis.protocol.name},
              {"simulated", analysis.is_simulated},
              {"rehearsal", analysis.is_rehearsal},
              {"included", analysis.included},
              {"subjects", Json::array()},
              {"groups", Json::array()},
              {"comparisons", Json::array()}};
    for (const analysis::AnalysedSubject& subject : analysis.subjects) {
        Json one{{"subject", subject.entry.pseudonym},
                 {"trials", subject.trials},
                 {"marked", subject.marked},
                 {"marked_in", subject.marked_in},
                 {"excluded", subject.excluded},
                 {"thresholds", Json::array()},
                 {"means", subject.means}};
        for (const analysis::SubjectThreshold& threshold : subject.thresholds)
            one["thresholds"].push_back(
                {{"condition", threshold.condition},
                 {"threshold", optional_number(threshold.threshold)},
                 {"low", optional_number(threshold.interval ? std::optional(threshold.interval->low) : std::nullopt)},
                 {"high", optional_number(threshold.interval ? std::optional(threshold.interval->high) : std::nullopt)},
                 {"with_marked", optional_number(threshold.with_marked)},
                 {"slope", threshold.fit ? Json(threshold.fit->function.slope) : Json()},
                 {"d_prime", optional_number(threshold.d_prime)},
                 {"criterion", optional_number(threshold.criterion)},
                 {"max_level_error", threshold.max_level_error}});
        json["subjects"].push_back(one);
    }
    for (const analysis::GroupValue& group : analysis.groups)
        json["groups"].push_back({{"task", group.task},
                                  {"measure", group.measure},
                                  {"condition", group.condition},
                                  {"subjects", group.count},
                                  {"mean", group.count > 0 ? Json(group.mean) : Json()},
                                  {"low", group.count > 1 ? Json(group.low) : Json()},
                                  {"high", group.count > 1 ? Json(group.high) : Json()},
                                  {"geometric", group.is_log}});
    for (const analysis::AnalysedComparison& one : analysis.comparisons)
        json["comparisons"].push_back(comparison_result(one, analysis.protocol.alpha));
    return json;
}

/// Unit in which a measure or threshold is shown.
std::string unit_of(const experiment::Protocol& protocol, const std::string& task_name,
                    const std::string& measure_name) {
    if (protocol.is_psychophysics()) return protocol.stimulus->level_unit();
    for (const experiment::Task& task : protocol.tasks)
        for (const experiment::Measure& measure : task.measures)
            if (task.name == task_name && measure.name == measure_name) return measure.unit;
    return {};
}

std::string p_value(double p) { return p < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", p); }

std::string analysis_text(const analysis::ExperimentAnalysis& analysis) {
    std::string out = fmt::format("{}{}\n{} of {} in the group\n", analysis.protocol.title,
                                  analysis.is_simulated   ? " (SIMULATED DATA)"
                                  : analysis.is_rehearsal ? " (REHEARSAL)"
                                                          : "",
                                  analysis.included, counted(analysis.subjects.size(), "subject"));
    for (const analysis::AnalysedSubject& subject : analysis.subjects)
        if (!subject.excluded.empty())
            out += fmt::format("  {} is left out: {}\n", subject.entry.pseudonym, subject.excluded);
    for (const analysis::GroupValue& group : analysis.groups) {
        if (group.count == 0) {
            out += fmt::format("{}{}, {}: no values\n", group.task.empty() ? "" : group.task + " ", group.measure,
                               group.condition);
            continue;
        }
        const std::string unit = unit_of(analysis.protocol, group.task, group.measure);
        const double factor = parse_unit(unit).factor;
        const std::string interval = group.count > 1
                                         ? fmt::format(" ({:.4g} to {:.4g})", group.low / factor, group.high / factor)
                                         : std::string();
        out += fmt::format(
            "{:<36} {:>9.4g}{}{}, n = {}\n",
            fmt::format("{}{}, {}", group.task.empty() ? "" : group.task + " ", group.measure, group.condition),
            group.mean / factor, interval, unit.empty() ? "" : " " + unit, group.count);
    }
    for (const analysis::AnalysedComparison& one : analysis.comparisons) {
        if (!one.test) {
            out += fmt::format("{}: not tested: {}\n", one.label, one.problem);
            continue;
        }
        const std::string unit = unit_of(analysis.protocol, one.of.task, one.of.measure);
        const double factor = parse_unit(unit).factor;
        const auto back = [&](double value) {
            return one.is_log ? fmt::format("x{:.3f}", std::exp(value)) : fmt::format("{:.4g}", value / factor);
        };
        out += fmt::format("{}: {} ({} to {}){}, p {}, Holm {}, permutation {}{}: {}\n", one.label,
                           back(one.test->of.mean), back(one.test->low), back(one.test->high),
                           one.is_log || unit.empty() ? "" : " " + unit, p_value(one.test->p), p_value(one.adjusted_p),
                           p_value(one.permutation->p),
                           one.equivalence ? ", equivalence " + p_value(one.equivalence->p) : std::string(),
                           analysis::verdict_of(one, analysis.protocol.alpha));
    }
    return out;
}

int analyse(const AnalyseChoice& choice) {
    const analysis::ExperimentAnalysis analysis = analysis::analyse_experiment(choice.folder, {choice.bootstrap});
    analysis::write_bids(analysis, choice.folder);
    const Json json = analysis_json(analysis);
    file::write_whole_file(choice.folder / "results.json", json.dump(2) + "\n");
    file::write_whole_file(choice.folder / "report.html", report::experiment_page(analysis));
    say(stdout, choice.json ? json.dump(2) + "\n" : analysis_text(analysis));
    if (!choice.checks_takes) {
        if (!choice.json) say(stdout, fmt::format("report: {}\n", (choice.folder / "report.html").string()));
        return done;
    }
    const analysis::TakeCheck check = analysis::check_takes(choice.folder);
    for (const std::string& difference : check.differences) say(stderr, fmt::format("tactus: {}\n", difference));
    if (!choice.json)
        say(stdout, fmt::format("takes: {} of {} computed again, {}\n", counted(check.values, "value"),
                                counted(check.trials, "trial"),
                                check.differences.empty() ? std::string("all equal to the bit")
                                                          : fmt::format("{} differ", check.differences.size())));
    return check.differences.empty() ? done : answer_is_no;
}

Action declare_experiment_analyse(VerbOptions& verb) {
    const auto choice = std::make_shared<AnalyseChoice>();
    verb.add("folder", choice->folder, "folder of the experiment's data").required();
    verb.add("--bootstrap", choice->bootstrap, "samples for the intervals of thresholds; 0: none")
        .range(0, 100'000)
        .shows_default();
    verb.flag("--takes", choice->checks_takes, "compute all measures again from the takes, and compare to the bit");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return analyse(*choice); };
}

}  // namespace

Verb experiment_analyse_verb() {
    return {"analyse", "analyse an experiment: tables (BIDS), tests, equivalence, and a report as HTML",
            declare_experiment_analyse};
}

}  // namespace tactus::command
