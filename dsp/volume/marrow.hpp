// SPDX-License-Identifier: Apache-2.0
// Marrow of bones: cavities enclosed by cortical bone, even if the shell has small holes.
#pragma once

#include "dsp/volume/components.hpp"

#include <cstddef>

namespace tactus::volume {

/// Criteria for marrow.
struct MarrowLimits {
    double closing = 1.5e-3;     ///< m: holes of a shell up to twice as wide are closed
    double half_width = 12e-3;   ///< m: a cavity in which a larger ball fits is not marrow, such as the cranium
    double max_air = 0.05;      ///< fraction of samples that are air: a cavity with more is a sinus
};

/// Returns the marrow in the samples of a box. `solid`: bone and its closed hollows. `air`: samples that are air.
/// `inner`: the scanned part of the box; a cavity that reaches its border stays open, as the spinal canal does. The
/// closing (dilation by a ball, then the enclosed cavities, dilated back; Serra 1982) works on runs, so that memory
/// grows with the surface, not with the volume. Gaps narrower than the closing, such as those of joints, enclose
/// nothing, because the dilation removes them.
RunRows marrow_of(const RunRows& solid, const RunRows& air, const Components::Box& inner, const Vec3& spacing,
                  const MarrowLimits& limits = {});

/// Returns the samples of either set.
RunRows united(const RunRows& a, const RunRows& b);
/// Returns the number of samples.
std::size_t count_of(const RunRows& rows);

}  // namespace tactus::volume
