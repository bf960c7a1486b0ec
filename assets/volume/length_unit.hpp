// SPDX-License-Identifier: Apache-2.0
// Units of files that may not state theirs. Without one mm is assumed, unless no bone has that size in mm.
#pragma once

#include <string>
#include <string_view>

namespace tactus::volume {

/// Sizes in mm, along the longest side.
struct PlausibleSize {
    double least, most;
};
/// From a patella to a femur. Smaller bones exist, but a long bone in cm has the same numbers, so the user must state the unit.
constexpr PlausibleSize plausible_bone{50.0, 600.0};
/// The field of view of a scan.
constexpr PlausibleSize plausible_scan{50.0, 3000.0};

/// Metres in "mm", "cm" or "m". Throws Error for anything else.
double metres_in(std::string_view unit);

/// Question about the unit of `what` ("the mesh"), which is `extent` units across: one sentence with the options; empty
/// if mm is plausible.
std::string unit_question(std::string_view what, double extent, const PlausibleSize& size);

}  // namespace tactus::volume
