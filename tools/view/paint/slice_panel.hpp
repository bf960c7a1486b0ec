// SPDX-License-Identifier: Apache-2.0
// A slice in the painting window: drawn, scrolled, zoomed, painted.
#pragma once

#include "tools/view/paint/paint_bench.hpp"
#include "tools/view/painter.hpp"

#include <cstdint>
#include <string>

namespace tactus::view {

/// The three panels share what is seen, so that their cursors and sizes are linked.
struct SliceSight {
    Vec3 middle{0.0};             ///< m; in the middle of all panels, but for the axis across the slice
    double pixels_per_m = 0.0;    ///< 0: the scan is fitted into the panel first
};

class SlicePanel {
public:
    SlicePanel(PaintBench& bench, SliceSight& sight, Slice slice) : bench_(bench), sight_(sight), slice_(slice) {}
    ~SlicePanel();
    SlicePanel(const SlicePanel&) = delete;
    SlicePanel& operator=(const SlicePanel&) = delete;

    /// Fills the current child window. `fonts`: of the window.
    void draw(const Fonts& fonts);
    /// Pixel of a position in the last picture, relative to the window.
    Point place_of(const Vec3& position) const;

private:
    void refresh();
    void steer(const SlicePlane& plane, Point middle);
    void use_tool(const SlicePlane& plane, Point middle);
    void draw_marks(const Painter& paint, const SlicePlane& plane, Point middle, const Box& box, double scale) const;

    PaintBench& bench_;
    SliceSight& sight_;
    Slice slice_;
    SlicePlane plane_;
    Point middle_;
    std::uint32_t texture_ = 0;
    std::string shown_;  ///< what the texture shows
};

}  // namespace tactus::view
