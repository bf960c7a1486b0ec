// SPDX-License-Identifier: Apache-2.0
// What all slices share: their picture on the graphics card, and how mouse and wheel change what is seen.
#pragma once

#include "tools/window/slices/slice_plane.hpp"
#include "tools/window/widgets/painter.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace tactus::window {

/// Linked slices share what is seen, so that their cursors and sizes are the same.
struct SliceSight {
    Vec3 middle{0.0};             ///< m; in the middle of all panels, but for the axis across the slice
    double pixels_per_m = 0.0;    ///< 0: not fitted yet

    /// Fits a length into a panel, its middle at a place.
    void fit(Point size, double widest_m, const Vec3& at);
    /// Of a slice through `cursor`.
    SlicePlane plane(Slice slice, const Vec3& cursor) const;
};

/// Belongs to one OpenGL context, which must be current in every call.
class SliceTexture {
public:
    SliceTexture() = default;
    ~SliceTexture();
    SliceTexture(const SliceTexture&) = delete;
    SliceTexture& operator=(const SliceTexture&) = delete;

    /// Makes the picture again when what it shows, in words, has changed.
    void show(const std::string& what, const std::function<SlicePicture()>& make);
    void draw(const Painter& paint, Point upper_left, Point lower_right) const;

private:
    std::uint32_t texture_ = 0;
    std::uint64_t version_ = 0;
    std::string shown_;
};

/// Applies mouse and wheel over the item drawn last: middle, or shift and left: move; right: grey values; wheel: the
/// next slice, which moves `cursor` by that spacing; ctrl and wheel: zoom. `middle`: pixel of the panel's middle.
void steer_slice(const SlicePlane& plane, Point middle, double spacing, SliceSight& sight, GreyWindow& window,
                 Vec3& cursor);

/// Lines through a place of the panel, open there.
void draw_slice_cursor(const Painter& paint, Point at, const Box& box, double scale);
/// The name of the slice with its place, and the sides of the patient.
void draw_slice_words(const Painter& paint, Slice slice, const Vec3& cursor, const Box& box, double scale);

}  // namespace tactus::window
