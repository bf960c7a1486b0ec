// SPDX-License-Identifier: Apache-2.0
// Sessions of an experiment: which trial is next, what survives, and what is refused.
#include "tools/analysis/experiment/analysis.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/port_values.hpp"
#include "tools/analysis/experiment/run_experiment.hpp"
#include "tools/analysis/experiment/subject_session.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/scratch_folder.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::analysis;
using experiment::Phase;
using experiment::TrialRecord;
namespace fs = std::filesystem;

namespace {

const fs::path bundled = test::source_folder() / "assets/library/experiments";

/// The bundled stiffness experiment with few trials.
experiment::Protocol short_protocol(const fs::path& folder) {
    std::string text = file::read_whole_file(bundled / "stiffness.toml");
    const auto replace = [&](const std::string& what, const std::string& by) {
        const std::size_t at = text.find(what);
        REQUIRE(at != std::string::npos);
        text.replace(at, what.size(), by);
    };
    replace("trials = 60", "trials = 6");
    replace("needed     = 4", "needed     = 1");
    fs::create_directories(folder / "patches");
    fs::copy_file(bundled / "patches/stiffness-pair.toml", folder / "patches/stiffness-pair.toml",
                  fs::copy_options::overwrite_existing);
    std::ofstream(folder / "stiffness.toml") << text;
    return experiment::load_protocol(folder / "stiffness.toml");
}

TrialRecord record_of(const experiment::Protocol& protocol, const TrialSpec& spec, bool correct,
                      const std::string& marked = {}) {
    TrialRecord record;
    record.number = spec.number;
    record.block = spec.block;
    record.phase = spec.phase;
    record.condition = protocol.conditions[spec.condition].name;
    record.level = spec.level;
    record.interval = spec.interval;
    record.folder = "t";
    record.is_correct = correct;
    record.marked = marked;
    return record;
}

ExperimentHooks silent() {
    ExperimentHooks hooks;
    hooks.say = [](const std::string&) {};
    return hooks;
}

ExperimentChoice simulated_choice(const fs::path& folder, const std::string& subject) {
    ExperimentChoice choice;
    choice.protocol = short_protocol(folder / "files");
    choice.out = folder / "data";
    choice.subject = subject;
    choice.model = experiment::load_observer_model(bundled / "models/stiffness.toml", "");
    return choice;
}

std::string trials_of(const fs::path& folder, const std::string& subject) {
    return file::read_whole_file(folder / "data" / ("sub-" + subject) / "trials.jsonl");
}

}  // namespace

TEST_CASE("a session has practice, blocks in its row's order, and the trials of its rule") {
    const run::ScratchFolder scratch;
    const experiment::Protocol protocol = short_protocol(scratch.path());
    for (const std::size_t row : {std::size_t{0}, std::size_t{1}}) {
        SubjectSession session(protocol, row, {});
        std::map<std::string, int> main;
        std::string first;
        int practice = 0;
        while (const auto spec = session.next()) {
            const std::string& condition = protocol.conditions[spec->condition].name;
            if (first.empty()) first = condition;
            if (spec->phase == Phase::main) ++main[condition];
            if (spec->phase == Phase::practice) ++practice;
            CHECK(spec->level >= protocol.stimulus->min * (1.0 - 1e-12));
            CHECK(spec->level <= protocol.stimulus->max * (1.0 + 1e-12));
            CHECK((spec->interval == 1 || spec->interval == 2));
            session.add(record_of(protocol, *spec, true));
        }
        CHECK(main == std::map<std::string, int>{{"soft", 6}, {"firm", 6}});
        CHECK(practice == 1);
        CHECK(first == (row == 0 ? "soft" : "firm"));
    }
}

