// SPDX-License-Identifier: Apache-2.0
// Method of adjustment: where trials begin, what a subject turns, what is stored and what becomes of it. And the cap on sound.
#include "tools/analysis/experiment/analysis.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/run_experiment.hpp"
#include "tools/analysis/experiment/subject_session.hpp"
#include "tools/analysis/experiment/turned_level.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/scratch_folder.hpp"

#include <atomic>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::analysis;
using experiment::Phase;
using experiment::TrialRecord;
namespace fs = std::filesystem;

namespace {

const fs::path library_of_adjustments = test::source_folder() / "assets/library/experiments";

/// The bundled adjustment with `trials` trials of one condition and without practice; `change` edits the text.
template <class Change>
experiment::Protocol adjustment_protocol(const fs::path& folder, int trials, Change change) {
    std::string text = file::read_whole_file(library_of_adjustments / "intensity.toml");
    const auto replace = [&](const std::string& what, const std::string& by) {
        const std::size_t at = text.find(what);
        REQUIRE(at != std::string::npos);
        text.replace(at, what.size(), by);
    };
    replace("trials = 8 ", "trials = " + std::to_string(trials) + " ");
    replace("needed     = 1", "needed     = 0");
    text.erase(text.find("[[condition]]", text.find("f80") - 30),
               text.find("[trial]") - text.find("[[condition]]", text.find("f80") - 30));
    text.erase(text.find("[[comparison]]"));
    change(replace);
    fs::create_directories(folder / "patches");
    fs::copy_file(library_of_adjustments / "patches/vibration-match.toml", folder / "patches/vibration-match.toml",
                  fs::copy_options::overwrite_existing);
    std::ofstream(folder / "intensity.toml") << text;
    return experiment::load_protocol(folder / "intensity.toml");
}
experiment::Protocol adjustment_protocol(const fs::path& folder, int trials) {
    return adjustment_protocol(folder, trials, [](const auto&) {});
}

ExperimentChoice adjusting_subject(const experiment::Protocol& protocol, const fs::path& out) {
    ExperimentChoice choice;
    choice.protocol = protocol;
    choice.out = out;
    choice.subject = "P01";
    choice.model = experiment::load_observer_model(library_of_adjustments / "models/intensity.toml", "");
    choice.model->observer.thresholds = {{"f40", 0.25}};
    return choice;
}

ExperimentHooks quiet_hooks() {
    ExperimentHooks hooks;
    hooks.say = [](const std::string&) {};
    return hooks;
}

}  // namespace

TEST_CASE("adjustments begin equally often near either end, at random levels, differently for each subject") {
    const run::ScratchFolder scratch;
    const experiment::Protocol protocol = adjustment_protocol(scratch.path(), 12);
    std::set<double> starts;
    for (const std::size_t row : {std::size_t{0}, std::size_t{1}}) {
        SubjectSession session(protocol, row, {});
        int above = 0, trials = 0;
        while (const auto spec = session.next()) {
            ++trials;
            const double low = std::log10(protocol.stimulus->min), high = std::log10(protocol.stimulus->max);
            const double place = (std::log10(spec->level) - low) / (high - low);
            CHECK((place <= 0.2 + 1e-9 || place >= 0.8 - 1e-9));
            above += protocol.begins_above(spec->level) ? 1 : 0;
            CHECK(starts.insert(spec->level).second);
            TrialRecord record;
            record.number = spec->number;
            record.condition = protocol.conditions[spec->condition].name;
            record.level = spec->level;
            record.interval = spec->interval;
            record.is_correct = true;
            session.add(record);
        }
        CHECK(trials == 12);
        CHECK(above == 6);
    }
}

