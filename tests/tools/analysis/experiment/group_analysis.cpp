// SPDX-License-Identifier: Apache-2.0
// What the analysis makes of a group: known effects, carry-over, marked trials, mixed models, and the tables of BIDS. The trials are
// written as a session writes them; nothing is rendered.
#include "tools/analysis/experiment/analysis.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/mixed_models.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/psychophysics/posterior.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/json_schema.hpp"
#include "tools/report/experiment/experiment_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::analysis;
using experiment::TrialRecord;
namespace fs = std::filesystem;

namespace {

const experiment::Protocol& co_location_study() {
    static const experiment::Protocol protocol =
        experiment::load_protocol(test::source_folder() / "assets/library/experiments/co-location.toml");
    return protocol;
}

struct StudyModel {
    double time = 1.25;  ///< factor of the offset mode on the labyrinth
    double left_behind = 1.0;  ///< factor of the offset mode on the labyrinth of the next period
    std::function<void(TrialRecord&, std::size_t subject)> change{};
    bool has_one_order = false;  ///< all subjects have that of the first
};

/// A study of the protocol's orders. Distances do not depend on the mode.
void write_study(const fs::path& out, std::size_t subjects, const StudyModel& model, std::uint64_t seed = 1) {
    const experiment::Protocol& protocol = co_location_study();
    ExperimentFolder folder(out, protocol);
    for (std::size_t s = 0; s < subjects; ++s) {
        experiment::SubjectEntry entry = folder.enrol(fmt::format("S{:02}", s + 1), true);
        entry.is_complete = true;
        if (model.has_one_order) entry.row = 0;
        folder.update(entry);
        const Random person{mix(seed) ^ mix(s + 1)};
        std::vector<TrialRecord> trials;
        const auto order = experiment::condition_order(protocol, entry.row);
        const auto tasks = experiment::task_order(protocol, entry.row);
        for (std::size_t period = 0; period < order.size(); ++period)
            for (std::size_t place = 0; place < tasks.size(); ++place) {
                const experiment::Task& task = protocol.tasks[tasks[place]];
                TrialRecord trial;
                trial.number = static_cast<int>(trials.size()) + 1;
                trial.block = static_cast<int>(period * tasks.size() + place);
                trial.condition = protocol.conditions[order[period]].name;
                trial.task = task.name;
                trial.folder = fmt::format("trial-{:04}", trial.number);
                trial.is_simulated = true;
                const bool is_offset = order[period] % 2 == 1, was_offset = period > 0 && order[period - 1] % 2 == 1;
                const auto noise = [&](std::uint64_t of) { return person.normal(1000 * of + period * 10 + place); };
                if (task.name == "labyrinth")
                    trial.measures["time"] = 30.0 * std::exp(0.2 * person.normal(1) + 0.08 * noise(1)) *
                                             (is_offset ? model.time : 1.0) * (was_offset ? model.left_behind : 1.0);
                else trial.measures["distance"] = (4.0 + 0.5 * person.normal(2) + 0.4 * noise(2)) * mm;
                if (task.name == "cube") trial.measures["time"] = 20.0 * std::exp(0.1 * noise(3));
                if (task.name == "spiral") {
                    trial.measures["beside"] = (2.0 + 0.2 * noise(4)) * mm;
                    trial.measures["lag"] = 0.1 + 0.02 * noise(5);
                }
                if (model.change) model.change(trial, s);
                trials.push_back(std::move(trial));
            }
        fs::create_directories(folder.subject_folder(entry.pseudonym));
        experiment::save_trials(trials, folder.subject_folder(entry.pseudonym) / "trials.jsonl");
    }
}

const AnalysedComparison& comparison_of(const ExperimentAnalysis& analysis, const std::string& label) {
    for (const AnalysedComparison& one : analysis.comparisons)
        if (one.label.find(label) == 0) return one;
    FAIL("no comparison '" << label << "'");
    throw;
}

bool has_lmer_test() { return std::system("Rscript --vanilla -e 'library(lmerTest)' > /dev/null 2>&1") == 0; }

std::vector<std::vector<std::string>> rows_of(const fs::path& table) {
    std::istringstream lines(file::read_whole_file(table));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream cells(line + "\t");
        for (std::string cell; std::getline(cells, cell, '\t');) rows.back().push_back(cell);
    }
    return rows;
}

}  // namespace

