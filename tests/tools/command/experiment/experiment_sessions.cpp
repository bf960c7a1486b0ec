// SPDX-License-Identifier: Apache-2.0
// Experiments by the command, as a laboratory runs them: killed, with a full disk, two at once, with errors in every key.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;
namespace fs = std::filesystem;

namespace {

/// Seven subjects, three factors, catch trials, orders of a table: nobody built the program for it.
constexpr const char* own_experiment = R"(format = 1
title = "Own experiment"
name = "own"
seed = 12
subjects = 7
order = "table"
order_file = "orders.csv"
catch_rate = 0.2
break_every = 5
consent = false
[[condition]]
name = "slowLow"
factors = {frequency = "80 Hz", length = "short", ground = "quiet"}
settings = ["carrier.frequency=80 Hz"]
[[condition]]
name = "fastLow"
factors = {frequency = "200 Hz", length = "short", ground = "quiet"}
settings = ["carrier.frequency=200 Hz"]
[[condition]]
name = "slowHigh"
factors = {frequency = "80 Hz", length = "short", ground = "loud"}
settings = ["carrier.frequency=80 Hz"]
standard = 0.01
[[condition]]
name = "fastHigh"
factors = {frequency = "200 Hz", length = "short", ground = "loud"}
settings = ["carrier.frequency=200 Hz"]
standard = 0.01
[trial]
patch = "pair.toml"
length = "3 s"
[stimulus]
parameters = ["first.factor", "second.factor"]
standard = 0
min = 0.01
max = 0.5
windows = [["0.3 s", "1.1 s"], ["1.7 s", "2.5 s"]]
measure = {kind = "rms", port = "limited.out", scale = 1.4142135623730951}
[response]
kind = "choice"
[method]
kind = "constant"
trials = 1
levels = [0.02, 0.1]
[practice]
needed = 1
[limits]
sound = "0 dBFS"
[exclusion]
min_catch_correct = 0.5
[[comparison]]
factor = "frequency"
a = "80 Hz"
b = "200 Hz"
margin = 0.9
within = {ground = "quiet"}
[[comparison]]
factor = "ground"
a = "quiet"
b = "loud"
)";

constexpr const char* own_model = "format = 1\n[observer]\nthreshold = 0.05\nspread = 0.1\n";

void write_own(const Folder& folder) {
    fs::copy_file(tactus::test::library_folder() / "experiments/patches/vibration-pair.toml",
                  folder.path / "pair.toml");
    folder.write("own.toml", own_experiment);
    folder.write("model.toml", own_model);
    std::string orders;
    for (int subject = 0; subject < 7; ++subject)
        orders +=
            subject % 2 == 0 ? "slowLow, fastLow, slowHigh, fastHigh\n" : "fastHigh, slowHigh, fastLow, slowLow\n";
    folder.write("orders.csv", orders);
}

std::string at(const Folder& folder, const char* name) { return (folder.path / name).string(); }

std::string run_own(const Folder& folder, const std::string& more) {
    return fmt::format("experiment run {} --simulate {} {}", at(folder, "own.toml"), at(folder, "model.toml"), more);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

}  // namespace

TEST_CASE("a typo in each key of an experiment is refused with its line, and nothing is made", "[slow]") {
    const Folder folder;
    write_own(folder);
    const std::vector<std::string> lines = lines_of(own_experiment);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].empty() || lines[i].front() == '\n') continue;
        std::string text;
        for (std::size_t other = 0; other < lines.size(); ++other) {
            std::string line = lines[other];
            // The first letter of a key, or of the name of a table, is doubled.
            if (other == i) line.insert(line.find_first_not_of('['), 1, line[line.find_first_not_of('[')]);
            text += line + "\n";
        }
        folder.write("typo.toml", text);
        const Outcome o =
            folder.tactus(fmt::format("experiment run {} --simulate {} --subject P01 --out {}", at(folder, "typo.toml"),
                                      at(folder, "model.toml"), at(folder, "data")));
        CAPTURE(lines[i], o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find("typo.toml:") != std::string::npos);
        CHECK_FALSE(fs::exists(folder.path / "data"));
    }
}

