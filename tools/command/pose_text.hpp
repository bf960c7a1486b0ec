// SPDX-License-Identifier: Apache-2.0
// Poses and motions as text and JSON.
#pragma once

#include "dsp/fit/fit.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/surface_file.hpp"

#include <numbers>
#include <string>
#include <string_view>

namespace tactus::command {

/// {position_mm, quaternion_wxyz}, in a JSON type.
template <class Json>
Json pose_json(const Pose& pose) {
    const analysis::PoseNumbers numbers = analysis::numbers_of(pose);
    return {{"position_mm", numbers.position_mm}, {"quaternion_wxyz", numbers.quaternion_wxyz}};
}

/// In a JSON type.
template <class Json>
Json motion_json(const analysis::Motion& motion) {
    return {{"distance_mm", 1e3 * motion.distance}, {"angle_deg", motion.angle_deg}};
}

/// "X,Y,Z,QW,QX,QY,QZ" in mm. Throws Error naming the option.
Pose pose_of_text(const std::string& text, std::string_view option);

/// Whether a verdict names a place: "fit" and "fit, uncertain".
bool has_bound(fit::FitVerdict verdict);

/// The answer and how far the place may be from the true one.
std::string bound_words(fit::FitVerdict verdict, const fit::PoseBound& bound);

/// The bound of a pose at 95 %, in a JSON type. `rival`: the second best pose is in it.
template <class Json>
Json bound_json(const fit::PoseBound& bound) {
    return {{"turn_deg", bound.turn * 180.0 / std::numbers::pi},
            {"face_mm", bound.face * 1e3},
            {"far_mm", bound.far * 1e3},
            {"rival", bound.has_rival}};
}

/// Explanation of a fit that only reproduces the scan (dsp/fit/as_scanned.hpp).
inline constexpr std::string_view as_scanned_note =
    "the fit only reproduces the scanned position: the border between two labels fits itself wherever the fragments "
    "lie, so it does not show where they belong; compare with the healthy side ('tactus plan mirror')";

/// About the surface that fits leave out, of a fragment or a file; `area` in m².
std::string left_out_words(std::string_view name, double area);

}  // namespace tactus::command