TEST_CASE("a marked trial does not move the rule and is repeated once at the end of its block") {
    const run::ScratchFolder scratch;
    const experiment::Protocol protocol = short_protocol(scratch.path());
    SubjectSession session(protocol, 0, {}), twin(protocol, 0, {});
    std::vector<TrialSpec> repeated;
    std::optional<TrialSpec> marked;
    while (const auto spec = session.next()) {
        if (spec->block > 0) break;
        if (spec->phase == Phase::main && !marked) {
            marked = spec;
            session.add(record_of(protocol, *spec, false, "a gap of 9 ms"));
            // The rule has learnt nothing: it asks for the same level.
            const auto again = session.next();
            REQUIRE(again);
            if (again->phase == Phase::main) CHECK(again->level == spec->level);
            continue;
        }
        if (spec->phase == Phase::repeat) repeated.push_back(*spec);
        // Marked a second time, it is not repeated again.
        session.add(record_of(protocol, *spec, true, spec->phase == Phase::repeat ? "a gap of 9 ms" : ""));
    }
    REQUIRE(marked);
    REQUIRE(repeated.size() == 1);
    CHECK(repeated.front().level == marked->level);
    CHECK(repeated.front().interval == marked->interval);
}

TEST_CASE("a session that is resumed after any trial goes on as if it had not been cut off") {
    const run::ScratchFolder scratch;
    const experiment::Protocol protocol = short_protocol(scratch.path());
    std::vector<TrialRecord> all;
    SubjectSession session(protocol, 1, {});
    int n = 0;
    while (const auto spec = session.next()) {
        ++n;
        all.push_back(record_of(protocol, *spec, n % 3 != 0, n == 4 ? "late" : ""));
        session.add(all.back());
    }
    for (std::size_t cut = 0; cut <= all.size(); ++cut) {
        const SubjectSession again(protocol, 1, {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(cut)});
        const auto spec = again.next();
        REQUIRE(spec.has_value() == (cut < all.size()));
        if (!spec) continue;
        CHECK(spec->level == all[cut].level);
        CHECK(spec->interval == all[cut].interval);
        CHECK(spec->phase == all[cut].phase);
    }
    // Data of another protocol.
    std::vector<TrialRecord> foreign = all;
    foreign[2].level *= 1.5;
    CHECK_THROWS_AS(SubjectSession(protocol, 1, foreign), Error);
}

TEST_CASE("trials of another order of tasks are not those of a session") {
    const experiment::Protocol protocol = experiment::load_protocol(bundled / "co-location.toml");
    SubjectSession session(protocol, 0, {});
    std::vector<TrialRecord> all;
    while (const auto spec = session.next()) {
        all.push_back(record_of(protocol, *spec, true));
        all.back().task = protocol.tasks[spec->task].name;
        session.add(all.back());
    }
    CHECK_FALSE(SubjectSession(protocol, 0, all).next());
    all.front().task = all.back().task;
    CHECK(protocol.tasks[SubjectSession(protocol, 0, {}).next()->task].name != all.front().task);
    CHECK_THROWS_WITH(SubjectSession(protocol, 0, all),
                      Catch::Matchers::ContainsSubstring("trial 1 is not the one that the protocol prescribes"));
}

TEST_CASE("measures of a series have their closed forms") {
    PortValues values;
    PortSeries &wave = values["a.wave"], &late = values["a.late"], &line = values["a.line"],
               &button = values["a.button"];
    for (int i = 0; i < 4000; ++i) {
        const double t = 1e-3 * i;
        const auto shape = [](double at) { return std::sin(3.0 * at) + 0.4 * std::sin(11.3 * at); };
        wave.values.push_back(shape(t));
        late.values.push_back(shape(t - 0.037));
        line.values.push_back(2.5 * shape(t) + 1.0);
        button.values.push_back((i >= 1000 && i < 1100) || i >= 3000 ? 1.0 : 0.0);
    }
    using Kind = experiment::Measure::Kind;
    experiment::Measure measure;
    measure.kind = Kind::lag;
    measure.port = "a.late";
    measure.other = "a.wave";
    CHECK(measure_of(measure, values) == Approx(0.037).margin(1e-4));
    measure = {};
    measure.kind = Kind::slope;
    measure.port = "a.line";
    measure.other = "a.wave";
    CHECK(measure_of(measure, values) == Approx(2.5));
    measure = {};
    measure.kind = Kind::until;
    measure.port = "a.button";
    CHECK(measure_of(measure, values) == Approx(1.0));
    measure.kind = Kind::at_press;
    measure.port = "a.line";
    measure.when = "a.button";
    CHECK(measure_of(measure, values) == Approx(0.5 * (line.values[999] + line.values[2999])));
    measure.when.clear();
    measure.kind = Kind::peak;
    CHECK(measure_of(measure, values, experiment::Window{0.0, 0.5}) ==
          Approx(*std::max_element(line.values.begin(), line.values.begin() + 500)));
    // Nothing to measure is not a number, and not zero.
    values["a.silent"].values.assign(4000, 0.0);
    measure.kind = Kind::until;
    measure.port = "a.silent";
    CHECK(std::isnan(measure_of(measure, values)));
    measure.kind = Kind::at_press;
    measure.port = "a.line";
    measure.when = "a.silent";
    CHECK(std::isnan(measure_of(measure, values)));
}

