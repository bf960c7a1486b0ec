// SPDX-License-Identifier: Apache-2.0
// Registers a surface to another one of the same shape, as a whole and, on request, a displaced part separately.
#pragma once

#include "dsp/fit/registration/mirror.hpp"
#include "dsp/fit/registration/registration.hpp"
#include "tools/analysis/bone/surface_file.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>

namespace tactus::analysis {

struct RegisterSettings {
    std::filesystem::path moving, fixed;              ///< bone files or meshes, which need not be closed
    double away = 1.5e-3, gap = 3e-3, margin = 2e-3;  ///< m, for a displaced region
    bool mirror = false;                              ///< the moving surface is from the other side of the body
    bool anywhere = false;  ///< the positions in the files have no meaning; false: they decide between equal fits
    bool region = false;  ///< also find a displaced part
};

/// A displaced part with its own registration, and the result of plain point-to-point ICP for comparison.
struct RegisteredRegion {
    fit::Registration registration;
    std::size_t points = 0;
    double area = 0.0;  ///< m²
    Motion away;  ///< motion of its centre relative to the rest
    Motion plain_away;  ///< the same by point-to-point ICP
    double plain_to_points = 0.0, plain_median = 0.0;  ///< m, median distances of that ICP
};

struct RegisteredSurface {
    fit::Registration registration;
    Pose pose;
    std::optional<fit::JudgedRegistration> judged;  ///< of the whole; none with `mirror`
    std::optional<fit::MirrorPlane> plane;  ///< with `mirror`
    std::optional<RegisteredRegion> region;
};

/// Throws Error.
RegisteredSurface register_files(const RegisterSettings& settings);

}  // namespace tactus::analysis
