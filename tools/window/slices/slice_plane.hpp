// SPDX-License-Identifier: Apache-2.0
// A slice through a scan: where its pixels lie, and its picture. No user interface.
#pragma once

#include "dsp/volume/grid.hpp"
#include "tools/window/slices/live_labels.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tactus::window {

/// As a radiologist looks: the patient's left is right in the picture, the back is below or right, the head is above.
enum class Slice { axial, coronal, sagittal };
std::string_view name_of(Slice slice);
/// Letters at the left, right, upper and lower edge: of R, L, A, P, S (head) and I (feet).
std::array<std::string_view, 4> edges_of(Slice slice);

/// Axes of a slice in LPS: 0 x, 1 y, 2 z. `down` runs towards the feet where `is_upright`.
struct SliceAxes {
    int right, down, normal;
    bool is_upright;
};
SliceAxes axes_of(Slice slice);

/// What a panel shows: the slice through `middle`, which is in the middle of the panel.
struct SlicePlane {
    Slice slice = Slice::axial;
    Vec3 middle{0.0};          ///< m
    double pixels_per_m = 2000.0;

    /// Position of a pixel, relative to the middle of the panel.
    Vec3 position(Point pixel) const;
    Point pixel(const Vec3& position) const;
    /// Distance from the slice, m.
    double off(const Vec3& position) const;
};

/// Grey values from `low` (black) to `high` (white).
struct GreyWindow {
    double low = -200.0, high = 800.0;
};
/// From air to bright bone: 1 % and 99.5 % of the values of the scan.
GreyWindow suggested_window(const volume::Grid& grid);

/// What is laid over the grey values.
struct SliceOverlay {
    const analysis::ScanGraph* scan = nullptr;
    const LiveLabelling* labels = nullptr;  ///< null: nothing
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< of each label
    bool shows_certainty = false;  ///< uncertain places are bright
};

/// RGBA, one pixel per sample, first row on top.
struct SlicePicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};
/// The samples nearest to the slice. Positions outside of the grid show its border.
SlicePicture slice_picture(const volume::Grid& grid, Slice slice, const Vec3& through, const GreyWindow& window,
                           const SliceOverlay& overlay);
/// The corners of that picture in pixels of a panel: upper left, lower right.
std::array<Point, 2> corners_of(const volume::Grid& grid, const SlicePlane& plane);

}  // namespace tactus::window