TEST_CASE("seven subjects with three factors, catch trials and a table of orders are run and analysed", "[long]") {
    const Folder folder;
    write_own(folder);
    const std::string out = at(folder, "data");
    Outcome o = folder.tactus(run_own(folder, "--subjects 7 --no-takes --out " + out));
    INFO(o.err);
    REQUIRE(o.code == 0);
    // Trials of the first subject: its row, catch trials at the greatest level beside two levels of each condition.
    int main = 0;
    std::string conditions;
    for (const std::string& line : lines_of(slurp(folder.path / "data/sub-S01/trials.jsonl"))) {
        main += line.find("\"phase\":\"main\"") != std::string::npos ? 1 : 0;
        for (const char* name : {"slowLow", "fastLow", "slowHigh", "fastHigh"})
            if (line.find(fmt::format("\"condition\":\"{}\"", name)) != std::string::npos &&
                !conditions.ends_with(name))
                conditions += name;
    }
    CHECK(main == 8);
    // A fifth of 7 times 8 trials or more.
    int caught = 0;
    for (int subject = 1; subject <= 7; ++subject)
        for (const std::string& line :
             lines_of(slurp(folder.path / fmt::format("data/sub-S{:02}/trials.jsonl", subject))))
            if (line.find("\"phase\":\"catch\"") != std::string::npos) {
                ++caught;
                CHECK(line.find("\"level\":0.5,") != std::string::npos);
            }
    CHECK(caught >= 4);
    CHECK(caught <= 28);
    CHECK(conditions == "slowLowfastLowslowHighfastHigh");
    o = folder.tactus("experiment analyse " + out + " --carry-over --bootstrap 0");
    INFO(o.out);
    CHECK(o.code == 0);
    CHECK(o.out.find("frequency 200 Hz - 80 Hz (quiet)") != std::string::npos);
    CHECK(o.out.find("no effect") == std::string::npos);
    // An eighth has no row.
    o = folder.tactus(run_own(folder, "--subject P08 --no-takes --out " + out));
    CHECK(o.code == 2);
    CHECK(o.err.find("has 7 rows, but this is subject 8") != std::string::npos);
    // One withdraws: no file names it any more, and the next one gets its row.
    o = folder.tactus("experiment withdraw " + out + " --subject S03");
    CHECK(o.code == 0);
    CHECK(std::system(fmt::format("grep -rq S03 {}", out).c_str()) != 0);
    o = folder.tactus(run_own(folder, "--subject P08 --no-takes --out " + out));
    CHECK(o.code == 0);
    CHECK(slurp(folder.path / "data/experiment.json").find("\"freed_rows\": []") != std::string::npos);
}

TEST_CASE("a session that is killed within trials ends as one that was not", "[slow]") {
    const Folder folder;
    write_own(folder);
    // Two of its conditions and one of its comparisons: each start renders the ends of the range of each condition.
    std::string text = own_experiment;
    text.erase(text.find("[[condition]]\nname = \"slowHigh\""),
               text.find("[trial]") - text.find("[[condition]]\nname = \"slowHigh\""));
    text.erase(text.rfind("[[comparison]]"));
    folder.write("own.toml", text);
    folder.write("orders.csv", "slowLow, fastLow\n");
    const std::string out = at(folder, "data"), whole = at(folder, "whole");
    REQUIRE(folder.tactus(run_own(folder, "--subject P01 --out " + whole)).code == 0);
    const fs::path subject = folder.path / "data/sub-P01", kept = subject / "trials.jsonl";
    // A trial has a folder as soon as it begins, and a line when it came to its end.
    const auto kept_trials = [&] { return fs::exists(kept) ? lines_of(slurp(kept)).size() : 0U; };
    const auto trial_folder = [&](std::size_t number) { return subject / fmt::format("trial-{:04}", number); };
    // Killed when the folder of a trial exists. A machine that is busy may let the trial end first: then in a later one.
    int inside = 0;
    for (std::size_t number = 1; inside < 2 && number <= 7; number = kept_trials() + 2) {
        folder.write("kill.sh", fmt::format("{} {} > /dev/null 2>&1 & until [ -d {} ]; do kill -0 $! || exit 1; done; "
                                            "kill -KILL $!; wait $!; [ $? = 137 ]",
                                            tactus::test::command(), run_own(folder, "--subject P01 --out " + out),
                                            trial_folder(number).string()));
        if (std::system(fmt::format("sh {} 2> /dev/null", at(folder, "kill.sh")).c_str()) != 0) break;
        inside += fs::exists(trial_folder(number)) && kept_trials() == number - 1 ? 1 : 0;
    }
    REQUIRE(inside == 2);
    REQUIRE(folder.tactus(run_own(folder, "--subject P01 --out " + out)).code == 0);
    CHECK(slurp(kept) == slurp(folder.path / "whole/sub-P01/trials.jsonl"));
    const Outcome o = folder.tactus("experiment analyse " + out + " --takes --bootstrap 0");
    CAPTURE(o.out, o.err);
    CHECK(o.code == 0);
    CHECK(o.out.find("all equal to the bit") != std::string::npos);
}

