// SPDX-License-Identifier: Apache-2.0
// Measurements as markups of 3D Slicer (.mrk.json).
#pragma once

#include "dsp/core/types.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::render {

/// Two points are a length, three an angle at the second one.
struct Measurement {
    std::string name;
    std::vector<Vec3> points;  ///< m, axes of the scans (LPS)
};

/// "12.30 mm"; with three points "12.30 mm, 8.00 mm, 45.0°"; "" with fewer than two.
std::string measurement_words(const Measurement& measured);

/// A file of markups in mm, schema 1.0.3: a Line or an Angle for each with two or three points, others left out.
std::string markups_text(std::span<const Measurement> all);

}  // namespace tactus::render
