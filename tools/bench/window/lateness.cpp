// SPDX-License-Identifier: Apache-2.0
// Whether a window makes a run late: rounds of three runs, two without a window and one with, in turning order. What the
// two equal runs of all rounds differ by is the spread of the machine, which a window must not exceed.
#include "assets/file/json.hpp"
#include "assets/file/part.hpp"
#include "dsp/core/error.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/window/quantile.hpp"
#include "tools/run/scratch_folder.hpp"
#include "tools/run/stop_signals.hpp"

#include <fmt/format.h>

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;
namespace fs = std::filesystem;

struct LatenessChoice {
    std::string patch = "saw-training";
    int rounds = 15;
    double seconds = 5.0;
    bool json = false;
};

/// Of the fastest group below audio rate, that of the hand.
struct Lateness {
    double p99_us = 0.0;
    double lost_percent = 0.0;  ///< ticks that were left out or came too late
};

fs::path own_command() {
    const fs::path command = file::this_object().parent_path() / "tactus";
    if (!fs::exists(command))
        throw Error(fmt::format("{} is missing: build it, or install it beside tactus-bench", command.string()));
    return command;
}

/// Turns the view in every other picture.
void write_script(const fs::path& file, double seconds) {
    std::ofstream script(file);
    script << "size 1280 800\n";
    for (int i = 0; i < static_cast<int>(30.0 * seconds); ++i)
        script << (i % 2 == 0 ? "from front\nframes 2\n" : "from iso\nframes 2\n");
}

Lateness one_run(const LatenessChoice& choice, const fs::path& folder, bool has_window) {
    const std::string line = fmt::format(
        "cd '{}' && XDG_STATE_HOME=state '{}' run '{}' --audio none --seconds {} --out out --overwrite --json{} "
        "2>errors",
        folder.string(), own_command().string(), choice.patch, choice.seconds,
        has_window ? " --view --view-scale 1 --view-script script" : "");
    std::FILE* const output = ::popen(line.c_str(), "r");
    if (!output) throw Error("no process can be started");
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t read = std::fread(part.data(), 1, part.size(), output)) text.append(part.data(), read);
    const int status = ::pclose(output);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        std::ifstream errors(folder / "errors");
        std::string why;
        std::getline(errors, why);
        throw Error(
            fmt::format("the run of '{}' {} a window failed: {}", choice.patch, has_window ? "with" : "without", why));
    }
    const Json summary = Json::parse(text);
    // Groups above work in blocks of samples, and are late by other measures.
    constexpr double max_hz = 8000.0;
    const Json* hand = nullptr;
    for (const Json& group : summary["groups"])
        if (const double rate = group["rate_hz"].get<double>();
            rate <= max_hz && (!hand || rate > (*hand)["rate_hz"].get<double>()))
            hand = &group;
    if (!hand) throw Error(fmt::format("'{}' has no group below 8 kHz", choice.patch));
    double lost = 0.0;
    for (const char* how : {"misses", "skipped", "dropped"}) lost += (*hand)[how].get<double>();
    const double ticks = (*hand)["ticks"].get<double>() + (*hand)["skipped"].get<double>();
    return {(*hand)["lateness_us"]["p99"].get<double>(), ticks > 0.0 ? 100.0 * lost / ticks : 0.0};
}

struct Compared {
    const char* what;
    double without = 0.0, with = 0.0;  ///< medians
    double spread = 0.0;  ///< what `added` would exceed once in 20 times if windows added nothing
    double added = 0.0;  ///< median of a window's run above the mean of its round's other two
    bool is_within() const { return added <= spread; }
};