TEST_CASE("a simulated subject runs, its takes give the measures to the bit, and the analysis reads them", "[slow]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    ExperimentChoice choice = simulated_choice(scratch.path(), "P01");
    const ExperimentEnd end = run_experiment(choice, silent(), never);
    CHECK(end.is_complete);
    CHECK(end.marked == 0);
    const TakeCheck check = check_takes(choice.out);
    CHECK(check.trials == static_cast<std::size_t>(end.trials));
    CHECK(check.values == 2 * check.trials);
    CHECK(check.differences.empty());
    // The stimulus that was commanded is the one that was asked for.
    for (const TrialRecord& trial : experiment::load_trials(choice.out / "sub-P01/trials.jsonl")) {
        REQUIRE(trial.rendered_level);
        CHECK(*trial.rendered_level == Approx(trial.level).epsilon(0.01));
    }
    // Again: there is nothing to do, and nothing changes.
    const std::string before = trials_of(scratch.path(), "P01");
    CHECK(run_experiment(choice, silent(), never).trials == 0);
    CHECK(trials_of(scratch.path(), "P01") == before);
    const ExperimentAnalysis analysis = analyse_experiment(choice.out, {0});
    CHECK(analysis.is_simulated);
    CHECK(analysis.included == 1);
    write_bids(analysis, choice.out);
    CHECK(fs::exists(choice.out / "sub-P01/beh/sub-P01_task-stiffness_beh.tsv"));
    CHECK(fs::exists(choice.out / "participants.tsv"));
}

TEST_CASE("a trial whose stimulus did not reach the device is marked, repeated once, and left out of the fit",
          "[slow]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    ExperimentChoice choice = simulated_choice(scratch.path(), "P01");
    // Less than the walls need: the forces of both are cut off alike.
    choice.settings = {"hand_out.max_force=0.5 N"};
    const ExperimentEnd end = run_experiment(choice, silent(), never);
    CHECK(end.is_complete);
    CHECK(end.marked == end.trials);
    int main = 0, repeat = 0;
    for (const TrialRecord& trial : experiment::load_trials(choice.out / "sub-P01/trials.jsonl")) {
        if (trial.phase == Phase::main) ++main;
        if (trial.phase == Phase::repeat) ++repeat;
    }
    CHECK(main == 12);
    CHECK(repeat == 12);
    const ExperimentAnalysis analysis = analyse_experiment(choice.out, {0});
    REQUIRE(analysis.subjects.size() == 1);
    CHECK(analysis.subjects[0].thresholds[0].counts.empty());
    CHECK_FALSE(analysis.subjects[0].thresholds[0].threshold);
    CHECK(analysis.subjects[0].excluded.find("marked") != std::string::npos);
    CHECK(analysis.included == 0);
}

