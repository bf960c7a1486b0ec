// SPDX-License-Identifier: Apache-2.0
// Scans in GPU memory, drawn on the section of a body where a plane cuts it.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/display/camera.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::display {

/// The values that are drawn as black and white.
struct GreyScale {
    double black = 0.0, white = 1.0;
};

/// A scan as stored.
struct GreyImage {
    std::array<int, 3> size{};
    std::vector<std::uint8_t> grey;
    Mat4 to_texture{1.0};  ///< from the frame of the grid to the texture's coordinates
    bool empty() const { return grey.empty(); }
};

/// Returns the grey values of a grid of at least 2 samples per axis in 8 bits. A very large grid is subsampled to every
/// n-th sample. Empty for an empty grid. Needs no context, and can run on another thread.
GreyImage grey_image(const volume::Grid& grid, const GreyScale& scale);

/// All scans of one OpenGL context, which must be current in every call.
class ScanPool {
public:
    using Scan = int;

    ScanPool() = default;
    ~ScanPool();
    ScanPool(const ScanPool&) = delete;
    ScanPool& operator=(const ScanPool&) = delete;

    /// Uploads an image; returns -1 for an empty one.
    Scan make(const GreyImage& image);
    void remove(Scan scan);
    /// Transform from the frame of the grid to the texture's coordinates.
    const Mat4& to_texture(Scan scan) const { return scans_[static_cast<std::size_t>(scan)].to_texture; }
    /// Binds to texture unit 0.
    void bind(Scan scan) const;

private:
    struct Texture {
        std::uint32_t name = 0;
        Mat4 to_texture{1.0};
    };
    std::vector<Texture> scans_;
};

}  // namespace tactus::display