TEST_CASE("an effect of co-location on time and none on accuracy come back as effect and as equivalence") {
    const run::ScratchFolder scratch;
    write_study(scratch.path() / "data", 16, {});
    const ExperimentAnalysis analysis = analyse_experiment(scratch.path() / "data", {.bootstrap = 0});
    CHECK(analysis.included == 16);
    for (const char* label :
         {"labyrinth time: mode offset - co-located (mirror)", "labyrinth time: mode offset - co-located (HOE)"}) {
        const AnalysedComparison& time = comparison_of(analysis, label);
        REQUIRE(time.test);
        CHECK(time.is_log);
        CHECK(verdict_of(time, 0.05) == "effect");
        CHECK(std::exp(time.test->low) < 1.25);
        CHECK(std::exp(time.test->high) > 1.25);
    }
    for (const char* label : {"cube distance", "spiral distance"}) {
        const AnalysedComparison& distance = comparison_of(analysis, label);
        REQUIRE(distance.equivalence);
        CHECK(verdict_of(distance, 0.05) == "equivalent");
        CHECK(distance.equivalence_power >= 0.9);
    }
}

TEST_CASE("carry-over is an option that finds what the mode before left behind") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    write_study(data, 16, {.left_behind = 1.2});
    CHECK_FALSE(comparison_of(analyse_experiment(data, {.bootstrap = 0}), "labyrinth").carry_over);
    const ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0, .has_carry_over = true});
    const AnalysedComparison& distance = comparison_of(analysis, "cube distance");
    REQUIRE(distance.carry_over);
    CHECK(distance.carry_over->variance_factor == Approx(11.0 / 7.0));
    CHECK(distance.carry_over->carried_p > 0.01);
    const AnalysedComparison& time = comparison_of(analysis, "labyrinth time: mode offset - co-located (mirror)");
    REQUIRE(time.carry_over);
    CHECK(std::exp(time.carry_over->carried) == Approx(1.2).epsilon(0.1));
    CHECK(time.carry_over->carried_p < 0.01);
    CHECK(std::exp(time.carry_over->effect) == Approx(1.25).epsilon(0.1));
}

TEST_CASE("where trials are marked, each comparison is tested with and without them") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    CHECK_FALSE([&] {
        write_study(data, 8, {});
        return comparison_of(analyse_experiment(data, {.bootstrap = 0}), "cube distance").other_marked.has_value();
    }());
    StudyModel model;
    // A late trial of three subjects, with an error of 40 mm.
    model.change = [](TrialRecord& trial, std::size_t subject) {
        if (subject > 2 || trial.task != "cube" || trial.condition != "mirrorBeside") return;
        trial.measures["distance"] = 40.0 * mm;
        trial.marked = "a gap of 9 ms";
    };
    write_study(scratch.path() / "marked", 8, model);
    const ExperimentAnalysis analysis = analyse_experiment(scratch.path() / "marked", {.bootstrap = 0});
    const AnalysedComparison& distance = comparison_of(analysis, "cube distance");
    REQUIRE(distance.other_marked);
    CHECK(distance.test->of.count == 8);
    CHECK(distance.test->of.mean > 5.0 * mm);
    CHECK(distance.other_marked->of.count == 5);
    CHECK(std::abs(distance.other_marked->of.mean) < 1.0 * mm);
    for (const GroupValue& group : analysis.groups)
        if (group.task == "cube") CHECK(group.marked == (group.condition == "mirrorBeside" ? 3 : 0));
}