TEST_CASE("a turned level moves by whole steps, stops at the ends of its range and turns back with the first press") {
    const run::ScratchFolder scratch;
    const experiment::Protocol protocol = adjustment_protocol(scratch.path(), 2);
    TrialSpec spec;
    spec.level = 0.5;
    spec.interval = 1;
    run::RunChoice run = trial_choice(protocol, spec);
    run.out = scratch.path() / "run";
    CHECK(*run.seconds == 60.0);  // 20 presentations of 3 s
    PortCollector ports({});
    TurnedLevel turned(protocol, spec, ports);
    compile::AssetCache assets;
    run::render_in_steps(run, assets, nullptr, [&](run::Engine& engine) {
        engine.advance(0);
        turned.turn(1, engine);
        CHECK(turned.level() == Approx(0.5 * std::pow(10.0, 0.05)));
        turned.turn(100, engine);
        CHECK(turned.level() == 0.8);
        const std::size_t turns = turned.turns().size();
        turned.turn(3, engine);  // nothing is above
        CHECK(turned.turns().size() == turns);
        turned.turn(-1, engine);
        CHECK(turned.level() < 0.8);
        CHECK(turned.level() > 0.7);
        turned.turn(-100, engine);
        CHECK(turned.level() == 0.005);
        CHECK_FALSE(turned.matched_at());
        CHECK_FALSE(ports.over());
        turned.answer(2, engine);
        CHECK(turned.matched_at());
        CHECK(ports.over());
    });
    // Each was rendered from a time on that is stored.
    for (std::size_t i = 1; i < turned.turns().size(); ++i) CHECK(turned.turns()[i].time >= turned.turns()[i - 1].time);
}

TEST_CASE("a simulated subject turns until the rendered level matches, and the takes give the same bits", "[long]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    const experiment::Protocol protocol = adjustment_protocol(scratch.path(), 8);
    ExperimentChoice choice = adjusting_subject(protocol, scratch.path() / "data");
    choice.model->observer.spread = 0.0;
    choice.model->observer.match_spread = 0.02;
    choice.model->observer.match_lag = 0.1;
    const ExperimentEnd end = run_experiment(choice, quiet_hooks(), never);
    CHECK(end.is_complete);
    CHECK(end.marked == 0);
    for (const TrialRecord& trial : experiment::load_trials(choice.out / "sub-P01/trials.jsonl")) {
        CAPTURE(trial.number);
        REQUIRE(trial.match);
        CHECK(trial.is_correct);
        CHECK(trial.level != *trial.match);
        CHECK(*trial.rendered_level == Approx(*trial.match).epsilon(0.001));
        CHECK(trial.turns.back().level == *trial.match);
    }
    const TakeCheck check = check_takes(choice.out);
    CHECK(check.trials == 8);
    CHECK(check.values == 8);
    CHECK(check.differences.empty());
    const ExperimentAnalysis analysis = analyse_experiment(choice.out, {});
    const SubjectThreshold& one = analysis.subjects.front().thresholds.front();
    REQUIRE(one.adjusted);
    REQUIRE(one.threshold);
    CHECK(one.adjusted->below_count == 4);
    CHECK(one.adjusted->above_count == 4);
    // The subject stops 0.1 early from either end; the steps are 0.05, so that a match is uncertain by half of that.
    CHECK(one.adjusted->above - one.adjusted->below == Approx(0.2).margin(0.05));
    CHECK(*one.threshold == Approx(0.25).epsilon(0.08));
    CHECK(one.adjusted->deviation < 0.06);
    // In the table of BIDS as well.
    write_bids(analysis, choice.out);
    const std::string table = file::read_whole_file(choice.out / "sub-P01/beh/sub-P01_task-intensity_beh.tsv");
    CHECK(table.find("level\tmatch\tturns\tlevel_rendered") != std::string::npos);
}

TEST_CASE("an adjustment that finds no match in its time is marked, repeated once and left out", "[slow]") {
    const run::ScratchFolder scratch;
    const std::atomic<bool> never{false};
    const experiment::Protocol protocol = adjustment_protocol(scratch.path(), 2, [](const auto& replace) {
        replace("step   = 0.05 ", "step   = 0.001\npresentations = 2 ");
    });
    const ExperimentChoice choice = adjusting_subject(protocol, scratch.path() / "data");
    const ExperimentEnd end = run_experiment(choice, quiet_hooks(), never);
    CHECK(end.is_complete);
    CHECK(end.trials == 4);
    CHECK(end.marked == 4);
    for (const TrialRecord& trial : experiment::load_trials(choice.out / "sub-P01/trials.jsonl")) {
        CHECK_FALSE(trial.match);
        CHECK(trial.marked == "it ended after 6 s without a match");
    }
    CHECK_FALSE(analyse_experiment(choice.out, {}).subjects.front().thresholds.front().threshold);
}

