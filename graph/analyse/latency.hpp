// SPDX-License-Identifier: Apache-2.0
// The largest age, in logical time, of values that leave a patch.
#pragma once

#include "graph/compile/schedule.hpp"

#include <limits>
#include <string>
#include <vector>

namespace tactus::analyse {

struct PathLatency {
    std::string from, to;          ///< names of nodes
    double latency_ms = 0.0;       ///< largest age at the end of the path of a value from its start
    std::vector<std::string> via;  ///< the nodes on the path, both ends included
};

/// Largest age, over all activations of the consumer, of the value that a wire between two groups delivers.
Flicks worst_age(const compile::ScheduleGroup& producer, const compile::ScheduleGroup& consumer,
                 const compile::ScheduleWire& wire);

inline constexpr Flicks unreached = std::numeric_limits<Flicks>::max();

/// Ages along the quickest path from one node to each other node: the age of the value there (or `unreached`) and the
/// previous node on that path (−1: none).
struct Ages {
    std::vector<Flicks> age;
    std::vector<int> before;
};
Ages ages_from(const compile::Schedule& plan, int source);

/// Per node: the age that a value gains on the quickest path from it to `sink`, or `unreached`.
std::vector<Flicks> ages_to(const compile::Schedule& plan, int sink);

/// Returns the quickest path from every device input to every output of the patch (device_output, audio_output,
/// record), in order of names. Inside a group values are passed on in the same tick and do not age.
std::vector<PathLatency> path_latencies(const compile::Schedule& plan);

}  // namespace tactus::analyse