TEST_CASE("results of an experiment follow their schema, with all parts and with none") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    write_study(data, 8, {});
    const file::Json schema = report::schema_of_output({report::experiment_fields().schema()});
    for (const bool has_all : {false, true}) {
        const ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0, .has_carry_over = has_all});
        report::FoundExperiment found{&analysis, {}};
        if (has_all) {
            found.mixed.emplace();
            found.mixed->problem = "no R";
        }
        const report::Result result = report::experiment_fields().of(found);
        nlohmann::json results = nlohmann::json::parse(report::output_json(result).dump());
        const nlohmann::json rules = nlohmann::json::parse(schema.dump());
        CHECK(test::broken_rule(rules, results, "results") == "");
        REQUIRE(results["comparisons"].size() == analysis.comparisons.size());
        for (std::size_t i = 0; i < analysis.comparisons.size(); ++i)
            CHECK(results["comparisons"][i]["verdict"].get<std::string>() ==
                  verdict_of(analysis.comparisons[i], analysis.protocol.alpha));
        // The schema describes each part: it refuses one without a number, and one with a number more.
        for (const char* part : {"comparisons", "groups", "subjects"}) {
            nlohmann::json without = results, more = results;
            without[part][0].erase(part == std::string("subjects") ? "trials" : "subjects");
            more[part][0]["surplus"] = 1;
            CHECK(test::broken_rule(rules, without, "results") != "");
            CHECK(test::broken_rule(rules, more, "results") != "");
        }
        const std::string text = report::text_of(result);
        CHECK(text.find("simulated data") != std::string::npos);
        for (const AnalysedComparison& one : analysis.comparisons)
            CHECK(text.find(verdict_of(one, analysis.protocol.alpha)) != std::string::npos);
        CHECK((text.find("widens the variance by 57 %") != std::string::npos) == has_all);
        CHECK((text.find("no R") != std::string::npos) == has_all);
        CHECK(report::html_of(result).find("<svg") != std::string::npos);
    }
}

TEST_CASE("without R the data and the script of mixed models are written, and the result states that R is absent") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    write_study(data, 8, {});
    const ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0});
    const std::string path = std::getenv("PATH");
    setenv("PATH", scratch.path().c_str(), 1);
    const std::atomic<bool> never{false};
    const MixedModels models = fit_mixed_models(analysis, data, true, never);
    setenv("PATH", path.c_str(), 1);
    CHECK(models.problem.find("apt install r-base-core r-cran-lmertest") != std::string::npos);
    CHECK(models.models.empty());
    const auto rows = rows_of(data / "mixed/data.tsv");
    // 8 subjects, 4 conditions, 6 measures.
    REQUIRE(rows.size() == 1 + 8 * 4 * 6);
    for (const auto& row : rows) CHECK(row.size() == rows.front().size());
    const std::string script = file::read_whole_file(data / "mixed/model.R");
    CHECK(script.find("effect * factor.display + period + before") != std::string::npos);
    // What names the subjects goes with them.
    ExperimentFolder folder(data);
    folder.withdraw("S01");
    CHECK_FALSE(fs::exists(data / "mixed"));
}

TEST_CASE("mixed models of R give the paired difference of a balanced study, and its error", "[long]") {
    if (!has_lmer_test()) return test::skip("no R with lmerTest here");
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    write_study(data, 16, {});
    const ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0});
    const std::atomic<bool> never{false};
    const MixedModels mixed = fit_mixed_models(analysis, data, false, never);
    CHECK(mixed.problem.empty());
    REQUIRE(mixed.models.size() == analysis.comparisons.size());
    for (std::size_t i = 0; i < mixed.models.size(); ++i) {
        const MixedModel& model = mixed.models[i];
        const AnalysedComparison& comparison = analysis.comparisons[i];
        CAPTURE(model.label, model.formula, model.note);
        REQUIRE(model.effect);
        REQUIRE(comparison.test);
        // Modes and periods are orthogonal for 16 subjects.
        CHECK(*model.effect == Approx(comparison.test->of.mean).epsilon(1e-6));
        CHECK(*model.high - *model.low == Approx(comparison.test->high - comparison.test->low).epsilon(0.25));
        CHECK((*model.p < 0.05) == (comparison.test->p < 0.05));
        CHECK(*model.low < *model.effect);
        const bool is_within = !comparison.of.within.empty();
        CHECK(model.values == (is_within ? 32u : 64u));
        CHECK((model.formula.find("factor.display") == std::string::npos) == is_within);
    }
    const MixedModels adjusted = fit_mixed_models(analysis, data, true, never);
    for (std::size_t i = 0; i < adjusted.models.size(); ++i) {
        CAPTURE(adjusted.models[i].formula, adjusted.models[i].note);
        CHECK(adjusted.models[i].formula.find("+ before") != std::string::npos);
        REQUIRE(adjusted.models[i].effect);
    }
}

