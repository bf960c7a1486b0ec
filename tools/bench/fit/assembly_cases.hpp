// SPDX-License-Identifier: Apache-2.0
// Broken bones with known truth that are put together without help.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench {

struct AssemblyCase {
    bool is_jaw = true;  ///< else the fibula
    int pieces = 2, missing = 0;  ///< missing: number of the smallest
    std::uint64_t seed = 1;
    double chips = 0.0;  ///< share of each fracture
};

/// Case `number`: jaws in 2 to 12 pieces, fibulas in 2 to 6, chips of 0 to 20 %, a missing piece in every fourth.
AssemblyCase assembly_case(int number);

struct AssemblyScore {
    int pieces = 0;
    int with_neighbour = 0;  ///< pieces that broke from another one that is there, on 20 mm² or more
    int placed = 0;  ///< of these: in the largest right part of all that hang together in truth
    int within = 0;  ///< of the placed: within 0.3 mm at their faces
    int falsely = 0;  ///< pieces in a part that lie more than 1 mm off at their faces, or on no neighbour
    double worst_error = 0.0;  ///< m, at the faces of the placed
    double seconds = 0.0;  ///< processor time of the assembly, all threads
    std::vector<std::string> apart;  ///< per part that does not hang together with the first: what was refused
};

AssemblyScore put_together(const AssemblyCase& one);

}  // namespace tactus::bench
