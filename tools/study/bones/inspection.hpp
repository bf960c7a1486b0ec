// SPDX-License-Identifier: Apache-2.0
// What is in a volume, mesh or bone file.
#pragma once

#include "assets/mesh/write_mesh.hpp"
#include "dsp/volume/histogram.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

/// One bone, label or connected part.
struct InspectedPart {
    std::string name;
    double volume_mm3 = 0.0;
    std::array<std::array<double, 2>, 3> bounds_mm{};  ///< least and greatest along x, y, z; LPS
};

struct Inspection {
    std::string kind;   ///< "ct", "labels", "mesh" or "bone"
    std::string frame;  ///< of the file: "LPS" or "RAS"
    std::array<int, 3> size{};
    std::array<double, 3> spacing_mm{};
    bool uniform = true;
    double tilt_deg = 0.0;
    std::string hu;                    ///< "calibrated", "masked", "scanner" or "none"
    std::array<double, 2> range{};     ///< of the values: HU or scanner numbers, labels, kg/m³ of a bone
    std::optional<double> threshold;   ///< for a CT
    std::vector<InspectedPart> parts;  ///< largest first; labels and bones in their own order
    std::size_t parts_in_all = 0;      ///< small parts of a CT are counted, not listed
    volume::Histogram histogram;               ///< 24 bins, for people
    std::vector<std::string> notes;    ///< what was set right while reading, or is wrong with it

    volume::Grid grey;                              ///< for slices: values on LPS axes; empty for a mesh
    std::array<double, 2> window{};         ///< black and white of the slices
    bool is_labels = false;                 ///< slices are coloured by label
    std::vector<mesh::ColouredSurface> surfaces;  ///< for the view
};

/// Reads a volume, mesh or bone file and measures it. Throws Error for what cannot be read.
Inspection inspect(const std::filesystem::path& path, const std::string& series = "");

}  // namespace tactus::study