TEST_CASE("a session that is stopped in any trial is resumed to the same trials", "[slow]") {
    const run::ScratchFolder whole, cut;
    const std::atomic<bool> never{false};
    run_experiment(simulated_choice(whole.path(), "P01"), silent(), never);
    const ExperimentChoice choice = simulated_choice(cut.path(), "P01");
    for (int session = 0;; ++session) {
        REQUIRE(session < 20);
        std::atomic<bool> stop{false};
        ExperimentHooks hooks = silent();
        int seen = 0;
        hooks.progress = [&](const TrialSpec&, int, int) { stop = ++seen == 2; };
        if (run_experiment(choice, hooks, stop).is_complete) break;
        // What a killed run leaves of the trial that it was in.
        fs::create_directories(choice.out / "sub-P01" / "trial-0003" / "take");
        std::ofstream(choice.out / "sub-P01" / "trial-0099.part") << "x";
    }
    CHECK(trials_of(cut.path(), "P01") == trials_of(whole.path(), "P01"));
}

TEST_CASE("a protocol that changed after the first subject is refused with what changed", "[slow]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    ExperimentChoice choice = simulated_choice(scratch.path(), "P01");
    run_experiment(choice, silent(), never);
    choice.subject = "P02";
    const fs::path file = scratch.path() / "files/stiffness.toml";
    const std::string text = file::read_whole_file(file);
    std::string edited = text;
    edited.replace(edited.find("trials = 6"), 10, "trials = 7");
    std::ofstream(file) << edited;
    choice.protocol = experiment::load_protocol(file);
    CHECK_THROWS_WITH(run_experiment(choice, silent(), never),
                      Catch::Matchers::ContainsSubstring("'trials = 6' is now 'trials = 7'"));
    std::ofstream(file) << text;
    std::ofstream(scratch.path() / "files/patches/stiffness-pair.toml", std::ios::app) << "# more\n";
    choice.protocol = experiment::load_protocol(file);
    CHECK_THROWS_WITH(run_experiment(choice, silent(), never),
                      Catch::Matchers::ContainsSubstring("patches/stiffness-pair.toml, line"));
}

TEST_CASE("a bone or sound that changed after the first subject is refused with its name", "[slow]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    ExperimentChoice choice = simulated_choice(scratch.path(), "P01");
    // An asset that the patch loads: the movement of its hand.
    const fs::path patch = scratch.path() / "files/patches/stiffness-pair.toml",
                   hand = scratch.path() / "files/hand.targets";
    std::string text = file::read_whole_file(patch);
    const std::size_t at = text.find("targets   = "), end = text.find('\n', at), devices = text.find("[devices");
    std::string targets = text.substr(at + 13, end - at - 14);
    std::replace(targets.begin(), targets.end(), ';', '\n');
    std::ofstream(hand) << targets << '\n';
    text.replace(at, end - at, "file = \"movement\"");
    text.insert(devices, "[assets]\nmovement = \"../hand.targets\"\n\n");
    std::ofstream(patch) << text;
    choice.protocol = experiment::load_protocol(choice.protocol.file);
    run_experiment(choice, silent(), never);
    choice.subject = "P02";
    run_experiment(choice, silent(), never);
    std::ofstream(hand, std::ios::app) << "9 s: 0 0 5 mm\n";
    choice.subject = "P03";
    CHECK_THROWS_WITH(run_experiment(choice, silent(), never),
                      Catch::Matchers::ContainsSubstring("the content of hand.targets has changed"));
}

TEST_CASE("a protocol may name files above its own folder, and its data can be analysed", "[slow]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    ExperimentChoice choice = simulated_choice(scratch.path(), "P01");
    const fs::path below = scratch.path() / "files/protocols";
    fs::create_directories(below);
    std::string text = file::read_whole_file(scratch.path() / "files/stiffness.toml");
    const std::string patch = "patches/stiffness-pair.toml";
    text.replace(text.find(patch), patch.size(), "../" + patch);
    std::ofstream(below / "stiffness.toml") << text;
    choice.protocol = experiment::load_protocol(below / "stiffness.toml");
    run_experiment(choice, silent(), never);
    CHECK(analyse_experiment(choice.out, {}).subjects.size() == 1);
    choice.subject = "P02";
    run_experiment(choice, silent(), never);
    CHECK(analyse_experiment(choice.out, {}).included == 2);
}

