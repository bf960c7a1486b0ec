// SPDX-License-Identifier: Apache-2.0
// Files of a reconstruction: inputs with the flap, vessels, landmarks.
#pragma once

#include "assets/markup/markup.hpp"
#include "assets/reconstruction/reconstruction.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::reconstruction {

struct MarkedPoint {
    std::string name;
    Vec3 at{0.0};  ///< m, LPS
};

/// Returns the control points of a file of 3D Slicer (.mrk.json, .fcsv) by name; points without a label are numbered.
/// Throws Error, also for a file without points; `file` is its name in messages.
std::vector<MarkedPoint> marks_of(const markup::ReadPoints& read, const std::string& file);
/// The same from the file itself. `notes` receives a line for each point that was skipped because it has no position.
std::vector<MarkedPoint> read_marks(const std::filesystem::path& path, std::vector<std::string>& notes);

/// Reads a vessel from a table written by 'tactus vessel' (.csv; one of its branches, with the mean radius) or from a
/// file of curves of 3D Slicer (.mrk.json; the curve of that number from 0, others are noted). Its name is that of the file; `notes` as for read_marks. Throws Error.
FlapVessel read_vessel(const std::filesystem::path& path, VesselKind kind, int branch, std::vector<std::string>& notes);
FlapVessel vessel_of_table(std::string_view text, const std::string& file, int branch = 0);

/// Finds "artery" or "vein" in the name of a landmark. Throws Error for neither or both.
VesselKind kind_in(const std::string& name, const std::string& where);

struct ReconstructionInputs {
    FibulaInputs inputs;  ///< with surfaces
    Flap flap;
    std::filesystem::path donor, jaw, tumour;  ///< files; empty: none
    std::vector<std::string> notes;  ///< skipped items, one line each
};

/// Reads the members of read_fibula_inputs, and for the flap
///     "vessels": [{"name": "peroneal", "kind": "artery", "radius_mm": 1.5, "file": "artery.csv"}, ...],
///     "perforators": "marks.mrk.json", "sites": "sites.mrk.json", "plates": [...], "implants": [...], "paddle": {...},
///     "tumour": "tumour.stl", "margin_mm": 10
/// A vessel may have "points_mm" instead of "file"; with a file its name is optional. Perforators and sites may be
/// lists of objects, {"name", "at_mm"}, sites with "kind"; otherwise the kind is part of the name of each landmark.
/// Paths are relative to the file. Throws Error.
ReconstructionInputs read_reconstruction_inputs(const std::filesystem::path& path);

/// Reads a mesh in m, frame LPS; the file is in mm unless it states another unit. Throws Error, also for a mesh without
/// a unit that would be smaller than 5 mm or larger than 2 m in mm.
geometry::TriangleSurface read_surface(const std::filesystem::path& path);

}  // namespace tactus::reconstruction
