// SPDX-License-Identifier: Apache-2.0
#include "tools/window/slices/slice_plane.hpp"

#include "dsp/volume/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::window {

std::string_view name_of(Slice slice) {
    return slice == Slice::axial ? "axial" : slice == Slice::coronal ? "coronal" : "sagittal";
}

std::array<std::string_view, 4> edges_of(Slice slice) {
    if (slice == Slice::axial) return {"R", "L", "A", "P"};
    if (slice == Slice::coronal) return {"R", "L", "S", "I"};
    return {"A", "P", "S", "I"};
}

SliceAxes axes_of(Slice slice) {
    if (slice == Slice::axial) return {0, 1, 2, false};
    if (slice == Slice::coronal) return {0, 2, 1, true};
    return {1, 2, 0, true};
}

Vec3 SlicePlane::position(Point pixel) const {
    const SliceAxes axes = axes_of(slice);
    Vec3 p = middle;
    p[axes.right] += pixel.x / pixels_per_m;
    p[axes.down] += (axes.is_upright ? -1.0 : 1.0) * pixel.y / pixels_per_m;
    return p;
}

Point SlicePlane::pixel(const Vec3& position) const {
    const SliceAxes axes = axes_of(slice);
    const Vec3 d = (position - middle) * pixels_per_m;
    return {d[axes.right], axes.is_upright ? -d[axes.down] : d[axes.down]};
}

double SlicePlane::off(const Vec3& position) const {
    const int normal = axes_of(slice).normal;
    return std::abs(position[normal] - middle[normal]);
}

GreyWindow suggested_window(const volume::Grid& grid) {
    const volume::Histogram histogram = volume::histogram_of(grid.values, 2048);
    const auto share = [&](double wanted) {
        double seen = 0.0;
        for (std::size_t n = 0; n < histogram.counts.size(); ++n) {
            seen += static_cast<double>(histogram.counts[n]);
            if (seen >= wanted * static_cast<double>(grid.count())) return histogram.middle(n);
        }
        return histogram.high;
    };
    GreyWindow window{share(0.01), share(0.995)};
    // Air of HU is far darker than all that is looked at.
    if (window.low < -500.0 && window.high > 200.0) window.low = -300.0;
    if (!(window.high > window.low)) window.high = window.low + 1.0;
    return window;
}

SlicePicture slice_picture(const volume::Grid& grid, Slice slice, const Vec3& through, const GreyWindow& window,
                           const SliceOverlay& overlay) {
    const SliceAxes axes = axes_of(slice);
    const auto size = [&](int axis) { return grid.size[static_cast<std::size_t>(axis)]; };
    SlicePicture out{size(axes.right), size(axes.down), {}};
    out.rgba.resize(4 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    const double sample = (through[axes.normal] - grid.origin[axes.normal]) / grid.spacing[axes.normal];
    std::array<int, 3> at{};
    at[static_cast<std::size_t>(axes.normal)] =
        static_cast<int>(std::lround(std::clamp(sample, 0.0, size(axes.normal) - 1.0)));
    const double scale = 255.0 / std::max(1e-12, window.high - window.low);
    std::uint8_t* pixel = out.rgba.data();
    for (int row = 0; row < out.height; ++row) {
        at[static_cast<std::size_t>(axes.down)] = axes.is_upright ? out.height - 1 - row : row;
        for (int column = 0; column < out.width; ++column, pixel += 4) {
            at[static_cast<std::size_t>(axes.right)] = column;
            const double grey =
                std::clamp((static_cast<double>(grid.at(at[0], at[1], at[2])) - window.low) * scale, 0.0, 255.0);
            pixel[0] = pixel[1] = pixel[2] = static_cast<std::uint8_t>(std::lround(grey));
            pixel[3] = 255;
            if (!overlay.labels || !overlay.scan) continue;
            const volume::Grid& box = overlay.scan->box;
            std::array<int, 3> in_box{};
            bool is_inside = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                in_box[axis] = at[axis] - overlay.scan->box_at[axis];
                is_inside = is_inside && in_box[axis] >= 0 && in_box[axis] < box.size[axis];
            }
            if (!is_inside) continue;
            const std::int32_t node = overlay.scan->node_of_voxel[box.index(in_box[0], in_box[1], in_box[2])];
            if (node < 0) continue;
            const auto n = static_cast<std::size_t>(node);
            const std::uint8_t seed = overlay.labels->seed[n];
            const std::uint8_t label = overlay.labels->label.empty() ? seed : overlay.labels->label[n];
            if (label == 0 || label > overlay.colours.size()) continue;
            double cover = seed != 0 ? 0.85 : 0.4;
            std::array<std::uint8_t, 3> colour = overlay.colours[(seed != 0 ? seed : label) - 1u];
            if (overlay.shows_certainty && !overlay.labels->certainty.empty() && seed == 0 &&
                overlay.labels->certainty[n] < 0.4f) {
                colour = {255, 240, 60};
                cover = 0.75;
            }
            for (std::size_t c = 0; c < 3; ++c)
                pixel[c] = static_cast<std::uint8_t>((1.0 - cover) * grey + cover * colour[c]);
        }
    }
    return out;
}

std::array<Point, 2> corners_of(const volume::Grid& grid, const SlicePlane& plane) {
    const SliceAxes axes = axes_of(plane.slice);
    Vec3 first = grid.origin - 0.5 * grid.spacing, last = first;
    for (int axis = 0; axis < 3; ++axis) last[axis] += grid.spacing[axis] * grid.size[static_cast<std::size_t>(axis)];
    if (axes.is_upright) std::swap(first[axes.down], last[axes.down]);
    return {plane.pixel(first), plane.pixel(last)};
}

}  // namespace tactus::window