TEST_CASE("mixed models take levels as text, and note what lme4 warns of and what the orders do not separate",
          "[long]") {
    if (!has_lmer_test()) return test::skip("no R with lmerTest here");
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    StudyModel model;
    // Subjects that differ by metres, measured to the micrometre.
    model.change = [](TrialRecord& trial, std::size_t subject) {
        if (trial.task == "cube")
            trial.measures["distance"] = 1e3 * static_cast<double>(subject) + 1e-4 * trial.measures["distance"];
    };
    write_study(scratch.path() / "data", 8, model);
    ExperimentAnalysis analysis = analyse_experiment(scratch.path() / "data", {.bootstrap = 0});
    const auto rename = [&](std::string& level) {
        if (level == "offset") level = "080";
        if (level == "co-located") level = "T";
        if (level == "mirror") level = "1e2";
        if (level == "HOE") level = "1e3";
    };
    for (experiment::Condition& condition : analysis.protocol.conditions)
        for (auto& [factor, level] : condition.factors) rename(level);
    for (AnalysedComparison& one : analysis.comparisons)
        for (std::string* level : {&one.of.a, &one.of.b, &one.of.within}) rename(*level);
    const MixedModels named = fit_mixed_models(analysis, scratch.path() / "data", false, never);
    REQUIRE(named.models.size() == analysis.comparisons.size());
    for (std::size_t i = 0; i < named.models.size(); ++i) {
        const MixedModel& one = named.models[i];
        CAPTURE(one.label, one.formula, one.note);
        // A fit that did not converge has no numbers.
        const bool is_failed = one.label.find("cube distance") == 0;
        REQUIRE(one.effect.has_value() == !is_failed);
        CHECK(one.p.has_value() == !is_failed);
        if (is_failed) CHECK(one.note.find("no numbers of this fit: ") != std::string::npos);
        else CHECK(*one.effect == Approx(analysis.comparisons[i].test->of.mean).epsilon(0.05).margin(0.05));
    }
    // Each period is one condition: nothing tells them apart.
    write_study(scratch.path() / "one", 8, {.has_one_order = true});
    const MixedModels alike = fit_mixed_models(analyse_experiment(scratch.path() / "one", {.bootstrap = 0}),
                                               scratch.path() / "one", false, never);
    REQUIRE_FALSE(alike.models.empty());
    for (const MixedModel& one : alike.models) {
        CAPTURE(one.label, one.formula, one.note);
        CHECK_FALSE(one.effect);
        CHECK(one.note.find("the orders do not separate the effect from ") == 0);
        CHECK(one.note.find("period") != std::string::npos);
    }
}

TEST_CASE("results show each number in the unit that they state") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    write_study(data, 4, {});
    ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0});
    const auto results_of = [&] {
        return report::output_json(report::experiment_fields().of(report::FoundExperiment{&analysis, {}}));
    };
    const file::Json means = results_of()["subjects"][0]["means"];
    const auto& own = analysis.subjects.front().means;
    CHECK(means["cube distance mirrorHere"].get<double>() == Approx(own.at("cube distance mirrorHere") / mm));
    // The mean of logarithms has no unit.
    CHECK(means["labyrinth time hoeHere"].get<double>() == Approx(own.at("labyrinth time hoeHere")));
    // Matches of an adjustment on a linear scale, and on one of logarithms.
    analysis = {};
    analysis.protocol = experiment::load_protocol(test::source_folder() / "assets/library/experiments/intensity.toml");
    analysis.protocol.stimulus->unit = "mm";
    analysis.subjects.emplace_back();
    SubjectThreshold match;
    match.condition = "f40";
    match.adjusted.emplace();
    match.adjusted->below = 4.0 * mm;
    match.adjusted->above = 6.0 * mm;
    match.adjusted->deviation = 0.25 * mm;
    analysis.subjects.front().thresholds = {match};
    for (const bool is_log : {false, true}) {
        analysis.protocol.stimulus->is_log = is_log;
        const file::Json shown = results_of()["thresholds"][0];
        CHECK(shown["match_deviation"].get<double>() == Approx(is_log ? 0.25e-3 : 0.25));
        if (!is_log) CHECK(shown["from_below"].get<double>() == Approx(4.0));
    }
}

