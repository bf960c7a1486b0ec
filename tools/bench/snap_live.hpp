// SPDX-License-Identifier: Apache-2.0
// Cost of a tick of snap-to-fit while a fragment moves near its fitted pose.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::bench {

/// Results of a mode: attraction, contact and coupling; processor time of one thread.
struct LiveTicks {
    std::string method;  ///< "extended", "baseline"
    std::size_t painted_points = 0;  ///< of both fragments, about 5,000
    int ticks = 0;
    double in_time = 0.0;  ///< share of ticks under 0.5 ms
    double median_ms = 0.0, p99_ms = 0.0;
    double evaluations = 0.0;  ///< mean evaluations of the contact per tick
};

std::vector<LiveTicks> bench_snap_live();

}  // namespace tactus::bench
