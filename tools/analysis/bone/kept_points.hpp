// SPDX-License-Identifier: Apache-2.0
// Surface points of fragments, computed once and cached (assets/plan/kept_points.hpp).
#pragma once

#include "assets/plan/kept_points.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Returns the surface of a fragment with its paint: the points of a bone file, otherwise points sampled as for fits.
/// Throws Error.
std::vector<contact::SurfacePoint> points_of_fragment(const std::filesystem::path& path, std::string& note);

}  // namespace tactus::analysis
