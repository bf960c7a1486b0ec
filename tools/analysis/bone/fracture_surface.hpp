// SPDX-License-Identifier: Apache-2.0
// Proposes the fracture surface of a fragment and applies manual corrections.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/fit/registration/registration.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct FractureSurfaceSettings {
    std::filesystem::path bone;        ///< bone file or closed mesh
    std::filesystem::path paint;       ///< file of strokes instead of the proposal; empty: none
    std::vector<std::filesystem::path>
        facing;      ///< other fragments of the same scan: proposes the surface that faces them; empty: none
    std::filesystem::path intact;      ///< the unbroken bone: proposes the surface inside of it; empty: none
    std::filesystem::path main;        ///< fragment to which the unbroken bone is registered first; empty: `bone`
    double roughness = 0.06;           ///< threshold of roughness: mean of 1 − cos between normals
    double reach = 10e-3;              ///< m, greatest distance to `facing` or `intact`
    std::optional<double> min_area;  ///< m²; none: the default of each method
    bool mirror = false;               ///< `intact` is from the other side of the body
    bool correct = false;              ///< apply `paint` on top of the proposal
    bool whole = true;  ///< also load the bone's volume, for writing
    bool keep = false;                 ///< keep the paint of the bone file; `facing` and `intact` add to it
};

/// Registration of the unbroken bone.
struct LaidIntact {
    fit::Registration on_main;
    std::optional<fit::Registration> on_bone;  ///< to the fragment itself, if it is not the main one
};

struct FractureSurface {
    bone::Bone bone;  ///< its points are labelled; it has only points unless `whole`
    std::optional<LaidIntact> intact;
    double as_scanned = 0.0;  ///< m² in contact with another fragment in the scan, which cannot be painted
    std::string note;  ///< about an invalid cached result (kept_result.hpp); otherwise empty
};

/// Throws Error.
FractureSurface propose_fracture_surface(const FractureSurfaceSettings& settings);

}  // namespace tactus::analysis
