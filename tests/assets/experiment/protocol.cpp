// SPDX-License-Identifier: Apache-2.0
#include "assets/experiment/protocol.hpp"
#include "assets/experiment/observer_model.hpp"
#include "assets/experiment/records.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <string>

using namespace tactus;
using namespace tactus::experiment;
namespace fs = std::filesystem;

namespace {

const std::string good = R"(format = 1
title  = "Try"
name   = "try"
order  = "latin_square"
[[condition]]
name = "one"
factors = {size = "small"}
[[condition]]
name = "two"
factors = {size = "large"}
standard = "2 N/mm"
[trial]
patch  = "some.toml"
length = "4 s"
[stimulus]
parameters = ["a.stiffness", "b.stiffness"]
unit = "N/mm"
standard = "1 N/mm"
relative = true
min = 0.01
max = 1
windows = [["0 s", "2 s"], ["2 s", "4 s"]]
measure = {kind = "rms", port = "a.out"}
[response]
kind = "choice"
[method]
kind = "quest_plus"
trials = 10
)";

/// A folder with a patch and the file `text`, gone with the object.
struct Folder {
    Folder() : path(fs::temp_directory_path() / fmt::format("tactus-experiment-{}", ::getpid())) {
        fs::create_directories(path);
        std::ofstream(path / "some.toml") << "title = \"x\"\n";
    }
    ~Folder() { fs::remove_all(path); }
    fs::path write(const std::string& text, const char* name = "try.toml") const {
        std::ofstream(path / name) << text;
        return path / name;
    }
    fs::path path;
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

std::string error_of(const Folder& folder, const std::string& text) {
    try {
        load_protocol(folder.write(text));
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("a protocol is read with its units, levels and orders") {
    const Folder folder;
    const Protocol p = load_protocol(folder.write(good));
    CHECK(p.is_psychophysics());
    CHECK(p.standard(0) == 1000.0);
    CHECK(p.standard(1) == 2000.0);
    CHECK(p.parameter(1, 0.25) == 2500.0);
    CHECK(p.length == 4.0);
    CHECK(p.response.keys == std::vector<std::string>{"1", "2"});
    CHECK(p.stimulus->level_at(p.stimulus->axis(0.3)) == Approx(0.3));
    CHECK(condition_order(p, 0) == std::vector<std::size_t>{0, 1});
    CHECK(condition_order(p, 1) == std::vector<std::size_t>{1, 0});
    CHECK(balance_warning(p, 16).empty());
    CHECK_FALSE(balance_warning(p, 15).empty());
    CHECK(p.files().size() == 2);
}

TEST_CASE("errors of a protocol have their line and what to do") {
    const Folder folder;
    const auto fails = [&](const std::string& what, const std::string& by, const std::string& message) {
        const std::string error = error_of(folder, replaced(good, what, by));
        INFO(error);
        CHECK(error.find(message) != std::string::npos);
        CHECK(error.find("try.toml:") != std::string::npos);
    };
    fails("trials = 10", "trails = 10", "unknown key 'trails'");
    fails("trials = 10", "trails = 10", "did you mean 'trials'");
    fails("trials = 10", "trials = 0", ":28:");
    fails("\"quest_plus\"", "\"quest\"", "is none of quest_plus, staircase, constant");
    fails("max = 1", "max = 0.001", "the greatest level must be above the least");
    fails("\"1 N/mm\"", "\"1 mm\"", "N/mm");
    fails("\"1 N/mm\"", "\"0 N/mm\"", "relative to a standard of 0");
    fails("[\"2 s\", \"4 s\"]", "[\"2 s\", \"5 s\"]", "before the trial ends");
    fails("\"a.stiffness\", \"b.stiffness\"", "\"a.stiffness\"", "each interval needs a parameter and a window");
    fails("name = \"two\"", "name = \"one\"", "two conditions are called 'one'");
    fails("name = \"two\"", "name = \"t-wo\"", "letters and digits");
    fails("{size = \"large\"}", "{colour = \"red\"}", "does not have the same factors");
    fails("some.toml", "none.toml", "there is no file");
    fails("format = 1", "format = 2", "reads format 1");
    fails("order  = \"latin_square\"", "order  = \"co_location\"", "four conditions and three tasks");
    fails("port = \"a.out\"", "port = \"a.out\", unit = \"furlong\"", "furlong");
    fails("min = 0.01\nmax = 1", "min = 0.11\nmax = 0.19\nstep = 0.1", "no multiple of the step");
    fails("[response]", "[[task]]\nname = \"x\"\n[response]", "either [[task]] or");
    CHECK(error_of(folder, "") != "none");
    CHECK(error_of(folder, good + "[[comparison]]\nfactor = \"size\"\na = \"small\"\nb = \"small\"\n")
              .find("compared with itself") != std::string::npos);
    CHECK(error_of(folder, good + "[[comparison]]\nfactor = \"size\"\na = \"smal\"\nb = \"large\"\n")
              .find("did you mean 'small'") != std::string::npos);
}

TEST_CASE("each order of conditions meets each order of tasks equally often, from 8 to 48 subjects") {
    for (const std::size_t conditions : {2, 3, 4, 6})
        for (const std::size_t tasks : {1, 2, 3, 4}) {
            Protocol p;
            p.order = OrderKind::williams;
            p.conditions.resize(conditions);
            p.tasks.resize(tasks);
            const std::size_t rows = (conditions % 2 == 0 ? conditions : 2 * conditions) * tasks;
            CAPTURE(conditions, tasks);
            std::map<std::pair<std::vector<std::size_t>, std::vector<std::size_t>>, int> pairs;
            for (std::size_t row = 0; row < rows; ++row) ++pairs[{condition_order(p, row), task_order(p, row)}];
            CHECK(pairs.size() == rows);
            for (std::size_t subjects = 8; subjects <= 48; ++subjects)
                CHECK(balance_warning(p, subjects).empty() == (subjects % rows == 0));
            // Neighbours begin with other tasks.
            if (tasks > 1 && std::gcd(rows / tasks, tasks) == 1) CHECK(task_order(p, 0) != task_order(p, 1));
        }
}

TEST_CASE("constant levels are multiples of the step") {
    const Folder folder;
    const std::string text = replaced(replaced(good, "max = 1\n", "max = 1\nstep = 0.1\n"), "kind = \"quest_plus\"",
                                      "kind = \"constant\"\nlevels = [0.1, 0.3]");
    CHECK(error_of(folder, text) == "none");
    CHECK(error_of(folder, replaced(text, "[0.1, 0.3]", "[0.1, 0.35]")).find("0.35 is no multiple of the step") !=
          std::string::npos);
}

TEST_CASE("a method refuses the keys of another one") {
    const Folder folder;
    const auto with = [&](const std::string& method) {
        return error_of(folder, replaced(good, "kind = \"quest_plus\"\ntrials = 10", method));
    };
    CHECK(with("kind = \"quest_plus\"\ntrials = 10") == "none");
    CHECK(with("kind = \"quest_plus\"\ntrials = 10\nreversals = 8").find("unknown key 'reversals'") !=
          std::string::npos);
    CHECK(with("kind = \"quest_plus\"\ntrials = 10\nlevels = [0.1, 0.2]").find("unknown key 'levels'") !=
          std::string::npos);
    CHECK(with("kind = \"staircase\"\ntrials = 10\nlevels = [0.1, 0.2]").find("unknown key 'levels'") !=
          std::string::npos);
    CHECK(with("kind = \"constant\"\ntrials = 10\nlevels = [0.1, 0.2]\nstart = 0.1").find("unknown key 'start'") !=
          std::string::npos);
    CHECK(with("kind = \"adjustment\"\ntrials = 10").find("belong together") != std::string::npos);
}

TEST_CASE("an adjustment has an even number of trials, steps within its range and no catch trials") {
    const Folder folder;
    const std::string text = replaced(replaced(good, "kind = \"choice\"", "kind = \"adjust\""),
                                      "kind = \"quest_plus\"\ntrials = 10", "kind = \"adjustment\"\ntrials = 10");
    const Protocol p = load_protocol(folder.write(text));
    CHECK(p.is_adjustment());
    CHECK(p.response.keys == std::vector<std::string>{"-", "+", "m"});
    CHECK(p.method.step == Approx(0.04));  // 2 % of two decades
    CHECK(p.trial_length() == Approx(80.0));
    CHECK(p.begins_above(0.9));
    CHECK_FALSE(p.begins_above(0.02));
    const auto fails = [&](const std::string& what, const std::string& by, const std::string& message) {
        const std::string error = error_of(folder, replaced(text, what, by));
        INFO(error);
        CHECK(error.find(message) != std::string::npos);
    };
    fails("trials = 10", "trials = 9", "must be even");
    fails("trials = 10", "trials = 10\nstep = 1.5", "a number from");
    fails("trials = 10", "trials = 10\nstarts = 0.6", "a number from");
    fails("trials = 10", "trials = 10\ntarget = 0.75", "unknown key 'target'");
    fails("format = 1", "format = 1\ncatch_rate = 0.1", "no catch trials");
    fails("kind = \"adjust\"", "kind = \"choice\"", "belong together");
}

TEST_CASE("limits of sound are in decibels of full scale or in the unit of the signal") {
    const Folder folder;
    const Protocol all = load_protocol(folder.write(good + "[limits]\nsound = \"-20 dBFS\"\n"));
    REQUIRE(all.limits.sound.size() == 1);
    CHECK(all.limits.sound[0].output.empty());
    CHECK(all.limits.sound[0].level == Approx(0.1));
    CHECK(all.limits.sound[0].is_of_full_scale);
    const Protocol some =
        load_protocol(folder.write(good + "[limits]\nsound = {phones = \"0 dBFS\", speaker = 1.5}\n"));
    REQUIRE(some.limits.sound.size() == 2);
    CHECK(some.limits.sound[0].output == "phones");
    CHECK(some.limits.sound[1].level == 1.5);
    CHECK_FALSE(some.limits.sound[1].is_of_full_scale);
    for (const char* bad : {"\"-20 dB\"", "\"3 dBFS\"", "\"loud\"", "0", "-1", "true", "\"-20 dBFS \""}) {
        CAPTURE(bad);
        CHECK(error_of(folder, good + "[limits]\nsound = " + bad + "\n") != "none");
    }
}

TEST_CASE("levels on a grid are whole steps within the range") {
    const Folder folder;
    Stimulus stimulus = *load_protocol(folder.write(good)).stimulus;
    CHECK(stimulus.presentable(0.1234) == 0.1234);
    stimulus.step = 0.1;
    CHECK(stimulus.presentable(0.26) == 3 * 0.1);
    CHECK(stimulus.presentable(0.01) == 0.1);
    CHECK(stimulus.presentable(7.0) == Approx(1.0));
}

TEST_CASE("a table of orders names conditions and has a row for each subject") {
    const Folder folder;
    folder.write("# subject by subject\ntwo, one\none, two\n", "orders.csv");
    const std::string text =
        replaced(good, "order  = \"latin_square\"", "order = \"table\"\norder_file = \"orders.csv\"");
    const Protocol p = load_protocol(folder.write(text));
    CHECK(condition_order(p, 0) == std::vector<std::size_t>{1, 0});
    CHECK_THROWS_WITH(condition_order(p, 2), Catch::Matchers::ContainsSubstring("add a row"));
    folder.write("two, on\n", "orders.csv");
    CHECK_THROWS_WITH(load_protocol(folder.write(text)), Catch::Matchers::ContainsSubstring("orders.csv:1"));
}

TEST_CASE("orders of the bundled co-location study are balanced for its sixteen subjects") {
    const Protocol p = load_protocol(test::source_folder() / "assets/library/experiments/co-location.toml");
    std::map<std::string, int> first;
    std::map<std::vector<std::size_t>, int> tasks;
    for (std::size_t row = 0; row < 16; ++row) {
        const auto order = condition_order(p, row);
        CHECK(order.size() == 4);
        ++first[p.conditions[order.front()].factors.at("display")];
        ++first[p.conditions[order.front()].factors.at("mode")];
        // Both modes on one display, then both on the other.
        CHECK(p.conditions[order[0]].factors.at("display") == p.conditions[order[1]].factors.at("display"));
        CHECK(p.conditions[order[2]].factors.at("display") != p.conditions[order[1]].factors.at("display"));
        ++tasks[task_order(p, row)];
    }
    for (const auto& [level, times] : first) CHECK(times == 8);
    CHECK(tasks.size() == 6);
    CHECK(balance_warning(p, 16).empty());
    for (const std::size_t other : {8, 12, 17, 24, 48}) CHECK(balance_warning(p, other).empty() == (other % 16 == 0));
}

TEST_CASE("every bundled experiment and model of subjects can be read") {
    const fs::path library = test::source_folder() / "assets/library/experiments";
    int read = 0;
    for (const auto& entry : fs::directory_iterator(library)) {
        if (entry.path().extension() != ".toml") continue;
        const Protocol p = load_protocol(entry.path());
        const fs::path model = library / "models" / entry.path().filename();
        INFO(model.string());
        const ObserverModel of = load_observer_model(model, p.stimulus ? p.stimulus->level_unit() : std::string());
        CHECK((p.is_psychophysics() ? of.has_observer : of.has_hand));
        ++read;
    }
    CHECK(read >= 4);
}

TEST_CASE("trials survive writing to the bit, with nothing to measure too") {
    const Folder folder;
    TrialRecord trial;
    trial.number = 3;
    trial.phase = Phase::repeat;
    trial.condition = "one";
    trial.folder = "trial-0003";
    trial.level = 0.1 + 0.2;
    trial.interval = 2;
    trial.rendered = {1.0 / 3.0, std::numeric_limits<double>::quiet_NaN()};
    trial.response_time = 0.7;
    trial.marked = "a gap of 7 ms";
    TrialRecord task = trial;
    task.task = "cube";
    task.measures = {{"time", 12.345678901234567}};
    save_trials({trial, task}, folder.path / "trials.jsonl");
    const auto read = load_trials(folder.path / "trials.jsonl");
    REQUIRE(read.size() == 2);
    CHECK(read[0].level == trial.level);
    CHECK(read[0].rendered[0] == trial.rendered[0]);
    CHECK(std::isnan(read[0].rendered[1]));
    CHECK_FALSE(read[0].rendered_level);
    CHECK(read[0].phase == Phase::repeat);
    CHECK(read[0].marked == trial.marked);
    CHECK(read[1].measures == task.measures);
    CHECK(load_trials(folder.path / "none").empty());
    std::ofstream(folder.path / "trials.jsonl", std::ios::app) << "{\"number\": 4}\n";
    CHECK_THROWS_WITH(load_trials(folder.path / "trials.jsonl"), Catch::Matchers::ContainsSubstring("trials.jsonl:3"));
}

TEST_CASE("a level near zero is held to a part of the range") {
    Stimulus stimulus;
    stimulus.min = -0.5;
    stimulus.max = 0.5;
    stimulus.tolerance = 0.1;
    stimulus.is_log = false;
    CHECK(stimulus.is_rendered(0.0, 2.2e-16));
    CHECK_FALSE(stimulus.is_rendered(0.0, 0.01));
    CHECK(stimulus.is_rendered(0.5, 0.46));
    CHECK_FALSE(stimulus.is_rendered(0.5, 0.44));
}

TEST_CASE("a folder of an experiment whose names lead out of it is refused") {
    const Folder folder;
    ExperimentFile file;
    file.name = "try";
    file.subjects.push_back({});
    file.subjects.back().pseudonym = "../victim";
    save_experiment_file(file, folder.path / "experiment.json");
    CHECK_THROWS_WITH(load_experiment_file(folder.path / "experiment.json"),
                      Catch::Matchers::ContainsSubstring("is no pseudonym"));
    file.subjects.back().pseudonym = "P01";
    file.files.push_back({"../../etc/x", "0"});
    save_experiment_file(file, folder.path / "experiment.json");
    CHECK_THROWS_WITH(load_experiment_file(folder.path / "experiment.json"),
                      Catch::Matchers::ContainsSubstring("outside of the folder"));
}

TEST_CASE("a record whose folder leads elsewhere is refused") {
    const Folder folder;
    TrialRecord trial;
    trial.folder = "../../home";
    save_trials({trial}, folder.path / "trials.jsonl");
    CHECK_THROWS_AS(load_trials(folder.path / "trials.jsonl"), Error);
}