TEST_CASE("tables are as BIDS demands: a description of each column, n/a for what is missing, one task in each name") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    StudyModel model;
    model.change = [](TrialRecord& trial, std::size_t subject) {
        if (subject != 0 || trial.task != "cube") return;
        trial.measures.erase("distance");
        trial.is_finished = false;
        trial.marked = "a gap of\t9 ms";
    };
    write_study(data, 4, model);
    write_bids(analyse_experiment(data, {.bootstrap = 0}), data);
    const file::Json description = file::Json::parse(file::read_whole_file(data / "dataset_description.json"));
    CHECK(description["BIDSVersion"].get<std::string>() == "1.9.0");
    CHECK_FALSE(description["Name"].get<std::string>().empty());
    CHECK(fs::file_size(data / "README") > 20);
    // What a laboratory wrote into it stays.
    file::write_whole_file(data / "README", "ours");
    write_bids(analyse_experiment(data, {.bootstrap = 0}), data);
    CHECK(file::read_whole_file(data / "README") == "ours");
    std::vector<fs::path> tables{data / "participants.tsv"};
    for (int s = 1; s <= 4; ++s)
        for (const char* task : {"cube", "spiral", "labyrinth"})
            tables.push_back(data / fmt::format("sub-S{:02}/beh/sub-S{:02}_task-{}_beh.tsv", s, s, task));
    for (const fs::path& table : tables) {
        CAPTURE(table.string());
        REQUIRE(fs::exists(table));
        const auto rows = rows_of(table);
        const file::Json about = file::Json::parse(file::read_whole_file(fs::path(table).replace_extension(".json")));
        const std::set<std::string> names(rows.front().begin(), rows.front().end());
        CHECK(names.size() == rows.front().size());
        for (const std::string& name : rows.front()) {
            CAPTURE(name);
            CHECK(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos);
            if (name == "participant_id") continue;
            REQUIRE(about.contains(name));
            CHECK(about[name].contains("Description"));
        }
        for (const auto& row : rows) {
            CHECK(row.size() == rows.front().size());
            for (const std::string& cell : row) CHECK_FALSE(cell.empty());
        }
    }
    const auto participants = rows_of(data / "participants.tsv");
    CHECK(participants.front().front() == "participant_id");
    CHECK(participants.size() == 5);
    CHECK(participants[1].front() == "sub-S01");
    const auto cube = rows_of(tables[1]);
    const auto at = [&](const char* name) {
        return static_cast<std::size_t>(std::find(cube.front().begin(), cube.front().end(), name) -
                                        cube.front().begin());
    };
    CHECK(cube[1][at("distance")] == "n/a");
    // Distances are in the unit that the description states.
    const file::Json about = file::Json::parse(file::read_whole_file(fs::path(tables[4]).replace_extension(".json")));
    CHECK(about["distance"]["Units"].get<std::string>() == "mm");
    const double distance = std::stod(rows_of(tables[4])[1][at("distance")]);
    CHECK(distance > 1.0);
    CHECK(distance < 8.0);
}

namespace {

/// The analysis of two complete subjects of a library experiment, whose trials `make` fills.
template <class Make>
ExperimentAnalysis analysis_of_trials(const fs::path& out, const char* experiment, Make make) {
    const experiment::Protocol protocol = experiment::load_protocol(
        test::source_folder() / "assets/library/experiments" / fmt::format("{}.toml", experiment));
    ExperimentFolder folder(out, protocol);
    for (const char* name : {"P01", "P02"}) {
        experiment::SubjectEntry entry = folder.enrol(name, true);
        entry.is_complete = true;
        folder.update(entry);
        std::vector<TrialRecord> trials;
        for (const experiment::Condition& condition : protocol.conditions) {
            TrialRecord trial;
            trial.condition = condition.name;
            trial.interval = 1;
            trial.is_simulated = true;
            for (int i = 0; i < 200; ++i) {
                trial.number = static_cast<int>(trials.size()) + 1;
                trial.folder = fmt::format("trial-{:04}", trial.number);
                if (make(protocol, i, trial)) trials.push_back(trial);
            }
        }
        fs::create_directories(folder.subject_folder(name));
        experiment::save_trials(trials, folder.subject_folder(name) / "trials.jsonl");
    }
    return analyse_experiment(out, {.bootstrap = 49});
}

}  // namespace

