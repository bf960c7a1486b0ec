// SPDX-License-Identifier: Apache-2.0
// Files of a reconstruction: inputs with the flap, vessels, marked points.
#pragma once

#include "assets/markup/markup.hpp"
#include "assets/reconstruct/reconstruction.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::reconstruct {

struct MarkedPoint {
    std::string name;
    Vec3 at{0.0};  ///< m, LPS
};

/// The control points of a file of 3D Slicer (.mrk.json, .fcsv) by name; points without a label are numbered. Throws
/// Error, also for a file without points; `file` is its name in messages.
std::vector<MarkedPoint> marks_of(const markup::ReadPoints& read, const std::string& file);
/// The same from the file itself. `notes` gets a line for each point that was left out because it has no position.
std::vector<MarkedPoint> read_marks(const std::filesystem::path& path, std::vector<std::string>& notes);

/// A vessel from a table as 'tactus vessel' writes it (.csv; one of its branches, with the mean radius) or from a curve of
/// 3D Slicer (.mrk.json). Its name is that of the file; `notes` as of read_marks. Throws Error.
FlapVessel read_vessel(const std::filesystem::path& path, VesselKind kind, int branch, std::vector<std::string>& notes);
FlapVessel vessel_of_table(std::string_view text, const std::string& file, int branch = 0);

/// "artery" or "vein" in the name of a mark. Throws Error for neither or both.
VesselKind kind_in(const std::string& name, const std::string& where);

struct ReconstructionInputs {
    FibulaInputs inputs;  ///< with surfaces
    Flap flap;
    std::filesystem::path donor, jaw, tumour;  ///< files; empty: none
    std::vector<std::string> notes;  ///< what was left out, one line each
};

/// What read_fibula_inputs reads, and of the flap
///     "vessels": [{"name": "peroneal", "kind": "artery", "radius_mm": 1.5, "file": "artery.csv"}, ...],
///     "perforators": "marks.mrk.json", "sites": "sites.mrk.json", "plates": [...], "implants": [...], "paddle": {...},
///     "tumour": "tumour.stl", "margin_mm": 10
/// A vessel may have "points_mm" in place of "file"; its name may be left out with a file. Perforators and sites may be
/// lists of objects, {"name", "at_mm"}, sites with "kind", which otherwise stands in the name of each mark. Paths are
/// relative to the file. Throws Error.
ReconstructionInputs read_reconstruction_inputs(const std::filesystem::path& path);

/// A mesh in m, frame LPS; mm unless it states another unit. Throws Error, also for a mesh without a unit that is smaller
/// than 5 mm or larger than 2 m in mm.
geometry::TriangleSurface read_surface(const std::filesystem::path& path);

}  // namespace tactus::reconstruct
