// SPDX-License-Identifier: Apache-2.0
// Surface points of fragments, made once and kept (assets/cases/kept_points.hpp).
#pragma once

#include "assets/cases/kept_points.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::study {

/// The surface of a fragment with its paint: the points in a bone file, else sampled as they are for fits.
/// Throws Error.
std::vector<contact::SurfacePoint> points_of_fragment(const std::filesystem::path& path, std::string& note);

}  // namespace tactus::study
