// SPDX-License-Identifier: Apache-2.0
// What one tick of snap-to-fit costs while a fragment is led about the place where it fits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::bench {

/// One mode: pull, contact and coupling together, processor time of one thread.
struct LiveTicks {
    std::string method;  ///< "extended", "baseline"
    std::size_t painted_points = 0;  ///< of both fragments together, about 5,000
    int ticks = 0;
    double in_time = 0.0;  ///< share of ticks under 0.5 ms
    double median_ms = 0.0, p99_ms = 0.0;
    double evaluations = 0.0;  ///< of the contact per tick, mean
};

std::vector<LiveTicks> bench_snap_live();

}  // namespace tactus::bench