TEST_CASE("matches and thresholds at an end of the range are not identified, with the reason, and give no effect") {
    const run::ScratchFolder scratch;
    const auto matches = [](double at_320) {
        return [at_320](const experiment::Protocol& protocol, int i, TrialRecord& trial) {
            trial.level = i % 2 == 0 ? protocol.stimulus->min * 1.2 : protocol.stimulus->max * 0.9;
            trial.match = (trial.condition == "f320" && i == 3 ? at_320 : 0.05) * (1.0 + 1e-3 * (i % 3));
            if (*trial.match > protocol.stimulus->max) trial.match = protocol.stimulus->max;
            return i < 8;
        };
    };
    const ExperimentAnalysis inside = analysis_of_trials(scratch.path() / "inside", "intensity", matches(0.7));
    for (const SubjectThreshold& one : inside.subjects.front().thresholds) CHECK(one.threshold);
    // One match of eight at the upper, or at the lower, end: it may have been any level beyond.
    for (const double end : {0.8, 0.005}) {
        const ExperimentAnalysis stuck =
            analysis_of_trials(scratch.path() / fmt::format("stuck{}", end), "intensity", matches(end));
        for (const SubjectThreshold& one : stuck.subjects.front().thresholds) {
            CHECK(one.threshold.has_value() == (one.condition != "f320"));
            CHECK(one.adjusted.has_value() == (one.condition != "f320"));
            if (one.condition == "f320") {
                CHECK(one.problem ==
                      "1 of 8 matches are at an end of the range: the matching level may lie beyond it");
                CHECK(one.beyond == (end > 0.1 ? Beyond::above : Beyond::below));
            }
        }
        REQUIRE_FALSE(stuck.comparisons.empty());
        for (const AnalysedComparison& one : stuck.comparisons) {
            REQUIRE(one.of.a == "320 Hz");
            CHECK(verdict_of(one, 0.05) == "not judged");
            CHECK_FALSE(one.test);
            CHECK(one.beyond == 2);
            CHECK(one.problem == "2 of 2 subjects have a value beyond an end of the range");
            // The difference to the end of the range: the matching level lies there or beyond.
            const double level = end > 0.1 ? stuck.protocol.stimulus->max : stuck.protocol.stimulus->min;
            REQUIRE(one.bound);
            CHECK(*one.bound == Approx(std::log(0.05 / level)).margin(0.01));
            CHECK(one.is_lower_bound == (end < 0.1));
        }
        for (const GroupValue& one : stuck.groups) {
            CHECK(one.above == (one.condition == "f320" && end > 0.1 ? 2 : 0));
            CHECK(one.below == (one.condition == "f320" && end < 0.1 ? 2 : 0));
            CHECK(one.count == (one.condition == "f320" ? 0 : 2));
        }
        const std::string text = report::text_of(report::experiment_fields().of(report::FoundExperiment{&stuck, {}}));
        CHECK(text.find("P01 in 'f320': not identified: 1 of 8 matches") != std::string::npos);
        CHECK(text.find(end < 0.1 ? "the difference is at least" : "the difference is at most") != std::string::npos);
        const file::Json shown =
            report::output_json(report::experiment_fields().of(report::FoundExperiment{&stuck, {}}));
        for (const auto& one : shown["thresholds"])
            CHECK(one["from_below"].is_null() == (one["condition"].get<std::string>() == "f320"));
    }
    // A staircase and QUEST+ that stay at the greatest level.
    for (const char* name : {"vibration", "stiffness"}) {
        const ExperimentAnalysis beyond = analysis_of_trials(
            scratch.path() / name, name, [](const experiment::Protocol& protocol, int i, TrialRecord& trial) {
                trial.level = protocol.stimulus->max * (i % 4 == 0 ? 0.8 : 1.0);
                trial.is_correct = i % 5 < 3;  // 60 %: below the target, above chance
                return i < 40;
            });
        for (const SubjectThreshold& one : beyond.subjects.front().thresholds) {
            CAPTURE(one.condition, one.problem);
            CHECK_FALSE(one.threshold);
            CHECK_FALSE(one.interval);
            CHECK_FALSE(one.problem.empty());
        }
    }
}

