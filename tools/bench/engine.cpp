// SPDX-License-Identifier: Apache-2.0
// Cost per node: a chain of gains in this engine, in Pure Data and in scsynth.
#include "engine/run/engine.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/processor_time.hpp"
#include "graph/analyse/latency.hpp"
#include "graph/analyse/stiffness.hpp"
#include "nodes/catalogue.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/engine_peers.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/summary.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <time.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <functional>

namespace tactus::bench {

using file::Json;

namespace {

constexpr double card_rate = 48000.0;

/// Processor time of all threads; other load on the machine does not count.
double seconds_of(const std::function<void()>& work) {
    const double begin = process_seconds();
    work();
    return process_seconds() - begin;
}

std::string patch_of(int nodes) {
    std::string wires, text;
    for (int i = 0; i < nodes; ++i) {
        wires += fmt::format("\"{}.{} -> g{}.in\",\n", i == 0 ? "tone" : fmt::format("g{}", i - 1),
                             i == 0 ? "signal" : "out", i);
        text += fmt::format("[nodes.g{}]\ntype = \"gain\"\nrate = \"48 kHz\"\nfactor = 0.999\n", i);
    }
    return "wires = [" + wires + "]\n[nodes.tone]\ntype = \"sine\"\nrate = \"48 kHz\"\nfrequency = \"440 Hz\"\n" + text;
}

patch::Patch read_chain(const std::string& text) {
    patch::Problems problems;
    patch::Patch patch = patch::read_patch(text, "chain.toml", problems);
    if (!problems.empty()) throw problems.list.front();
    return patch;
}

compile::Schedule compile_chain(const patch::Patch& patch) {
    patch::Problems problems;
    std::optional<compile::Schedule> plan = compile::compile(patch, nodes::catalogue(), problems);
    if (!problems.empty()) throw problems.list.front();
    return std::move(*plan);
}

double run_here(const Chain& chain, bool hash, bool time_nodes) {
    run::EngineOptions options;
    options.seconds = chain.seconds;
    options.block = chain.block;
    options.hash = hash;
    options.time_nodes = time_nodes;
    run::Engine engine(compile_chain(read_chain(patch_of(chain.nodes))), options);
    return seconds_of([&] { engine.render(1); });
}

/// A method to run a chain; `time` includes start-up.
struct Runner {
    std::string name;
    std::function<std::optional<double>(const Chain&)> time;
    bool works = true;
    std::array<double, 4> best{1e9, 1e9, 1e9, 1e9};  ///< best times of all rounds, in the order of `measure`
    std::optional<double> ns_per_node = std::nullopt;
};

/// Times of a long and a short run, with and without nodes. The differences isolate the cost of the nodes.
void measure(Runner& runner, const Chain& chain) {
    if (!runner.works) return;
    const Chain brief{chain.nodes, chain.block, 0.01}, bare{0, chain.block, chain.seconds},
        bare_brief{0, chain.block, 0.01};
    std::size_t at = 0;
    for (const Chain& one : {chain, brief, bare, bare_brief}) {
        const std::optional<double> time = runner.time(one);
        runner.works = time.has_value();
        if (!runner.works) return;
        runner.best[at] = std::min(runner.best[at], *time);
        ++at;
    }
    const double own = (runner.best[0] - runner.best[1]) - (runner.best[2] - runner.best[3]);
    runner.ns_per_node = own * 1e9 / ((chain.seconds - 0.01) * card_rate / chain.block * chain.nodes);
}

Json row(const std::string& name, int nodes, int block, double ns, const Runner* peer) {
    Json json{{"name", name}, {"nodes", nodes}, {"block", block}, {"ns_per_node", ns}};
    json["peer"] = peer ? Json(peer->name) : Json();
    json["peer_ns_per_node"] = peer && peer->ns_per_node ? Json(*peer->ns_per_node) : Json();
    json["ratio"] = peer && peer->ns_per_node ? Json(ns / *peer->ns_per_node) : Json();
    return json;
}

void bench_chain(int nodes, int block, int rounds, const std::filesystem::path& folder, Json& rows) {
    // About half a second of work at 5 ns per node; more for programs that load slowly.
    const double work = nodes < 10000 ? 0.5 : 2.0;
    const Chain chain{nodes, block, std::max(0.1, work / (card_rate / block * nodes * 5e-9))};
    Runner here[] = {{"gain", [](const Chain& c) { return std::optional(run_here(c, false, true)); }},
                     {"gain, outputs hashed", [](const Chain& c) { return std::optional(run_here(c, true, true)); }}};
    Runner peers[] = {{"pure data", [&](const Chain& c) { return run_in_pure_data(c, folder); }},
                      {"scsynth", [&](const Chain& c) { return run_in_scsynth(c, folder); }}};
    // Interleaved, so that other load affects all methods alike.
    for (int i = 0; i < rounds; ++i) {
        for (Runner& runner : here) measure(runner, chain);
        for (Runner& runner : peers) measure(runner, chain);
    }
    for (const Runner& runner : here)
        for (const Runner& peer : peers) rows.push_back(row(runner.name, nodes, block, *runner.ns_per_node, &peer));
}

/// Time from patch text to runnable plan, best of several, ns per node.
void bench_compile(int rounds, Json& rows) {
    constexpr int nodes = 1000;
    const std::string text = patch_of(nodes);
    const patch::Patch patch = read_chain(text);
    double read = 1.0, compiled = 1.0, prepared = 1.0;
    for (int i = 0; i < 3 * rounds; ++i) {
        read = std::min(read, seconds_of([&] { read_chain(text); }));
        std::optional<compile::Schedule> plan;
        compiled = std::min(compiled, seconds_of([&] { plan = compile_chain(patch); }));
        std::optional<run::Engine> engine;
        prepared = std::min(prepared, seconds_of([&] { engine.emplace(std::move(*plan), run::EngineOptions{}); }));
    }
    rows.push_back(row("read patch", nodes, 0, read * 1e9 / nodes, nullptr));
    rows.push_back(row("compile", nodes, 0, compiled * 1e9 / nodes, nullptr));
    rows.push_back(row("prepare", nodes, 0, prepared * 1e9 / nodes, nullptr));
}

/// Compile time per node of a large patch relative to a small one; 1 means linear time.
void bench_scaling(int rounds, Json& rows) {
    constexpr std::array<int, 2> sizes{10'000, 100'000};
    constexpr double brief = 0.002;  // s of sound; start-up dominates
    std::array<double, 2> checked{1e9, 1e9}, rendered{1e9, 1e9};
    for (int i = 0; i < rounds; ++i)
        for (std::size_t k = 0; k < sizes.size(); ++k) {
            const std::string text = patch_of(sizes[k]);
            checked[k] =
                std::min(checked[k], seconds_of([&] {
                             const run::Engine engine(compile_chain(read_chain(text)), run::EngineOptions{});
                             analyse::path_latencies(engine.plan());
                             analyse::force_loops(engine.plan(), [](const std::string&) { return DeviceInfo{}; });
                         }));
            rendered[k] = std::min(rendered[k], seconds_of([&] {
                                       run::EngineOptions options;
                                       options.seconds = brief;
                                       run::Engine engine(compile_chain(read_chain(text)), options);
                                       engine.render(1);
                                       engine.finish();
                                       run::summary_json(engine, engine.report(), brief, false, {}, {});
                                   }));
        }
    const auto add = [&](const char* name, const std::array<double, 2>& seconds) {
        const double few = seconds[0] * 1e9 / sizes[0], many = seconds[1] * 1e9 / sizes[1];
        Json json = row(name, sizes[1], 0, many, nullptr);
        json["peer"] = fmt::format("{} nodes", sizes[0]);
        json["peer_ns_per_node"] = few;
        json["ratio"] = many / few;
        rows.push_back(std::move(json));
    };
    add("check", checked);
    add("render 2 ms", rendered);
}

/// Processor time of an edit of one node of many, from the saved file to a plan that can take over, by its steps.
void bench_edit(int rounds, const std::filesystem::path& folder, Json& rows) {
    constexpr int nodes = 10'000;
    const std::filesystem::path file = folder / "edited.toml";
    std::string text = patch_of(nodes);
    file::write_whole_file(file, text);
    patch::Problems problems;
    text.replace(text.rfind("0.999"), 5, "0.998");
    double read = 1e9, compiled = 1e9, built = 1e9;
    for (int i = 0; i < 2 * rounds; ++i) {
        file::write_whole_file(file, patch_of(nodes));
        run::Engine engine(*run::plan_of(patch::load_patch(file, problems), {}, {}, nullptr, problems), {});
        file::write_whole_file(file, text);
        patch::Patch patch;
        read = std::min(read, seconds_of([&] { patch = patch::load_patch(file, problems); }));
        std::optional<compile::Schedule> plan;
        compiled =
            std::min(compiled, seconds_of([&] { plan = run::plan_of(std::move(patch), {}, {}, nullptr, problems); }));
        built = std::min(built, seconds_of([&] { engine.schedule(std::move(*plan), flicks_per_second); }));
    }
    rows.push_back(row("edit: read", nodes, 0, read * 1e9 / nodes, nullptr));
    rows.push_back(row("edit: compile", nodes, 0, compiled * 1e9 / nodes, nullptr));
    rows.push_back(row("edit: build", nodes, 0, built * 1e9 / nodes, nullptr));
}

/// Cost of timing every node in one of 64 calls, relative to a tick of 1 ms.
void bench_telemetry(int rounds, Json& rows) {
    constexpr int nodes = 1000, block = 48;
    const Chain chain{nodes, block, 2.0};
    double with = 1e9, without = 1e9;
    for (int i = 0; i < 3 * rounds; ++i) {
        with = std::min(with, run_here(chain, false, true));
        without = std::min(without, run_here(chain, false, false));
    }
    const double added = with - without;
    Json json = row("telemetry", nodes, block, added * 1e9 / (chain.seconds * card_rate / block * nodes), nullptr);
    json["percent_of_tick"] = 100.0 * added / chain.seconds;
    rows.push_back(std::move(json));
}

void print_rows(const Json& rows) {
    fmt::print("{:<22} {:>6} {:>6} {:>9} {:>11} {:>9} {:>6}\n", "", "nodes", "block", "ns/node", "peer", "ns/node",
               "ratio");
    for (const Json& r : rows) {
        std::string line = fmt::format("{:<22} {:>6} {:>6} {:>9.2f}", r["name"].get<std::string>(),
                                       r["nodes"].get<int>(), r["block"].get<int>(), r["ns_per_node"].get<double>());
        if (!r["peer_ns_per_node"].is_null())
            line += fmt::format(" {:>11} {:>9.2f} {:>6.2f}", r["peer"].get<std::string>(),
                                r["peer_ns_per_node"].get<double>(), r["ratio"].get<double>());
        else if (!r["peer"].is_null()) line += fmt::format(" {:>11} {:>9}", r["peer"].get<std::string>(), "missing");
        if (r.contains("percent_of_tick"))
            line += fmt::format("   {:.2f} % of a tick of 1 ms", r["percent_of_tick"].get<double>());
        fmt::print("{}\n", line);
    }
    fmt::print(
        "ns/node: processor time of one node in one call, the best of all rounds; start and end of the chain taken "
        "off.\n");
}

}  // namespace

int bench_engine(const BenchChoice& choice) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("tactus-bench-{}", ::getpid());
    std::filesystem::create_directories(folder);
    Json rows = Json::array();
    LiveLine line;
    for (const int nodes : {100, 1000, 10000})
        for (const int block : {1, 64}) {
            line.show(fmt::format("{} nodes, block {}", nodes, block));
            bench_chain(nodes, block, choice.rounds, folder, rows);
        }
    line.show("compiling");
    bench_compile(choice.rounds, rows);
    line.show("large patches");
    bench_scaling(choice.rounds, rows);
    bench_edit(choice.rounds, folder, rows);
    bench_telemetry(choice.rounds, rows);
    line.clear();
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    if (choice.json) fmt::print("{}\n", Json{{"rows", rows}}.dump(2));
    else print_rows(rows);
    return done;
}

Verb engine_verb() {
    return {"engine", "time per node in a chain, compared with Pure Data and scsynth; time to compile and to edit",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<BenchChoice>();
                verb.add("--rounds", choice->rounds, "number of repetitions; the best one counts")
                    .shows_default()
                    .range(1, 1000);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_engine(*choice); };
            }};
}

}  // namespace tactus::bench
