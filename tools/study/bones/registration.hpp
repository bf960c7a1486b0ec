// SPDX-License-Identifier: Apache-2.0
// Lays one surface on another of the same shape, whole or the part of it that is elsewhere.
#pragma once

#include "dsp/fit/mirror.hpp"
#include "tools/study/bones/surface_file.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>

namespace tactus::study {

struct RegisterSettings {
    std::filesystem::path moving, fixed;              ///< bone files or meshes, which need not be closed
    double away = 1.5e-3, gap = 3e-3, margin = 2e-3;  ///< m, of a region that lies elsewhere
    bool mirror = false;                              ///< the moving one is of the other side of the body
    bool anywhere = false;                            ///< from any position; otherwise from where they lie
    bool region = false;                              ///< also find the part that lies elsewhere
};

/// The part that is not where the rest has it, laid on its place by itself, and what plain ICP of points says about it.
struct RegisteredRegion {
    fit::Registration registration;
    std::size_t points = 0;
    double area = 0.0;  ///< m²
    Motion away;  ///< of its middle, from where the rest has it
    Motion plain_away;  ///< the same by ICP of points
    double plain_to_points = 0.0, plain_median = 0.0;  ///< m, median distances of that
};

struct RegisteredSurface {
    fit::Registration registration;
    Pose pose;
    std::optional<fit::MirrorPlane> plane;  ///< with `mirror`
    std::optional<RegisteredRegion> region;
};

/// Throws Error.
RegisteredSurface register_files(const RegisterSettings& settings);

}  // namespace tactus::study