TEST_CASE("a threshold that answers place beyond the range of its stimulus is not reported as one") {
    const run::ScratchFolder scratch;
    // 70 % correct at the greatest level and chance at a third of it: the level with 75 or 79 % lies above.
    for (const char* name : {"vibration", "stiffness"}) {
        const ExperimentAnalysis beyond = analysis_of_trials(
            scratch.path() / name, name, [](const experiment::Protocol& protocol, int i, TrialRecord& trial) {
                trial.level = protocol.stimulus->max * (i % 2 == 0 ? 1.0 : 0.3);
                trial.is_correct = i % 2 == 0 ? i % 20 < 14 : i % 4 == 1;
                return true;
            });
        const SubjectThreshold& one = beyond.subjects.front().thresholds.front();
        CAPTURE(name, one.problem);
        REQUIRE(one.fit);
        CHECK(one.fit->is_identified);
        CHECK_FALSE(one.threshold);
        CHECK(one.problem == "the answers place it at or beyond an end of the range");
    }
}

TEST_CASE("thresholds of a staircase and of QUEST+ are those of the answers, at the target of the protocol") {
    const run::ScratchFolder scratch;
    for (const char* name : {"vibration", "stiffness"})
        for (const double slope : {2.0, 5.0}) {
            psychophysics::Psychometric truth{psychophysics::Form::weibull, 0.0, slope, 0.5, 0.02};
            std::vector<double> levels;
            std::vector<bool> correct;
            const ExperimentAnalysis analysis = analysis_of_trials(
                scratch.path() / fmt::format("{}{}", name, slope), name,
                [&](const experiment::Protocol& protocol, int i, TrialRecord& trial) {
                    const experiment::Stimulus& stimulus = *protocol.stimulus;
                    truth.threshold = 0.5 * (stimulus.axis(stimulus.min) + stimulus.axis(stimulus.max));
                    if (i == 0) levels.clear(), correct.clear();
                    // Twenty answers at each of ten levels, as many correct as the function states.
                    trial.level = stimulus.level_at(truth.threshold - 0.35 + 0.06 * (i % 10));
                    trial.is_correct = i / 10 < std::lround(20.0 * truth.at(stimulus.axis(trial.level)));
                    levels.push_back(stimulus.axis(trial.level));
                    correct.push_back(trial.is_correct);
                    return true;
                });
            const experiment::Protocol& protocol = analysis.protocol;
            const experiment::Stimulus& stimulus = *protocol.stimulus;
            const double target = name == std::string("vibration") ? 0.794 : 0.75, low = stimulus.axis(stimulus.min),
                         high = stimulus.axis(stimulus.max), half = 0.5 * (high - low);
            psychophysics::PosteriorSettings prior{truth.form, 0.5, 0.02, {}, low - half, high + half};
            for (int i = 0; i < 8; ++i) prior.slopes.push_back(std::pow(20.0, i / 7.0));
            const auto wanted =
                psychophysics::posterior_level(psychophysics::count_levels(levels, correct), prior, target);
            const SubjectThreshold& one = analysis.subjects.front().thresholds.front();
            CAPTURE(name, slope, one.problem);
            REQUIRE(one.threshold);
            REQUIRE(one.interval);
            CHECK(stimulus.axis(*one.threshold) == Approx(truth.level_of(target)).margin(0.025));
            CHECK(stimulus.axis(*one.threshold) == Approx(wanted.median).margin(1e-9));
            CHECK(stimulus.axis(one.interval->low) == Approx(wanted.interval.low).margin(1e-9));
            CHECK(stimulus.axis(one.interval->high) == Approx(wanted.interval.high).margin(1e-9));
            CHECK_FALSE(one.is_low_beyond);
            CHECK_FALSE(one.is_high_beyond);
        }
}