TEST_CASE("an analysis is also written as the endings of -o ask, and refuses one that no format has") {
    const Folder folder;
    write_own(folder);
    const std::string out = at(folder, "data");
    REQUIRE(folder.tactus(run_own(folder, "--subject P01 --no-takes --out " + out)).code == 0);
    const std::string analyse = fmt::format("experiment analyse {} --quiet --bootstrap 0 -o ", out);
    const Outcome o = folder.tactus(fmt::format("{0}{1} -o {2} -o {3}", analyse, at(folder, "a.pdf"), at(folder, "a.txt"),
                                                at(folder, "a.json")));
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.out.empty());
    CHECK(slurp(folder.path / "a.pdf").starts_with("%PDF"));
    CHECK(slurp(folder.path / "a.txt").starts_with("Own experiment"));
    CHECK(slurp(folder.path / "a.json") == slurp(folder.path / "data/results.json"));
    CHECK(fs::exists(folder.path / "data/report.html"));
    CHECK(folder.tactus(analyse + at(folder, "a.docx")).code == 2);
    // One subject has no difference to draw: the figure is that of its answers.
    for (const char* name : {"a.svg", "a.png"}) {
        const Outcome figure = folder.tactus(analyse + at(folder, name));
        CAPTURE(name, figure.err);
        CHECK(figure.code == 0);
        CHECK(fs::file_size(folder.path / name) > 1000);
    }
}

TEST_CASE("an analysis replaces its own results in the folder of the data and nothing else") {
    const Folder folder;
    write_own(folder);
    const std::string out = at(folder, "data");
    REQUIRE(folder.tactus(run_own(folder, "--subject P01 --no-takes --out " + out)).code == 0);
    const std::string analyse = fmt::format("experiment analyse {} --quiet --bootstrap 0 -o {}/", out, out);
    for (const char* name : {"report.csv", "results.txt", "report.svg", "results.json"})
        for (int time = 0; time < 2; ++time) {
            const Outcome o = folder.tactus(analyse + name);
            CAPTURE(name, o.err);
            CHECK(o.code == 0);
            CHECK(fs::exists(folder.path / "data" / name));
        }
    for (const char* name :
         {"experiment.json", "frozen/orders.csv", "participants.json", "dataset_description.json", "sub-P01/new.csv",
          "sub-P01/trial-0001/run/report.json", "new.svg", "frozen/report.html"}) {
        const fs::path file = folder.path / "data" / name;
        const std::string before = fs::exists(file) ? slurp(file) : "";
        const Outcome o = folder.tactus(analyse + name);
        CAPTURE(name, o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find(name) != std::string::npos);
        CHECK((fs::exists(file) ? slurp(file) : "") == before);
    }
    // A subject who withdraws is in no result that stays.
    REQUIRE(folder.tactus(fmt::format("experiment withdraw {} --subject P01", out)).code == 0);
    for (const char* name : {"report.csv", "results.txt", "report.svg", "results.json", "report.html"})
        CHECK_FALSE(fs::exists(folder.path / "data" / name));
}

TEST_CASE("a second subject in the same folder at the same time is refused", "[slow]") {
    const Folder folder;
    write_own(folder);
    const std::string out = at(folder, "data");
    // The folder is locked as long as the file descriptor is open.
    const std::string both =
        fmt::format("mkdir -p {0}; exec 9< {0}; flock -n 9 && {1} {2} 2> {0}.err; echo $? > {0}.code", out,
                    tactus::test::command(), run_own(folder, "--subject P02 --out " + out));
    REQUIRE(std::system(fmt::format("sh -c '{}'", both).c_str()) == 0);
    CHECK(slurp(out + ".code") == "2\n");
    CHECK(slurp(out + ".err").find("another program runs this experiment") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path / "data/experiment.json"));
}

TEST_CASE("keys end a session with q, and answers of a pipe are those of the trials", "[live][kernel]") {
    const Folder folder;
    write_own(folder);
    const std::string run =
        fmt::format("experiment run {} --subject P01 --out {}", at(folder, "own.toml"), at(folder, "data"));
    // Two answers, then the end; a break after five trials asks for a key.
    const std::string command =
        fmt::format("printf '12q' | {} {} > {} 2>&1", tactus::test::command(), run, at(folder, "log"));
    REQUIRE(std::system(command.c_str()) == 0);
    CAPTURE(slurp(folder.path / "log"));
    const std::vector<std::string> trials = lines_of(slurp(folder.path / "data/sub-P01/trials.jsonl"));
    REQUIRE(trials.size() == 2);
    CHECK(trials[0].find("\"answer\":0") != std::string::npos);
    CHECK(trials[1].find("\"answer\":1") != std::string::npos);
    // Its device is a sound card, not a hand that is missing.
    CHECK(trials[1].find("\"rehearsal\":false") != std::string::npos);
    CHECK(slurp(folder.path / "log").find("not complete; the same command resumes it") != std::string::npos);
}
