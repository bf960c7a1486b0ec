// SPDX-License-Identifier: Apache-2.0
// Fits two fragments and reports a verdict.
#pragma once

#include "dsp/fit/fit.hpp"
#include "dsp/fit/kerf_check.hpp"
#include "tools/analysis/bone/surface_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Source of a fragment's paint.
struct FragmentPaint {
    std::optional<std::filesystem::path> file;  ///< strokes of 'fracture-surface'
    std::vector<Vec3> strokes;                  ///< with `radius`: centres of brush strokes, m
    std::optional<double> radius;  ///< m; none and no file: paint of the bone file, otherwise proposed
    std::string name;  ///< name of the strokes in the result
};

struct SnapSettings {
    std::filesystem::path moving, fixed;  ///< bone files or closed meshes
    FragmentPaint moving_paint, fixed_paint;
    Pose start;  ///< start pose of the moving fragment
    fit::FitMode mode = fit::FitMode::extended;
    std::optional<double> kerf;  ///< m, bone lost along the faces; 0: nothing was lost
};

/// The painted faces of a fragment.
struct SnappedSide {
    std::string paint;  ///< source of the paint: "file", "proposed" or the name of strokes
    std::vector<double> areas;  ///< area of each face, m²
    double as_scanned = 0.0;  ///< m² in contact with another fragment in the scan, which are excluded
};

struct Snapped {
    fit::Fit fit;
    std::optional<fit::KerfEstimate> kerf;  ///< if faces fit; included in verdict and bound
    bool as_scanned = false;  ///< the fit only reproduces the scanned position; the verdict is then ambiguous
    Motion moved;  ///< motion of the moving fragment's centre from the start
    double seconds = 0.0;  ///< duration of the fit, s
    SnappedSide moving, fixed;
};

/// Throws Error.
Snapped snap_files(const SnapSettings& settings);

}  // namespace tactus::analysis
