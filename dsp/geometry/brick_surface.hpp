// SPDX-License-Identifier: Apache-2.0
// The surface of a bone by marching tetrahedra, brick by brick: after carving, only changed bricks are meshed again.
// The triangles of all bricks together equal those of iso_surface over the whole bone; there are no cracks between
// bricks.
#pragma once

#include "dsp/volume/bricks.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus::geometry {

/// A vertex in the format of graphics hardware. m; normal of unit length times 32767; sRGB 0 to 255 and opacity.
struct SurfaceVertex {
    std::array<float, 3> position{};
    std::array<std::int16_t, 4> normal{};
    std::array<std::uint8_t, 4> colour{255, 255, 255, 255};
    bool operator==(const SurfaceVertex&) const = default;
};
static_assert(sizeof(SurfaceVertex) == 24);

/// Triangles counter-clockwise seen from outside.
struct SurfacePatch {
    std::vector<SurfaceVertex> vertices;
    std::vector<std::uint32_t> triangles;  ///< three vertices each
    bool operator==(const SurfacePatch&) const = default;
};

/// Colour by density: porous core green, dense cortex white (thesis 6.2.2), linear in between.
struct DensityColours {
    double core_density = 500.0, cortex_density = 1500.0;  ///< kg/m³
    Vec3 core{0.35, 0.68, 0.33}, cortex{0.96, 0.94, 0.88};  ///< sRGB, 0 to 1

    Vec3 operator()(double density) const noexcept;
};

/// Keeps its working memory. Not thread-safe.
class BrickSurface {
public:
    DensityColours colours;

    /// The surface within one brick (distance = 0), replacing the content of `patch`. Normals are the gradient of the
    /// distance. A vertex takes the maximum density within 3.5 voxels below it, because a scan blurs the rim of every
    /// bone. A brick that is not stored has no surface.
    void make(const volume::BoneSnapshot& bone, std::uint32_t brick, SurfacePatch& patch);

private:
    std::array<std::int32_t, 7 * volume::brick_samples> vertex_{};  // per sample and edge direction
};

/// Packs a vector of any length.
std::array<std::int16_t, 4> packed_normal(const Vec3& normal) noexcept;
std::array<std::uint8_t, 4> packed_colour(const Vec3& colour, double opacity = 1.0) noexcept;

}  // namespace tactus::geometry
