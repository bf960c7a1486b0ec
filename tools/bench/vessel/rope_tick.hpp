// SPDX-License-Identifier: Apache-2.0
// The cost of a whole force tick of a reconstruction.
#pragma once

#include <cstddef>
#include <vector>

namespace tactus::bench {

struct RopeTickCost {
    std::vector<double> whole, rope;  ///< µs of processor time: of each tick, and of each rope in it, sorted
    std::size_t points = 0;           ///< of the three ropes together
    double unsolved = 0.0;  ///< share of the ropes' ticks that ended with a larger unbalanced force than asked
    double touching = 0.0;  ///< share of the ticks in which pieces touched
};

/// The bundled reconstruction in its gap, with all pieces in contact: two stumps, three joined segments in the hand, and
/// artery, vein and a third vessel beside them, each sewn. The hand moves the joined segments by up to 12 mm about their
/// place. Each of `ticks` of 1 ms solves the held body and three ropes.
RopeTickCost measure_rope_tick(std::size_t ticks);

}  // namespace tactus::bench
