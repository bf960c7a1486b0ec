// SPDX-License-Identifier: Apache-2.0
// What a sweep costs beside its points: task list, status, tables, and each point.
#include "assets/file/growing_file.hpp"
#include "assets/file/json.hpp"
#include "assets/file/part.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/sweep/row_log.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/sweep/sweep_folder.hpp"
#include "tools/bench/bench.hpp"
#include "tools/run/child_process.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tactus::bench {

namespace {

namespace fs = std::filesystem;
using file::Json;

struct SweepBenchChoice {
    int points = 1'000'000;
    bool json = false;
};

/// Processor time and memory of a command to its end, with all that it started and waited for.
struct Cost {
    double seconds = 0.0, peak_mb = 0.0;
};

Cost cost_of(const std::vector<std::string>& words, const fs::path& folder) {
    const run::Capture out("output"), err("errors");
    const run::Finished finished = run::run_process(words, folder, out, err);
    // 1: points are left, or the answer is no.
    if (finished.signal != 0 || finished.code > 1)
        throw Error(fmt::format("'{}' failed: {}", fmt::join(words, " "), err.text()));
    return {finished.seconds, 1e-6 * finished.peak};
}

class SweepBench {
public:
    explicit SweepBench(const SweepBenchChoice& choice) : choice_(choice) {
        tactus_ = (file::this_object().parent_path() / "tactus").string();
        if (!fs::exists(tactus_))
            throw Error(fmt::format("{} is missing: build it, or install it beside tactus-bench", tactus_));
    }

    void run() {
        if (!choice_.json) fmt::print("{:58} {:>12} {:>10}\n", "processor time", "", "peak");
        many_points();
        one_point();
        if (choice_.json) fmt::print("{}\n", Json{{"version", 1}, {"rows", rows_}}.dump(2));
    }

private:
    void add(const std::string& what, double seconds, double peak_mb = 0.0) {
        Json row{{"what", what}, {"seconds", seconds}};
        if (peak_mb > 0.0) row["peak_mb"] = peak_mb;
        rows_.push_back(row);
        if (choice_.json) return;
        const std::string time =
            seconds < 0.1 ? fmt::format("{:.2f} ms", 1e3 * seconds) : fmt::format("{:.2f} s", seconds);
        fmt::print("{:58} {:>12} {:>10}\n", what, time, peak_mb > 0.0 ? fmt::format("{:.0f} MB", peak_mb) : "");
        std::fflush(stdout);
    }
    void add(const std::string& what, const Cost& cost) { add(what, cost.seconds, cost.peak_mb); }

    Cost tactus(std::vector<std::string> words) const {
        words.insert(words.begin(), tactus_);
        return cost_of(words, scratch_.path());
    }

    void write(const std::string& name, const std::string& text) const {
        file::write_whole_file(scratch_.path() / name, "format = 1\ntitle = \"Costs\"\n" + text);
    }

    /// Prepares a sweep and runs all its points with one worker, without tables.
    Cost work(const std::string& name) const {
        const std::string folder = name + "-folder";
        tactus({"sweep", "run", name, "-o", folder, "--dry-run"});
        return tactus({"sweep", "work", folder});
    }

    void many_points() {
        const int levels = std::max(choice_.points / 1000, 2);
        const std::string count = fmt::format("{} points", 1000 * levels);
        write("many.toml", fmt::format("[axes.level]\nrange = [0, 1]\ncount = {}\n[seeds]\ncount = 1000\n", levels));
        add("task list of " + count, tactus({"sweep", "run", "many.toml", "-o", "many", "--dry-run"}));
        add("status of them, none finished", tactus({"sweep", "status", "many"}));
        const fs::path log = scratch_.path() / "many/log/bench.jsonl";
        {
            const analysis::SweepFolder folder(scratch_.path() / "many", run::library_folder());
            file::GrowingFile rows(log);
            rows.append("{\"worker\":{\"machine\":\"bench\"}}\n");
            sweep::Row row;
            row.is_ok = true;
            row.seconds = 0.01;
            row.peak = 5e7;
            for (std::size_t i = 0; i < folder.tasks().size(); ++i) {
                row.point = row.output = folder.tasks().id(i);
                rows.append(sweep::row_line(row));
            }
            rows.close();
        }
        add("status of them, all finished", tactus({"sweep", "status", "many"}));
        const double tables = tactus({"sweep", "status", "many", "--tables"}).seconds;
        add("results.csv and results.sqlite of them, with a status", tables);
        if (!choice_.json)
            fmt::print("{:58} {:>10.0f} B\n", "log, per row without values",
                       static_cast<double>(fs::file_size(log)) / (1000.0 * levels));
        fs::remove_all(scratch_.path() / "many");
    }

    void one_point() {
        constexpr int empty = 20'000, programs = 1000, renders = 200;
        write("one.toml", "");
        const double start = work("one.toml").seconds;
        add("tactus sweep work, for one point without steps", start);
        write("empty.toml", fmt::format("[seeds]\ncount = {}\n", empty));
        add("a point without steps, in a resident worker", (work("empty.toml").seconds - start) / empty);
        write("true.toml", fmt::format("[seeds]\ncount = {}\n[[step]]\ncommand = [\"/bin/true\"]\n", programs));
        const double points = (work("true.toml").seconds - start) / programs;
        const double loop =
            cost_of(
                {"/bin/sh", "-c", fmt::format("i=0; while [ $i -lt {} ]; do i=$((i + 1)); /bin/true; done", programs)},
                scratch_.path())
                .seconds /
            programs;
        add("a point of /bin/true", points);
        add("the same in a loop of a shell", loop);
        add("overhead of a point of a program", points - loop);
        const std::string render =
            "[inputs]\npatch = \"library:patches/touch-sphere.toml\"\n[axes.stiffness]\nunit = \"N/mm\"\n"
            "range = [0.5, 1.5]\ncount = {}\n[[step]]\ntactus = [\"render\", \"{{inputs.patch}}\", \"--set\", "
            "\"coupling.stiffness={{stiffness}}\", \"--seconds\", \"0.1\", \"-o\", \"{{out}}/run\", \"--json\"]\n"
            "values = {{hash = \"/output_hash\"}}\n";
        write("few.toml", fmt::format(fmt::runtime(render), 2));
        write("render.toml", fmt::format(fmt::runtime(render), renders));
        const double few = work("few.toml").seconds;
        add("0.1 s of touch-sphere, in a resident worker", (work("render.toml").seconds - few) / (renders - 2));
        add("0.1 s of touch-sphere, in a process of its own",
            tactus({"render", "touch-sphere", "--seconds", "0.1", "-o", "alone", "--json"}));
    }

    SweepBenchChoice choice_;
    std::string tactus_;
    run::ScratchFolder scratch_;
    Json rows_ = Json::array();
};

}  // namespace

Verb sweep_verb() {
    return {"sweep", "what a sweep costs beside its points: task list, status, tables, and each point",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<SweepBenchChoice>();
                verb.add("--points", choice->points, "points of the long list, in thousands rounded down")
                    .shows_default()
                    .range(2000, 20'000'000);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] {
                    SweepBench(*choice).run();
                    return static_cast<int>(done);
                };
            }};
}

}  // namespace tactus::bench