/// The 95th percentile of the median over all rounds of the difference of two equal runs: which of the two is the first
/// is chance, so that the signs of the differences are drawn anew.
double spread_of_medians(const std::vector<double>& differences) {
    constexpr int draws = 20'000;
    // A run less the mean of two others varies less than the difference of two runs.
    const double narrower = std::sqrt(1.5 / 2.0);
    std::mt19937 random(1);
    std::vector<double> medians;
    for (int i = 0; i < draws; ++i) {
        std::vector<double> drawn = differences;
        for (double& difference : drawn) difference *= (random() & 1u) != 0 ? narrower : -narrower;
        medians.push_back(quantile(std::move(drawn), 0.5));
    }
    return quantile(std::move(medians), 0.95);
}

Compared compare(const char* what, const std::vector<std::array<Lateness, 3>>& rounds, double Lateness::* figure) {
    std::vector<double> without, with, equal, added;
    for (const auto& [first, second, window] : rounds) {
        const double a = first.*figure, b = second.*figure, w = window.*figure;
        without.push_back(0.5 * (a + b));
        with.push_back(w);
        equal.push_back(a - b);
        added.push_back(w - 0.5 * (a + b));
    }
    return {what, quantile(without, 0.5), quantile(with, 0.5), spread_of_medians(equal), quantile(added, 0.5)};
}

int bench_lateness(const LatenessChoice& choice) {
    const std::atomic<bool>& interrupted = run::stop_on_signals();
    const run::ScratchFolder folder;
    write_script(folder.path() / "script", choice.seconds);
    std::vector<std::array<Lateness, 3>> rounds;
    for (int round = 0; round < choice.rounds && !interrupted; ++round) {
        std::array<Lateness, 3> runs;
        // Each of the three is first, second and third equally often.
        for (std::size_t turn = 0; turn < 3; ++turn) {
            const std::size_t which = (turn + static_cast<std::size_t>(round)) % 3;
            runs[which] = one_run(choice, folder.path(), which == 2);
        }
        rounds.push_back(runs);
    }
    if (rounds.empty()) return done;
    double load[1] = {0.0};
    ::getloadavg(load, 1);
    const std::array<Compared, 2> all{compare("late by, 99th percentile, us", rounds, &Lateness::p99_us),
                                      compare("ticks lost, %", rounds, &Lateness::lost_percent)};
    bool is_within = true;
    Json figures = Json::object();
    for (const Compared& each : all) {
        is_within = is_within && each.is_within();
        figures[each.what] = {
            {"without", each.without}, {"with", each.with}, {"spread", each.spread}, {"added", each.added}};
    }
    if (choice.json)
        fmt::print("{}\n", Json{{"patch", choice.patch},
                                {"rounds", rounds.size()},
                                {"load", load[0]},
                                {"is_within_spread", is_within},
                                {"figures", figures}}
                               .dump(2));
    else {
        fmt::print("{} rounds of three runs of {:.0f} s of {}; load of the machine at the end {:.1f}\n", rounds.size(),
                   choice.seconds, choice.patch, load[0]);
        fmt::print("{:<30} {:>12} {:>12} {:>12} {:>12}\n", "", "no window", "window", "window adds", "spread");
        for (const Compared& each : all)
            fmt::print("{:<30} {:12.3f} {:12.3f} {:12.3f} {:12.3f}\n", each.what, each.without, each.with, each.added,
                       each.spread);
        fmt::print("{}\n", is_within ? "the window adds no more than the spread of equal runs"
                                     : "the window adds more than the spread of equal runs");
    }
    return is_within ? done : answer_is_no;
}

}  // namespace

Verb lateness_verb() {
    return {"window-lateness",
            "ticks that come late with a window that is turned all the time, beside the spread of equal runs without",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<LatenessChoice>();
                verb.add("--patch", choice->patch, "of the library").shows_default();
                verb.add("--rounds", choice->rounds, "each of two runs without a window and one with")
                    .shows_default()
                    .range(1, 1000);
                verb.add("--seconds", choice->seconds, "of each run").shows_default().range(1.0, 600.0);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_lateness(*choice); };
            }};
}

}  // namespace tactus::bench