TEST_CASE("a session is resumed with the settings with which it began", "[slow]") {
    const run::ScratchFolder scratch;
    ExperimentChoice choice = simulated_choice(scratch.path(), "P01");
    choice.settings = {"first.max_force=9 N", "hand_out.max_force=30 N"};
    // Ended after three trials.
    std::atomic<bool> stop{false};
    ExperimentHooks hooks = silent();
    hooks.progress = [&](const TrialSpec&, int trials, int) { stop = trials >= 3; };
    CHECK_FALSE(run_experiment(choice, hooks, stop).is_complete);
    CHECK(file::read_whole_file(choice.out / "experiment.json").find("first.max_force=9 N") != std::string::npos);
    const std::string before = trials_of(scratch.path(), "P01");
    choice.settings = {"first.max_force=8 N"};
    const std::atomic<bool> never{false};
    CHECK_THROWS_WITH(run_experiment(choice, silent(), never),
                      Catch::Matchers::ContainsSubstring(
                          "were run with 'first.max_force=9 N', 'hand_out.max_force=30 N', and now with "
                          "'first.max_force=8 N'"));
    CHECK(trials_of(scratch.path(), "P01") == before);
    // In another order they are the same.
    choice.settings = {"hand_out.max_force=30 N", "first.max_force=9 N"};
    stop = false;
    hooks.progress = [&](const TrialSpec&, int, int) { stop = true; };
    CHECK_FALSE(run_experiment(choice, hooks, stop).is_complete);
    // An experiment of before settings were stored: what they were is not known, and those of now are noted.
    const fs::path noted = choice.out / "experiment.json";
    const std::string text = file::read_whole_file(noted);
    const std::size_t at = text.rfind(',', text.find("\"settings\"")), end = text.find(']', at);
    std::ofstream(noted) << text.substr(0, at) + text.substr(end + 1);
    write_bids(analyse_experiment(choice.out, {0}), choice.out);
    CHECK(file::read_whole_file(choice.out / "participants.tsv").ends_with("\tunknown\n"));
    CHECK(run_experiment(choice, silent(), never).is_complete);
    CHECK(file::read_whole_file(noted).find("hand_out.max_force=30 N") != std::string::npos);
    // Another subject may have others; the analysis reports it.
    choice.subject = "P02";
    choice.settings.clear();
    CHECK(run_experiment(choice, silent(), never).is_complete);
}

TEST_CASE("a task with a hand is a rehearsal without a haptic device, whatever the first task has", "[slow]") {
    const run::ScratchFolder scratch;
    for (const char* name : {"vibration-match", "stiffness-pair"})
        fs::copy_file(bundled / "patches" / (std::string(name) + ".toml"),
                      scratch.path() / (std::string(name) + ".toml"));
    std::ofstream(scratch.path() / "two.toml")
        << "format = 1\ntitle = \"Two\"\nname = \"two\"\nconsent = false\n"
           "[[task]]\nname = \"hear\"\npatch = \"vibration-match.toml\"\nlength = \"0.1 s\"\n"
           "[[task.measure]]\nname = \"loud\"\nkind = \"rms\"\nport = \"both.out\"\n"
           "[[task]]\nname = \"touch\"\npatch = \"stiffness-pair.toml\"\nlength = \"0.1 s\"\n"
           "[[task.measure]]\nname = \"pushed\"\nkind = \"rms\"\nport = \"hand_out.applied.fz\"\n";
    ExperimentChoice choice;
    choice.protocol = experiment::load_protocol(scratch.path() / "two.toml");
    choice.out = scratch.path() / "data";
    choice.subject = "P01";
    const std::atomic<bool> never{false};
    compile::AssetCache assets;
    std::string said;
    ExperimentHooks hooks;
    hooks.say = [&](const std::string& line) { said += line; };
    hooks.confirm = [](const std::string&, char) { return true; };
    hooks.perform = [&](const run::RunChoice& run, const experiment::Condition&, std::atomic<bool>&, TurnedLevel*) {
        return LiveEnd{run::render_run(run, assets, never, [](double) {}).summary, {}, false};
    };
    CHECK(run_experiment(choice, hooks, never).is_complete);
    CHECK(said.find("This is a rehearsal") != std::string::npos);
    const auto trials = experiment::load_trials(choice.out / "sub-P01/trials.jsonl");
    REQUIRE(trials.size() == 2);
    for (const TrialRecord& trial : trials) CHECK(trial.is_rehearsal == (trial.task == "touch"));
}

