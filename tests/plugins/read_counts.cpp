// SPDX-License-Identifier: Apache-2.0
// Reads the values of another plug-in.
#include "tests/plugins/grid.hpp"

#include <tactus/graph/node/plugin.hpp>

using namespace tactus;

struct ReadCounts {
    static constexpr auto about = "The number in counts.";
    In<shared::Counts> counts{"of another plug-in"};
    Out<double> total{"of the ticks"};

    void process(const Tick&) noexcept { total = counts->total; }
};
TACTUS_NODE(ReadCounts, counts, total)

TACTUS_PLUGIN("test-read", "1.0", ReadCounts)
