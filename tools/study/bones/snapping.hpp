// SPDX-License-Identifier: Apache-2.0
// One fit of two fragments, with its verdict.
#pragma once

#include "dsp/fit/fit.hpp"
#include "tools/study/bones/surface_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

/// Where a fragment is broken.
struct FragmentPaint {
    std::optional<std::filesystem::path> file;  ///< strokes of 'fracture-surface'
    std::vector<Vec3> strokes;                  ///< with `radius`: middles of a brush, m
    std::optional<double> radius;  ///< m; none, and no file: what the bone file has painted, or else a proposal
    std::string name;  ///< of the strokes, in the answer
};

struct SnapSettings {
    std::filesystem::path moving, fixed;  ///< bone files or closed meshes
    FragmentPaint moving_paint, fixed_paint;
    Pose start;  ///< of the moving one
    fit::FitMode mode = fit::FitMode::extended;
};

/// The painted faces of a fragment.
struct SnappedSide {
    std::string paint;  ///< where the paint comes from: "file", "proposed" or the name of strokes
    std::vector<double> areas;  ///< m², of each face
};

struct Snapped {
    fit::Fit fit;
    bool as_scanned = false;  ///< the fit only repeats the scan; its verdict is ambiguous
    Motion moved;  ///< of the moving one's middle, from the start
    double seconds = 0.0;  ///< that the fit took
    SnappedSide moving, fixed;
};

/// Throws Error.
Snapped snap_files(const SnapSettings& settings);

}  // namespace tactus::study