TEST_CASE("a subject who withdraws leaves nothing, and the next one inherits the row") {
    const run::ScratchFolder scratch;
    const experiment::Protocol protocol = short_protocol(scratch.path() / "files");
    const fs::path out = scratch.path() / "data";
    {
        ExperimentFolder folder(out, protocol);
        for (const char* name : {"P01", "P02", "P03"}) folder.enrol(name, false);
        CHECK_THROWS_AS(folder.enrol("Jane Doe", false), Error);
        CHECK_THROWS_AS(folder.enrol("../x", false), Error);
        CHECK_THROWS_AS(folder.enrol("P01", true), Error);
        CHECK_THROWS_AS(ExperimentFolder(out, protocol), Error);  // in use
        fs::create_directories(folder.subject_folder("P02"));
        std::ofstream(folder.subject_folder("P02") / "trials.jsonl") << "";
        // Results may name the subject. A folder of the laboratory is none, whatever its name begins with.
        for (const char* name : {"report.html", "report.old.html", "results.json", "reports.txt"})
            std::ofstream(out / name) << "P02";
        fs::create_directories(out / "results");
        folder.withdraw("P02");
        CHECK_FALSE(fs::exists(folder.subject_folder("P02")));
        for (const char* name : {"report.html", "report.old.html", "results.json"}) CHECK_FALSE(fs::exists(out / name));
        for (const char* name : {"results", "reports.txt"}) CHECK(fs::exists(out / name));
        for (const char* name : {"report.html", "report.old.html", "results.csv"}) CHECK(is_experiment_result(name));
        for (const char* name : {"report", "results.", "reports.txt", "my-report.html"})
            CHECK_FALSE(is_experiment_result(name));
        CHECK_THROWS_WITH(folder.withdraw("P2"), Catch::Matchers::ContainsSubstring("there is no subject"));
    }
    ExperimentFolder folder(out, protocol);
    CHECK(file::read_whole_file(out / "experiment.json").find("P02") == std::string::npos);
    CHECK(folder.enrol("P04", false).row == 1);
    CHECK(folder.enrol("P05", false).row == 3);
}

TEST_CASE("levels that the device cannot be commanded are refused before a session") {
    const run::ScratchFolder scratch;
    experiment::Protocol protocol = short_protocol(scratch.path());
    compile::AssetCache assets;
    CHECK_NOTHROW(check_levels(protocol, assets, {}, nullptr));
    // At 1 N the stiffer wall is cut off.
    CHECK_THROWS_WITH(check_levels(protocol, assets, {"hand_out.max_force=1 N"}, nullptr),
                      Catch::Matchers::ContainsSubstring("level"));
    protocol.stimulus->measure.port = "hand_out.applid.fz";
    CHECK_THROWS_WITH(check_levels(protocol, assets, {}, nullptr),
                      Catch::Matchers::ContainsSubstring("no output 'hand_out.applid'"));
    protocol.stimulus->measure.port = "hand_out.applied";
    CHECK_THROWS_WITH(check_levels(protocol, assets, {}, nullptr),
                      Catch::Matchers::ContainsSubstring("several channels"));
}

TEST_CASE("a verdict never claims that there is no effect") {
    AnalysedComparison one;
    CHECK(verdict_of(one, 0.05) == "not tested");
    one.test = statistics::PairedTest{};
    one.adjusted_p = 0.6;
    CHECK(verdict_of(one, 0.05) == "inconclusive");
    one.equivalence = statistics::EquivalenceTest{0.01, -0.2, 0.2, statistics::Equivalence::equivalent};
    CHECK(verdict_of(one, 0.05) == "equivalent");
    one.adjusted_p = 0.01;
    CHECK(verdict_of(one, 0.05) == "effect within the margin");
    one.equivalence.reset();
    CHECK(verdict_of(one, 0.05) == "effect");
}
