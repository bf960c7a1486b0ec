// SPDX-License-Identifier: Apache-2.0
// Offscreen rendering of triangle meshes: OpenGL 3.3 through surfaceless EGL. Without a graphics card Mesa renders in
// software; LP_NUM_THREADS limits its threads.
#pragma once

#include "dsp/core/types.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::display {

/// A lit, two-sided triangle mesh.
struct PictureMesh {
    std::vector<float> positions;          ///< x y z per vertex, m
    std::vector<float> normals;            ///< x y z per vertex, need not be of unit length
    std::vector<float> colours;            ///< r g b per vertex, 0 to 1
    std::vector<std::uint32_t> triangles;  ///< three vertices each
};

/// A perspective camera at `eye` that looks at `target`. m, rad.
struct View {
    Vec3 eye{0.0, 0.0, 1.0};
    Vec3 target{0.0, 0.0, 0.0};
    Vec3 up{0.0, 1.0, 0.0};
    double vertical_field_of_view_rad = 0.6;
};

/// An 8-bit sRGB image: r g b per pixel, rows from top to bottom.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;

    const std::uint8_t* pixel(int x, int y) const {
        return rgb.data() +
               3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
};

/// Returns the view along `direction` (from the eye into the scene) that fits the bounding sphere of the box from `low`
/// to `high` into an image of `aspect` = width / height. `up` must not be parallel to `direction`.
View fit_view(const Vec3& low, const Vec3& high, const Vec3& direction, const Vec3& up = {0.0, 0.0, 1.0},
              double aspect = 1.0);

/// Renders anti-aliased, with two lights on a light neutral background. Deterministic on one machine. Throws Error if
/// there is no OpenGL context, if the arrays of a mesh have inconsistent lengths, or for a size outside 1 to 8192
/// pixels.
Image render_picture(std::span<const PictureMesh> meshes, const View& view, int width, int height);

}  // namespace tactus::display
