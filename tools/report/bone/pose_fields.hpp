// SPDX-License-Identifier: Apache-2.0
// Poses, motions and the bound of a fit as fields of results, and notes about fits.
#pragma once

#include "dsp/fit/fit.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/report/result/fields.hpp"

#include <string>

namespace tactus::report {

/// position_mm, quaternion_wxyz
const Fields<Pose>& pose_fields();
/// distance_mm, angle_deg
const Fields<analysis::Motion>& motion_fields();
/// At 95 %: turn_deg, face_mm, far_mm; rival: the second best pose is within it.
const Fields<fit::PoseBound>& bound_fields();

/// Explanation of a fit that only reproduces the scan (dsp/fit/as_scanned.hpp).
inline constexpr const char* as_scanned_note =
    "the fit only reproduces the scanned position: the border between two labels fits itself wherever the fragments "
    "lie, so it does not show where they belong; compare with the healthy side ('tactus plan mirror')";

/// About the surface that fits leave out, of a fragment or a file; `area` in m².
std::string left_out_words(const std::string& name, double area);
/// The answer and how far the place may be from the true one; empty for a verdict without a place.
std::string bound_words(fit::FitVerdict verdict, const fit::PoseBound& bound);

}  // namespace tactus::report
