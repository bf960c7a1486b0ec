// SPDX-License-Identifier: Apache-2.0
// Patches of random nodes of the whole catalogue, and the runs of one that must all have the same bits.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tactus::test {

struct RandomPatch {
    std::string toml;
    std::set<std::string> types;  ///< of its nodes
    int nodes = 0;
    int links = 0;  ///< wires between groups
};

/// Ten to thirty nodes in groups of 48 kHz to 60 Hz, at least one node of each chaotic type among them, wires with every
/// mode of delivery, also back through a delay, and in half of the patches a simulated hand that is given a force. Node types and their
/// ports come from the catalogue, so that a new type takes part. The same seed gives the same patch.
RandomPatch random_patch(std::uint64_t seed);

/// Number of runs of a patch that are compared.
inline constexpr int run_variants = 13;

struct ComparedRuns {
    std::vector<std::string> differences;  ///< "offline, 4 threads: c.out and 3 more of 40"
    std::int64_t decisions = 0;  ///< of timing, in the live run whose threads are late
    std::int64_t missed =
        0;  ///< the same of the live run whose threads are on time: not compared to the offline run if any
    bool has_changed = false;  ///< lateness changed the bits: a replay that ignored its log would differ
};

/// Runs a patch for `seconds` in 13 variants: offline with 1, 2 and 4 threads, in blocks of 1, 16 and 480 and in random ones on 1
/// and 3 threads; live with threads on time, and its replay; live with late threads, and its replay on 1 thread and on
/// 3 in random blocks. Live runs are in virtual time; `seed` is that of the lateness.
ComparedRuns compare_runs(const std::string& toml, double seconds, std::uint64_t seed);

}  // namespace tactus::test
