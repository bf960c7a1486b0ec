// SPDX-License-Identifier: Apache-2.0
// A jaw in twelve pieces, put together from beside each place by the matcher alone, without a hand.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::bench {

struct WholeCase {
    std::string_view name;
    double kerf;  ///< m, bone lost all along the fractures
    int missing;  ///< of the smallest pieces
};

/// Whole, with lost bone, and with lost pieces.
const std::vector<WholeCase>& whole_cases();

/// What became of every piece that moves, over all seeds.
struct WholeCaseResult {
    std::vector<double> error, angle, seconds;  ///< m of a piece's middle, degrees, processor time of a look
    std::vector<double> gap;  ///< m, mean signed distance of what lies on each other: what of a kerf stays open
    int fitted = 0;  ///< pieces with the verdict `fit`
    int within = 0;  ///< of these, within 0.3 mm and 0.5 degrees
    int islands = 0;  ///< parts that lost pieces cut off: each on its first piece, which is given its place
    int alone = 0;  ///< pieces that touch no other, for their neighbours are missing

    double worst_error() const;
    double worst_angle() const;
};

/// Each piece starts 5 mm and 10 degrees beside its place, is fitted, and settled twice more when all are there.
WholeCaseResult put_together(const bone::Bone& bone, const WholeCase& kind, std::uint64_t seed, int seeds);

}  // namespace tactus::bench
