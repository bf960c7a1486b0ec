// SPDX-License-Identifier: Apache-2.0
// Cost of single nodes: a formula beside the same law as a C++ node, and nodes beside the loops of their twins in Pure
// Data.
#include "assets/file/json.hpp"
#include "dsp/core/processor_time.hpp"
#include "engine/run/engine.hpp"
#include "graph/node/node.hpp"
#include "nodes/catalogue.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/nodes_law.hpp"
#include "tools/bench/nodes_pure_data.hpp"

#include <fmt/format.h>

#include <time.h>
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace tactus::bench {

using file::Json;

namespace {

constexpr double rate = 48000.0;
constexpr int count = 200;  ///< nodes side by side

/// Two tones, and `nodes` nodes of a type that read them; inputs and settings as text.
std::string patch_of(int nodes, const std::string& type, const std::vector<std::string>& inputs,
                     const std::string& settings) {
    std::string wires, text;
    for (int i = 0; i < nodes; ++i) {
        for (std::size_t k = 0; k < inputs.size(); ++k)
            wires += fmt::format("\"tone{}.signal -> n{}.{}\",\n", k, i, inputs[k]);
        text += fmt::format("[nodes.n{}]\ntype = \"{}\"\nrate = \"48 kHz\"\n{}", i, type, settings);
    }
    for (int k = 0; k < 2; ++k)
        text += fmt::format("[nodes.tone{0}]\ntype = \"sine\"\nrate = \"48 kHz\"\nfrequency = \"{1} Hz\"\n", k,
                            440 + 113 * k);
    return "wires = [" + wires + "]\n" + text;
}

double seconds_of(const std::string& text, int block, double length) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "nodes.toml", problems);
    const compile::Catalogue known = nodes::catalogue();
    std::vector<const NodeType*> types(known.begin(), known.end());
    types.insert(types.end(), law_nodes().begin(), law_nodes().end());
    std::ranges::sort(types, {}, &NodeType::name);
    std::optional<compile::Schedule> plan = problems.empty() ? compile::compile(patch, types, problems) : std::nullopt;
    if (!problems.empty()) throw problems.list.front();
    run::EngineOptions options;
    options.seconds = length;
    options.block = block;
    options.hash = false;
    run::Engine engine(std::move(*plan), options);
    const double begin = process_seconds();
    engine.render(1);
    return process_seconds() - begin;
}

/// ns of one node in one call of `block` samples; the best of some rounds.
class NodeCost {
public:
    NodeCost(std::string type, std::vector<std::string> inputs, std::string settings, int block)
        : with_(patch_of(count, type, inputs, settings)),
          without_(patch_of(0, type, inputs, settings)),
          block_(block),
          length_(block == 1 ? 0.5 : 4.0) {}

    void measure() {
        best_with_ = std::min(best_with_, seconds_of(with_, block_, length_));
        best_without_ = std::min(best_without_, seconds_of(without_, block_, length_));
    }
    double ns() const { return (best_with_ - best_without_) * 1e9 / (length_ * rate / block_ * count); }

private:
    std::string with_, without_;
    int block_;
    double length_, best_with_ = 1e9, best_without_ = 1e9;
};

struct NodesChoice {
    int rounds = 5;
    bool json = false;
};

Json row(const std::string& name, int block, double ns, const std::string& peer, double peer_ns, double bound) {
    return {{"name", name},       {"block", block},        {"ns", ns},      {"peer", peer},
            {"peer_ns", peer_ns}, {"ratio", ns / peer_ns}, {"bound", bound}};
}

int bench_nodes(const NodesChoice& choice) {
    Json rows = Json::array();
    LiveLine line;
    for (const Law& law : laws())
        for (const int block : {1, 64}) {
            line.show(fmt::format("{}, block {}", law.formula, block));
            const std::string constants(law.constants), two = law.inputs > 1 ? "x, y" : "x";
            NodeCost formula(
                "expression", law.inputs > 1 ? std::vector<std::string>{"in1", "in2"} : std::vector<std::string>{"in1"},
                fmt::format("formula = \"{}\"\ninputs = \"{}\"\nconstants = \"{}\"\n", law.formula, two, law.constants),
                block);
            NodeCost node(std::string(law.type),
                          law.inputs > 1 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x"}, "",
                          block);
            for (int i = 0; i < choice.rounds; ++i) {
                formula.measure();
                node.measure();
            }
            rows.push_back(row(std::string(law.formula), block, formula.ns(), "C++ node", node.ns(), 2.0));
        }
    for (const PureDataTwin& twin : pure_data_twins()) {
        line.show(fmt::format("{} beside {}", twin.type, twin.object));
        std::vector<std::string> inputs;
        for (const char* input : twin.inputs) inputs.emplace_back(input);
        NodeCost node(twin.type, inputs, twin.settings, 64);
        double peer = 1e9;
        for (int i = 0; i < choice.rounds; ++i) {
            node.measure();
            peer = std::min(peer, twin.ns_per_block(count));
        }
        rows.push_back(row(twin.type, 64, node.ns(), twin.object, peer, 1.3));
    }
    line.clear();
    const auto holds = [](const Json& r) { return r["ratio"].get<double>() <= r["bound"].get<double>(); };
    bool is_ok = true;
    for (const Json& r : rows) is_ok = is_ok && holds(r);
    if (choice.json) {
        fmt::print("{}\n", Json{{"ok", is_ok}, {"rows", rows}}.dump(2));
        return is_ok ? done : answer_is_no;
    }
    fmt::print("{:<26} {:>5} {:>8} {:>9} {:>8} {:>6} {:>6}\n", "", "block", "ns/call", "peer", "ns/call", "ratio",
               "bound");
    for (const Json& r : rows)
        fmt::print("{:<26} {:>5} {:>8.2f} {:>9} {:>8.2f} {:>6.2f} {:>6.1f}{}\n", r["name"].get<std::string>(),
                   r["block"].get<int>(), r["ns"].get<double>(), r["peer"].get<std::string>(),
                   r["peer_ns"].get<double>(), r["ratio"].get<double>(), r["bound"].get<double>(),
                   holds(r) ? "" : "  BEYOND");
    return is_ok ? done : answer_is_no;
}

}  // namespace

Verb nodes_verb() {
    return {
        "nodes",
        "cost of formulas beside C++ nodes, and of nodes beside the loops of their twins in Pure Data; exit code 1: "
        "one is beyond its bound",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<NodesChoice>();
            verb.add("--rounds", choice->rounds, "number of repetitions; the best one counts")
                .shows_default()
                .range(1, 1000);
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_nodes(*choice); };
        }};
}

}  // namespace tactus::bench
