// SPDX-License-Identifier: Apache-2.0
// What a node and a wire between groups cost per activation, hashing of every published value included.
#include "engine/run/engine.hpp"
#include "nodes/catalogue.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

using namespace tactus;

namespace tactus::test {

/// A snapshot of nothing, as those of bones are published.
struct Page {
    static constexpr std::string_view wire_name = "page";
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;
};

struct Printer {
    static constexpr auto about = "Makes versions.";
    Out<Page> page{"the newest"};

    void process(const Tick&) noexcept {
        const std::int64_t next = page.get().version + 1;
        page = {next, static_cast<std::uint64_t>(next)};
    }
};
TACTUS_NODE(Printer, page)

struct Reader {
    static constexpr auto about = "Reads versions.";
    In<Page> page{"to read"};
    Out<double> version{"read"};

    void process(const Tick&) noexcept { version = static_cast<double>(page->version); }
};
TACTUS_NODE(Reader, page, version)

struct Echo {
    static constexpr auto about = "Hands a number on.";
    In<double> in{"number"};
    Out<double> out{"the same"};

    void process(const Tick&) noexcept { out = in.get(); }
};
TACTUS_NODE(Echo, in, out)

}  // namespace tactus::test

namespace {

compile::Schedule plan_of(const std::string& text, compile::Catalogue catalogue = nodes::catalogue()) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "bench.toml", problems);
    std::optional<compile::Schedule> plan = compile::compile(patch, catalogue, problems);
    if (!problems.empty()) throw problems.list.front();
    return std::move(*plan);
}

std::string chain(int gains) {
    std::string wires = "\"tone.signal -> g0.in\",", nodes = "[nodes.tone]\ntype = \"sine\"\nrate = \"48 kHz\"\n";
    for (int i = 0; i < gains; ++i) {
        if (i > 0) wires += fmt::format("\"g{}.out -> g{}.in\",", i - 1, i);
        nodes += fmt::format("[nodes.g{}]\ntype = \"gain\"\nrate = \"48 kHz\"\n", i);
    }
    return "wires = [" + wires + "]\n" + nodes;
}

void run_patch(benchmark::State& state, const std::string& text, double seconds, int block) {
    for (auto _ : state) {
        state.PauseTiming();
        run::EngineOptions options;
        options.seconds = seconds;
        options.block = block;
        run::Engine engine(plan_of(text), options);
        state.ResumeTiming();
        engine.render(1);
        benchmark::DoNotOptimize(engine.output_hash());
    }
}

/// A chain of gains: ns per node and call, beside the same chain as a plain loop over function pointers.
void node_in_a_chain(benchmark::State& state) {
    constexpr int gains = 400;
    const int block = static_cast<int>(state.range(0));
    const double seconds = block == 1 ? 0.02 : 0.5;
    run_patch(state, chain(gains), seconds, block);
    const double calls = 48000.0 * seconds / block * (gains + 1);
    state.counters["ns_per_node_and_call"] =
        benchmark::Counter(calls * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(node_in_a_chain)->Arg(1)->Arg(64)->Unit(benchmark::kMillisecond)->UseRealTime();

void plain_loop(benchmark::State& state) {
    const int block = static_cast<int>(state.range(0)), gains = 400;
    std::vector<std::vector<float>> buffers(gains + 1, std::vector<float>(static_cast<std::size_t>(block), 0.5f));
    void (*gain)(const float*, float*, int) = [](const float* in, float* out, int n) {
        for (int i = 0; i < n; ++i) out[i] = 1.0f * in[i];
    };
    benchmark::DoNotOptimize(gain);
    for (auto _ : state) {
        for (std::size_t i = 0; i < gains; ++i) gain(buffers[i].data(), buffers[i + 1].data(), block);
        benchmark::ClobberMemory();
    }
    state.counters["ns_per_node_and_call"] =
        benchmark::Counter(gains * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(plain_loop)->Arg(1)->Arg(64);

/// 100 numbers from a 1 kHz to a 500 Hz group, against the same nodes without the wires.
void wires_between_groups(benchmark::State& state) {
    const bool wired = state.range(0) != 0;
    std::string wires, nodes;
    for (int i = 0; i < 100; ++i) {
        if (wired) wires += fmt::format("\"a{0}.value -> b{0}.number\",", i);
        nodes += fmt::format(
            "[nodes.a{0}]\ntype = \"constant\"\nrate = \"1 kHz\"\n[nodes.b{0}]\ntype = \"constant\"\nrate = \"500 "
            "Hz\"\n",
            i);
    }
    run_patch(state, "wires = [" + wires + "]\n" + nodes, 2.0, 0);
    state.counters["ns_per_wire_and_producer_tick"] = benchmark::Counter(
        100 * 2000 * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(wires_between_groups)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Snapshots, each delayed by a tick, in a group that has other delayed wires: who still looks at them is asked per call.
void snapshots_among_delays(benchmark::State& state) {
    std::string wires, nodes;
    const auto add = [&](const std::string& name, const char* type) {
        nodes += fmt::format("[nodes.{}]\ntype = \"{}\"\nrate = \"1 kHz\"\n", name, type);
    };
    for (int i = 0; i < state.range(0); ++i) {
        wires += fmt::format("\"p{0}.page -> r{0}.page as delay 1\",", i);
        add(fmt::format("p{}", i), "printer");
        add(fmt::format("r{}", i), "reader");
    }
    for (int i = 0; i < state.range(1); ++i) {
        wires += fmt::format("\"e{0}.out -> e{0}.in as delay 1\",", i);
        add(fmt::format("e{}", i), "echo");
    }
    static const std::array<const NodeType*, 3> types{&test::node_type_Printer(), &test::node_type_Reader(),
                                                      &test::node_type_Echo()};
    constexpr double seconds = 2.0;
    for (auto _ : state) {
        state.PauseTiming();
        run::EngineOptions options;
        options.seconds = seconds;
        run::Engine engine(plan_of("wires = [" + wires + "]\n" + nodes, types), options);
        state.ResumeTiming();
        engine.render(1);
    }
    state.counters["us_per_call"] = benchmark::Counter(
        1000 * seconds * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(snapshots_among_delays)->Args({1, 1000})->Args({20, 1000})->Unit(benchmark::kMillisecond);

}  // namespace
