// SPDX-License-Identifier: Apache-2.0
// Marrow of bones: what a shell of cortical bone encloses although it leaks.
#pragma once

#include "dsp/volume/components.hpp"

#include <cstddef>

namespace tactus::volume {

/// What counts as marrow.
struct MarrowLimits {
    double closing = 1.5e-3;     ///< m: holes of a shell up to twice as wide are closed
    double half_width = 12e-3;   ///< m: a cavity into which a wider ball fits is none of marrow, as that of the cranium
    double most_air = 0.05;      ///< share of samples that are air: a cavity with more of them is a sinus
};

/// Marrow in the samples of a box. `solid`: bone and its closed hollows. `air`: samples that are air. `inner`: the part of the
/// box that was scanned; what reaches its border stays open, as the spinal canal does. Closing (dilation by a ball, then the
/// cavities that are enclosed, dilated back; Serra 1982) works on runs: memory grows with the surface, not with the volume.
/// Gaps narrower than the closing, as those of joints, enclose nothing: dilation leaves none of them.
RunRows marrow_of(const RunRows& solid, const RunRows& air, const Components::Box& inner, const Vec3& spacing,
                  const MarrowLimits& limits = {});

/// Samples of either.
RunRows united(const RunRows& a, const RunRows& b);
/// Number of samples.
std::size_t count_of(const RunRows& rows);

}  // namespace tactus::volume
