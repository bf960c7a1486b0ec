// SPDX-License-Identifier: Apache-2.0
// Summarises a volume, mesh or bone file.
#pragma once

#include "assets/mesh/write_mesh.hpp"
#include "dsp/volume/histogram.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// One bone, label or connected part.
struct InspectedPart {
    std::string name;
    double volume_mm3 = 0.0;
    std::array<std::array<double, 2>, 3> bounds_mm{};  ///< minimum and maximum along x, y, z; LPS
};

struct Inspection {
    std::string kind;   ///< "ct", "labels", "mesh" or "bone"
    std::string frame;  ///< frame of the file: "LPS" or "RAS"
    std::array<int, 3> size{};
    std::array<double, 3> spacing_mm{};
    bool uniform = true;
    double tilt_deg = 0.0;
    std::string hu;                    ///< "calibrated", "masked", "scanner" or "none"
    bool is_in_hu = false;             ///< of a scan: the values are HU
    std::array<double, 2> range{};     ///< range of the values: HU or scanner values, labels, or kg/m³ for a bone
    std::optional<double> threshold;   ///< for a CT: the one that import uses without --threshold
    std::string threshold_from;        ///< its method
    std::string unit;                  ///< of a mesh: "mm", "cm" or "m"; otherwise "mm"; "" if it must be given
    std::string unit_question;         ///< the question about the unit, one sentence; see volume::unit_question
    std::vector<InspectedPart> parts;  ///< largest first; labels and bones in file order
    std::size_t parts_in_all = 0;      ///< includes small parts of a CT that are not listed
    volume::Histogram histogram;               ///< 24 bins
    std::vector<std::string> notes;    ///< corrections while reading, and problems

    volume::Grid grey;                              ///< for the slices: values on LPS axes; empty for a mesh
    std::array<double, 2> window{};         ///< black and white level of the slices
    bool is_labels = false;                 ///< slices are coloured by label
    std::vector<mesh::ColouredSurface> surfaces;  ///< surfaces for the view
    /// For bones: the points of each of `surfaces` that are painted as fracture; m, unit normals outwards.
    struct Painted {
        Vec3 at, normal;
    };
    std::vector<std::vector<Painted>> painted;
};

/// Settings for reading the file, as in bone::ImportOptions.
struct InspectionOptions {
    std::string series;
    std::optional<std::string> unit;
    std::optional<std::pair<double, double>> rescale;
    bool fill_gaps = false;
};

/// Reads and measures a volume, mesh or bone file. Throws Error when it cannot be read.
Inspection inspect(const std::filesystem::path& path, const InspectionOptions& options = {});

}  // namespace tactus::analysis
