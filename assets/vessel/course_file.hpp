// SPDX-License-Identifier: Apache-2.0
// Reads the centreline of a tracked vessel.
#pragma once

#include "dsp/core/types.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::vessel {

/// The main branch of a vessel, from its first node to its last.
struct Course {
    std::vector<Vec3> points;    ///< m, LPS; at least two, consecutive ones distinct
    std::vector<double> radius;  ///< m, of each point
    double median_radius() const;
};

/// Reads the rows of branch 0 of a table written by write_track: columns branch, x_mm, y_mm, z_mm and radius_mm. Throws
/// Error with the line for an invalid position or radius (0 to 20 mm), and for fewer than two rows or a median radius
/// below 0.1 mm.
Course load_course(const std::filesystem::path& path);
Course read_course(std::string_view text, const std::string& file);

}  // namespace tactus::vessel
