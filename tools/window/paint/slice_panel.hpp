// SPDX-License-Identifier: Apache-2.0
// A slice in the painting window: drawn, scrolled, zoomed, painted.
#pragma once

#include "tools/window/paint/paint_bench.hpp"
#include "tools/window/slices/slice_view.hpp"
#include "tools/window/widgets/painter.hpp"

namespace tactus::window {

class SlicePanel {
public:
    SlicePanel(PaintBench& bench, SliceSight& sight, Slice slice) : bench_(bench), sight_(sight), slice_(slice) {}

    /// Fills the current child window. `fonts`: of the window.
    void draw(const Fonts& fonts);
    /// Pixel of a position in the last picture, relative to the window.
    Point place_of(const Vec3& position) const;

private:
    void refresh();
    void use_tool(const SlicePlane& plane, Point middle);
    void draw_marks(const Painter& paint, const SlicePlane& plane, Point middle, const Box& box, double scale) const;

    PaintBench& bench_;
    SliceSight& sight_;
    Slice slice_;
    SlicePlane plane_;
    Point middle_;
    SliceTexture texture_;
};

}  // namespace tactus::window
