// SPDX-License-Identifier: Apache-2.0
// A node of one's own in a patch that this program runs, by the C++ headers. They change with each minor version; the C
// functions (../embed-c) do not.
#include <tactus/engine/run/engine.hpp>
#include <tactus/graph/node/node.hpp>
#include <tactus/nodes/catalogue.hpp>

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

using namespace tactus;

/// Folds what comes in back into ±1: a distortion with many harmonics.
struct Fold {
    static constexpr auto about = "Folds a signal back into ±1.";
    In<Signal> in{"signal"};
    Out<Signal> out{"folded"};
    Param gain{"2", "0", "100", "before it is folded"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) out[i] = static_cast<float>(std::sin(gain * static_cast<double>(in[i])));
    }
};
TACTUS_NODE(Fold, in, out, gain)

int main() try {
    const compile::Catalogue known = nodes::catalogue();
    std::vector<const NodeType*> types(known.begin(), known.end());
    types.push_back(&node_type_Fold());

    patch::Problems problems;
    const char* text = R"(
wires = ["voice.signal -> fold.in"]
[nodes.voice]
type = "sine"
rate = "48 kHz"
frequency = "100 Hz"
[nodes.fold]
type = "fold"
rate = "48 kHz"
)";
    auto plan = compile::compile(patch::read_patch(text, "example.toml", problems), types, problems);
    for (const Error& error : problems.list) std::fprintf(stderr, "%s\n", error.what());
    if (!plan) return 2;

    observe::Observer observer(observe::Observer::Pace::lossless);
    observer.watch("fold.out", observe::Watch::every);
    run::EngineOptions options;
    options.seconds = 1.0;
    options.observer = &observer;
    run::Engine engine(std::move(*plan), options);
    engine.render(1);
    observer.advance();
    observe::SeenValues values;
    observer.fetch("fold.out", values);
    double sum = 0.0;
    for (const double v : values.columns) sum += v * v;
    std::printf("%zu samples, r.m.s. %.4f\n", values.columns.size(),
                std::sqrt(sum / static_cast<double>(values.columns.size())));
    return values.columns.size() == 48000 ? 0 : 1;
} catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 2;
}
