// SPDX-License-Identifier: Apache-2.0
// Assembles a jaw in twelve pieces with the matcher alone, each piece from a start near its place.
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
    int missing;  ///< number of the smallest pieces that are missing
};

/// The cases: complete, with lost bone, and with lost pieces.
const std::vector<WholeCase>& whole_cases();

/// Results of every moving piece, over all seeds.
struct WholeCaseResult {
    std::vector<double> error, angle, seconds;  ///< m, of a piece's centre; degrees; s, processor time of a search
    std::vector<double> gap;  ///< m, mean signed distance of touching faces: the part of the kerf that stays open
    int fitted = 0;  ///< pieces with the verdict `fit`
    int within = 0;  ///< fitted pieces within 0.3 mm and 0.5 degrees
    int islands = 0;  ///< parts disconnected by lost pieces; the base piece of each is placed at the truth
    int alone = 0;  ///< pieces without any neighbour

    double worst_error() const;
    double worst_angle() const;
};

/// Each piece starts 5 mm and 10 degrees from its place, is fitted, and is settled twice more when all are placed.
WholeCaseResult put_together(const bone::Bone& bone, const WholeCase& kind, std::uint64_t seed, int seeds);

}  // namespace tactus::bench
