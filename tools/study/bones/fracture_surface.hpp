// SPDX-License-Identifier: Apache-2.0
// Proposes where a fragment is broken, and takes corrections by hand.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/fit/registration.hpp"

#include <filesystem>
#include <optional>

namespace tactus::study {

struct FractureSurfaceSettings {
    std::filesystem::path bone;        ///< bone file or closed mesh
    std::filesystem::path paint;       ///< strokes by hand, instead of the proposal; empty: none
    std::filesystem::path facing;      ///< another fragment of the same scan: what faces it is proposed; empty: none
    std::filesystem::path intact;      ///< the unbroken bone: what lies inside of it is proposed; empty: none
    std::filesystem::path main;        ///< fragment that the unbroken bone is laid on first; empty: `bone`
    double roughness = 0.06;           ///< from which on a place is broken: mean of 1 − cos between normals
    double reach = 10e-3;              ///< m, how far what is faced may be
    std::optional<double> least_area;  ///< m²; each proposal has its own otherwise
    bool mirror = false;               ///< `intact` is the other side of the body
    bool correct = false;              ///< `paint` is used on top of the proposal
    bool keep = false;                 ///< start from the paint that the bone file has
};

/// How the unbroken bone could be laid.
struct LaidIntact {
    fit::Registration on_main;
    std::optional<fit::Registration> on_bone;  ///< by itself, when that is another fragment
};

struct FractureSurface {
    bone::Bone bone;  ///< its points are labelled
    std::optional<LaidIntact> intact;
};

/// Throws Error.
FractureSurface propose_fracture_surface(const FractureSurfaceSettings& settings);

}  // namespace tactus::study