TEST_CASE("a sound beyond the limit of an experiment is refused before the session and limited in it", "[slow]") {
    const run::ScratchFolder scratch;
    const auto with_limit = [&](const std::string& limit) {
        return adjustment_protocol(scratch.path(), 2,
                                   [&](const auto& replace) { replace("sound = \"-1 dBFS\"", "sound = " + limit); });
    };
    compile::AssetCache assets;
    // The loudest level, 0.8, is -1.9 dBFS.
    CHECK_NOTHROW(check_levels(with_limit("\"-1 dBFS\""), assets, {}, nullptr));
    CHECK_NOTHROW(check_levels(with_limit("{speaker = 0.81}"), assets, {}, nullptr));
    CHECK_THROWS_WITH(check_levels(with_limit("\"-6 dBFS\""), assets, {}, nullptr),
                      Catch::Matchers::ContainsSubstring("'speaker' would play -1.9 dBFS") &&
                          Catch::Matchers::ContainsSubstring("its limit of -6.0 dBFS"));
    CHECK_THROWS_WITH(check_levels(with_limit("{speaker = 0.5}"), assets, {}, nullptr),
                      Catch::Matchers::ContainsSubstring("louder than its limit"));
    CHECK_THROWS_WITH(check_levels(with_limit("{speker = 0.5}"), assets, {}, nullptr),
                      Catch::Matchers::ContainsSubstring("no audio output 'speker'; did you mean 'speaker'"));
    // --set does not lift it.
    CHECK_THROWS_WITH(check_levels(with_limit("\"-6 dBFS\""), assets, {"speaker.limit=1"}, nullptr),
                      Catch::Matchers::ContainsSubstring("louder than its limit"));
    // A limit in the unit of the signal follows the full scale of the output.
    CHECK_NOTHROW(check_levels(with_limit("{speaker = 0.81}"), assets, {"speaker.full_scale=2"}, nullptr));
    // Where the full scale is not one number, neither is such a limit.
    const auto caps = [&](experiment::Protocol protocol, const std::string& stimulus, const std::string& wired) {
        if (!stimulus.empty()) protocol.stimulus->parameters = {stimulus};
        std::string patch = file::read_whole_file(protocol.patch);
        if (!wired.empty()) patch.insert(patch.find("wires = [") + 9, "\n  \"second.out -> " + wired + "\",");
        std::ofstream(scratch.path() / "patches/driven.toml") << patch;
        run::RunChoice run;
        run.patch = (scratch.path() / "patches/driven.toml").string();
        return sound_settings(protocol, run::load_plan(run, assets));
    };
    CHECK(caps(with_limit("{speaker = 0.81}"), "", "").size() == 1);
    CHECK(caps(with_limit("\"-6 dBFS\""), "speaker.full_scale", "").size() == 1);
    CHECK_THROWS_WITH(caps(with_limit("{speaker = 0.81}"), "speaker.full_scale", ""),
                      Catch::Matchers::ContainsSubstring("changes the full scale of 'speaker'"));
    CHECK_THROWS_WITH(caps(with_limit("{speaker = 0.81}"), "", "speaker.full_scale"),
                      Catch::Matchers::ContainsSubstring("drives the full scale of 'speaker'"));
    CHECK_THROWS_WITH(caps(with_limit("\"-6 dBFS\""), "speaker.limit", ""),
                      Catch::Matchers::ContainsSubstring("changes the limit of 'speaker'"));
    // In a session: half of the amplitude at which the subject's matches are.
    const std::atomic<bool> never{false};
    ExperimentChoice choice = adjusting_subject(with_limit("{speaker = 0.05}"), scratch.path() / "data");
    run_experiment(choice, quiet_hooks(), never);
    const auto trials = experiment::load_trials(choice.out / "sub-P01/trials.jsonl");
    REQUIRE_FALSE(trials.empty());
    for (const TrialRecord& trial : trials) {
        CHECK(trial.sound_limited > 0.01);
        CHECK(trial.marked.find("the sound was limited") == 0);
    }
}
