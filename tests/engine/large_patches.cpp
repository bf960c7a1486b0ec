// SPDX-License-Identifier: Apache-2.0
// What a node of a patch costs does not grow with the patch.
#include "engine/run/engine.hpp"
#include "graph/analyse/latency.hpp"
#include "graph/analyse/stiffness.hpp"
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <optional>
#include <string>
#include <utility>

using namespace tactus;

namespace {

std::string a_node(const std::string& name, const std::string& type, const std::string& rate,
                   const std::string& settings = "") {
    return fmt::format("[nodes.{}]\ntype = \"{}\"\nrate = \"{}\"\n{}", name, type, rate, settings);
}

/// A hand behind a chain of workspaces, with a spring at each of them; wires written from the end to the beginning.
///
///     hand ─► w0 ─► w1 … ─► device of s0, s1, …; the last spring pulls the hand
std::string springs(int nodes) {
    std::string wires, text = a_node("hand", "device_input", "1 kHz");
    const int count = nodes / 2;
    for (int i = count; i-- > 0;)
        wires += fmt::format("\"{}.pose -> w{}.device\",\n", i > 0 ? fmt::format("w{}", i - 1) : "hand", i);
    for (int i = 0; i < count; ++i) {
        wires += fmt::format("\"w{0}.pose -> s{0}.device\", \"hand.pose -> s{0}.object\",\n", i);
        text += a_node(fmt::format("w{}", i), "workspace", "1 kHz") + a_node(fmt::format("s{}", i), "spring", "1 kHz");
    }
    wires += fmt::format("\"s{}.wrench -> out.wrench\"", count - 1);
    return "wires = [" + wires + "]\n[devices.one]\ndriver = \"simulated\"\n" + text +
           a_node("out", "device_output", "1 kHz");
}

/// Voices, each a patch of two nodes with an input, an output and a parameter; each leads to the next, and at another
/// rate a number drives its level.
std::string voices(int nodes) {
    std::string wires, text = a_node("tone", "sine", "8 kHz");
    const int count = nodes / 4;
    for (int i = 0; i < count; ++i) {
        wires +=
            fmt::format("\"{0}.{1} -> v{2}.in\", \"c{2}.value -> v{2}.depth as linear\", \"c{2}.value -> m{2}.in\",\n",
                        i == 0 ? "tone" : fmt::format("v{}", i - 1), i == 0 ? "signal" : "out", i);
        text += a_node(fmt::format("v{}", i), "patch:voice.toml", "8 kHz", "level = 0.5\n") +
                a_node(fmt::format("c{}", i), "constant", "100 Hz") +
                a_node(fmt::format("m{}", i), "magnitude", "100 Hz");
    }
    const std::string voice =
        "wires = [\"first.out -> second.in\"]\n[inputs]\nin = \"first.in\"\n"
        "[outputs]\nout = \"second.out\"\n"
        "[parameters]\nlevel = \"first.factor\"\ndepth = \"second.factor\"\n" +
        a_node("first", "gain", "outer") + a_node("second", "gain", "outer");
    return "wires = [" + wires + "]\n" + text + "[[parts]]\npath = \"voice.toml\"\ntext = '''\n" + voice + "'''\n";
}

compile::Schedule compiled(const std::string& text) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "large.toml", problems);
    std::optional<compile::Schedule> plan =
        problems.empty() ? compile::compile(patch, nodes::catalogue(), problems) : std::nullopt;
    for (const Error& problem : problems.list) UNSCOPED_INFO(problem.what());
    REQUIRE(plan);
    return std::move(*plan);
}

/// Reads, compiles, analyses, runs and edits a patch: processor time per node, s.
double time_per_node(std::string (*patch_of)(int), int nodes) {
    const std::string text = patch_of(nodes);
    std::string edited = text;
    edited.insert(edited.find("[nodes."), "# changed\n");
    const auto now = [] {
        timespec t;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const double begin = now();
    {
        compile::Schedule plan = compiled(text);
        analyse::path_latencies(plan);
        analyse::force_loops(plan, [](const std::string&) { return DeviceInfo{.name = {}, .damping = 1.0}; });
        run::EngineOptions options;
        options.seconds = 0.02;
        run::Engine engine(std::move(plan), options);
        engine.schedule(compiled(edited), flicks_per_second / 100);
        engine.render(1);
        REQUIRE(engine.output_hash() != 0);
    }
    return (now() - begin) / nodes;
}

/// The ratio is 1 where time is in proportion, 16 where it grows with the square. The best of a few tries counts, so
/// that nothing else on the machine can make it fail.
void check_proportion(std::string (*patch_of)(int)) {
    constexpr int few = 3'000, many = 16 * few;
    double ratio = 1e9;
    for (int tries = 0; tries < 3 && ratio >= 6.0; ++tries)
        ratio = std::min(ratio, time_per_node(patch_of, many) / time_per_node(patch_of, few));
    CHECK(ratio < 6.0);
}

}  // namespace

TEST_CASE("a node among many springs behind a hand costs what it costs among few", "[slow]") {
    check_proportion(springs);
}

TEST_CASE("a node among many patches within a patch costs what it costs among few", "[slow]") {
    check_proportion(voices);
}
