// SPDX-License-Identifier: Apache-2.0
// Poses and motions as text and JSON.
#pragma once

#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/surface_file.hpp"

#include <string>
#include <string_view>

namespace tactus::command {

/// {position_mm, quaternion_wxyz}, in a JSON type.
template <class Json>
Json pose_json(const Pose& pose) {
    const study::PoseNumbers numbers = study::numbers_of(pose);
    return {{"position_mm", numbers.position_mm}, {"quaternion_wxyz", numbers.quaternion_wxyz}};
}

/// In a JSON type.
template <class Json>
Json motion_json(const study::Motion& motion) {
    return {{"distance_mm", 1e3 * motion.distance}, {"angle_deg", motion.angle_deg}};
}

/// "X,Y,Z,QW,QX,QY,QZ" in mm. Throws Error naming the option.
Pose pose_of_text(const std::string& text, std::string_view option);

/// Explanation of a fit that only reproduces the scan (dsp/fit/as_scanned.hpp).
inline constexpr std::string_view as_scanned_note =
    "the fit only reproduces the scanned position: the border between two labels fits itself wherever the fragments "
    "lie, so it does not show where they belong; compare with the healthy side ('tactus plan mirror')";

/// About the surface that fits leave out, of a fragment or a file; `area` in m².
std::string left_out_words(std::string_view name, double area);

}  // namespace tactus::command
