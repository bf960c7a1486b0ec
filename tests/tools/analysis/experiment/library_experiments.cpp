// SPDX-License-Identifier: Apache-2.0
// The evaluations of the thesis as experiments of the library: their patches give every measure, and simulated subjects show what the
// patch makes of their errors.
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/run_experiment.hpp"

#include "assets/experiment/observer_model.hpp"
#include "assets/experiment/records.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/run/scratch_folder.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::analysis;

namespace {

/// Trials of one simulated subject, each condition `repetitions` times and without practice.
std::vector<experiment::TrialRecord> trials_of_library(const std::string& name, int repetitions,
                                                       const std::vector<std::string>& settings = {}) {
    const run::ScratchFolder scratch;
    const auto folder = test::library_folder() / "experiments";
    ExperimentChoice choice;
    choice.protocol = experiment::load_protocol(folder / (name + ".toml"));
    choice.protocol.practice.needed = 0;
    for (experiment::Task& task : choice.protocol.tasks) task.repetitions = repetitions;
    choice.out = scratch.path() / "data";
    choice.subject = "P01";
    choice.model = experiment::load_observer_model(folder / "models" / (name + ".toml"), "");
    choice.settings = settings;
    ExperimentHooks hooks;
    hooks.say = [](const std::string&) {};
    const std::atomic<bool> never{false};
    REQUIRE(run_experiment(choice, hooks, never).is_complete);
    return experiment::load_trials(choice.out / "sub-P01/trials.jsonl");
}

}  // namespace

// Costly: trials of a simulated subject.
TEST_CASE("a fragment that misses its place is drawn there, and is left where it is without the pull", "[slow]") {
    std::map<std::string, std::vector<double>> errors;
    for (const experiment::TrialRecord& trial : trials_of_library("snap", 3)) {
        CAPTURE(trial.condition, trial.number);
        CHECK(trial.marked.empty());
        for (const char* measure : {"error", "angle", "time"}) REQUIRE(trial.measures.count(measure) == 1);
        CHECK(trial.measures.at("time") > 5.0);
        errors[trial.condition].push_back(trial.measures.at("error"));
    }
    REQUIRE(errors["pull"].size() == 3);
    REQUIRE(errors["free"].size() == 3);
    for (auto& [condition, values] : errors) std::sort(values.begin(), values.end());
    CAPTURE(errors["pull"], errors["free"]);
    CHECK(errors["pull"][1] < 0.2 * mm);
    CHECK(errors["free"][1] > 3.0 * errors["pull"][1]);
}

TEST_CASE("a simulated subject saws to the planned depth, and worse where the model says so", "[long]") {
    std::map<std::string, double> deviation;
    for (const experiment::TrialRecord& trial : trials_of_library("saw", 1)) {
        CAPTURE(trial.condition);
        CHECK(trial.marked.empty());
        for (const char* measure : {"overshoot", "deviation", "thrust", "time"})
            REQUIRE(trial.measures.count(measure) == 1);
        CHECK(trial.measures.at("overshoot") > 0.0);
        CHECK(trial.measures.at("overshoot") < 2.0 * mm);
        CHECK(trial.measures.at("deviation") < 1.5 * mm);
        CHECK(trial.measures.at("thrust") > 1.0);
        deviation[trial.condition] = trial.measures.at("deviation");
    }
    // The model's error is 1.6 times as large without vibration.
    CAPTURE(deviation);
    REQUIRE(deviation.size() == 2);
    CHECK(deviation["still"] > 1.2 * deviation["vibration"]);
}

TEST_CASE("the gripper gives the stiffness that its experiment asks for, in both intervals") {
    const experiment::Protocol protocol =
        experiment::load_protocol(test::library_folder() / "experiments/gripper.toml");
    compile::AssetCache assets;
    std::vector<std::string> said;
    CHECK_NOTHROW(check_levels(protocol, assets, {}, [&](const std::string& line) { said.push_back(line); }));
    CHECK(said.size() == 8);
    // Fingers that squeeze harder than the motor holds make it slip.
    CHECK_THROWS_WITH(check_levels(protocol, assets, {"simulated.squeeze=25 mm"}, nullptr),
                      Catch::Matchers::ContainsSubstring("misses the level"));
    CHECK_THROWS_WITH(check_levels(protocol, assets, {"simulated.squeeze_period=2 s"}, nullptr),
                      Catch::Matchers::ContainsSubstring("'squeeze_period' ends before the finger is open again"));
}
