// SPDX-License-Identifier: Apache-2.0
// A plug-in as a user writes it: two nodes, one of which gives a value of a type of its own.
#include "tests/plugins/grid.hpp"

#include <tactus/graph/node/plugin.hpp>

#include <cmath>

// A name that Tactus has, too: what is defined here must not meet it.
namespace tactus::nodes {
inline double helper(double v) { return std::sin(v); }
}  // namespace tactus::nodes

using namespace tactus;

struct Fold {
    static constexpr auto about = "Folds a signal back into ±1.";
    In<Signal> in{"signal"};
    Out<Signal> out{"folded"};
    Param gain{"2", "0", "100", "before it is folded"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i)
            out[i] = static_cast<float>(nodes::helper(gain * static_cast<double>(in[i])));
    }
};
TACTUS_NODE(Fold, in, out, gain)

struct CountTicks {
    static constexpr auto about = "Counts its ticks.";
    Out<shared::Counts> counts{"since the run began"};

    void prepare(const Setup&) { counts = shared::Counts{}; }
    void process(const Tick& tick) noexcept {
        const auto count = tick.index + 1;
        counts = shared::Counts{count, static_cast<std::uint64_t>(count), static_cast<double>(count)};
    }
};
TACTUS_NODE(CountTicks, counts)

TACTUS_PLUGIN("test-fold", "1.2", Fold, CountTicks)