TEST_CASE("an end of an interval beyond the range of the stimulus has a flag in place of a number") {
    const run::ScratchFolder scratch;
    // Nine of ten answers are correct at the greatest level: that does not exclude 75 %.
    const ExperimentAnalysis analysis = analysis_of_trials(
        scratch.path() / "data", "stiffness", [](const experiment::Protocol& protocol, int i, TrialRecord& trial) {
            trial.level = protocol.stimulus->max * (i % 2 == 0 ? 1.0 : 0.4);
            trial.is_correct = i % 2 == 0 ? i != 0 : i % 4 == 1;
            return i < 20;
        });
    const SubjectThreshold& one = analysis.subjects.front().thresholds.front();
    CAPTURE(one.problem);
    REQUIRE(one.threshold);
    REQUIRE(one.interval);
    CHECK(one.is_high_beyond);
    CHECK_FALSE(one.is_low_beyond);
    const report::Result result = report::experiment_fields().of(report::FoundExperiment{&analysis, {}});
    const file::Json shown = report::output_json(result)["thresholds"][0];
    CHECK(shown["high"].is_null());
    CHECK(shown["high_beyond_range"].get<bool>());
    CHECK_FALSE(shown["low"].is_null());
    CHECK_FALSE(shown["low_beyond_range"].get<bool>());
    CHECK(report::text_of(result).find(" to beyond 1") != std::string::npos);
}

TEST_CASE("false alarms as frequent as the target leave no level, which the reason states") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    analysis_of_trials(data, "stiffness", [](const experiment::Protocol& protocol, int i, TrialRecord& trial) {
        trial.interval = i % 2;
        trial.level = trial.interval == 0 ? 0.0 : protocol.stimulus->max * (i % 4 == 1 ? 1.0 : 0.1);
        trial.answer = i % 10 == 0 ? 0 : 1;  // "yes" to eight of ten trials without the stimulus
        trial.is_correct = trial.answer == trial.interval;
        return true;
    });
    // The same trials as those of a yes/no task.
    const fs::path frozen = data / "frozen/stiffness.toml";
    std::string text = file::read_whole_file(frozen);
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"[\"first.stiffness\", \"second.stiffness\"]",
                                                                       "[\"second.stiffness\"]"},
                                   {"[[\"0 s\", \"2 s\"], [\"2 s\", \"4 s\"]]", "[[\"2 s\", \"4 s\"]]"},
                                   {"kind  = \"choice\"", "kind  = \"yes_no\""},
                                   {"names = [\"first\", \"second\"]", "names = [\"no\", \"yes\"]"}}) {
        REQUIRE(text.find(from) != std::string::npos);
        text.replace(text.find(from), from.size(), to);
    }
    file::write_whole_file(frozen, text);
    const ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0});
    for (const SubjectThreshold& one : analysis.subjects.front().thresholds) {
        CHECK_FALSE(one.threshold);
        CHECK(one.problem == "the rate of false alarms, 0.797, is not below the target, 0.75: no level has it");
        CHECK(one.beyond == Beyond::unknown);
    }
}

TEST_CASE("a report with carry-over or mixed models explains what each estimates and why they differ") {
    const run::ScratchFolder scratch;
    const fs::path data = scratch.path() / "data";
    write_study(data, 8, {});
    for (const bool has_all : {false, true}) {
        const ExperimentAnalysis analysis = analyse_experiment(data, {.bootstrap = 0, .has_carry_over = has_all});
        const std::string page = report::html_of(report::experiment_fields().of(report::FoundExperiment{&analysis, {}}));
        CHECK((page.find("The carry-over model is least squares") != std::string::npos) == has_all);
        CHECK((page.find("They differ more where subjects lack values") != std::string::npos) == has_all);
        CHECK(page.find("The mixed model uses") == std::string::npos);
    }
}
