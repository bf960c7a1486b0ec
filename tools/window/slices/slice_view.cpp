// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "tools/window/slices/slice_view.hpp"

#include "tools/window/frame/damage.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::window {

void SliceSight::fit(Point size, double widest_m, const Vec3& at) {
    pixels_per_m = 0.92 * std::min(size.x, size.y) / std::max(widest_m, 1e-3);
    middle = at;
}

SlicePlane SliceSight::plane(Slice slice, const Vec3& cursor) const {
    SlicePlane plane{slice, middle, pixels_per_m};
    const int normal = axes_of(slice).normal;
    plane.middle[normal] = cursor[normal];
    return plane;
}

SliceTexture::~SliceTexture() {
    if (texture_ != 0) glDeleteTextures(1, &texture_);
}

void SliceTexture::show(const std::string& what, const std::function<SlicePicture()>& make) {
    if (what == shown_ && texture_ != 0) return;
    shown_ = what;
    ++version_;
    const SlicePicture picture = make();
    if (texture_ == 0) glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (const GLenum edge : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, edge, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);  // voxels stay voxels
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 picture.rgba.data());
    glBindTexture(GL_TEXTURE_2D, 0);
}

void SliceTexture::draw(const Painter& paint, Point upper_left, Point lower_right) const {
    if (texture_ == 0) return;
    say_version(texture_, version_);
    paint.list()->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)), vec(upper_left),
                           vec(lower_right));
}

void steer_slice(const SlicePlane& plane, Point middle, double spacing, SliceSight& sight, GreyWindow& window,
                 Vec3& cursor) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return;
    const Point by = point(io.MouseDelta);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 1.0f) ||
        (io.KeyShift && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0f)))
        sight.middle = sight.middle + plane.position({0.0, 0.0}) - plane.position(by);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 1.0f)) {
        const double span = window.high - window.low;
        const double wide = std::max(1e-9, span * std::exp(0.005 * by.x)), level = 0.003 * span * by.y;
        const double centre = 0.5 * (window.low + window.high) + level;
        window = {centre - 0.5 * wide, centre + 0.5 * wide};
    }
    if (io.MouseWheel == 0.0f) return;
    const SliceAxes axes = axes_of(plane.slice);
    if (!io.KeyCtrl) {
        cursor[axes.normal] += static_cast<double>(io.MouseWheel) * spacing;
        return;
    }
    const Vec3 fixed = plane.position(point(io.MousePos) - middle);
    const double before = sight.pixels_per_m;
    sight.pixels_per_m = std::clamp(before * std::pow(1.2, static_cast<double>(io.MouseWheel)), 200.0, 100'000.0);
    for (const int axis : {axes.right, axes.down})
        sight.middle[axis] = fixed[axis] + (sight.middle[axis] - fixed[axis]) * before / sight.pixels_per_m;
}

void draw_slice_cursor(const Painter& paint, Point at, const Box& box, double scale) {
    const double open = 10.0 * scale;
    for (const double side : {-1.0, 1.0}) {
        paint.line({at.x + side * open, at.y}, {side < 0.0 ? box.left : box.right, at.y}, colour(0x5ab0ff, 110));
        paint.line({at.x, at.y + side * open}, {at.x, side < 0.0 ? box.top : box.bottom}, colour(0x5ab0ff, 110));
    }
}

void draw_slice_words(const Painter& paint, Slice slice, const Vec3& cursor, const Box& box, double scale) {
    const double small = 12.0 * scale;
    const int normal = axes_of(slice).normal;
    paint.text({box.left + 6.0, box.top + 4.0}, small, tone::dim,
               fmt::format("{} {} {:.1f} mm", name_of(slice), "xyz"[normal], cursor[normal] * 1e3));
    const auto edges = edges_of(slice);
    const Point m = box.middle();
    paint.text({box.left + 6.0, m.y - 0.5 * small}, small, tone::text, edges[0]);
    paint.text_left_of({box.right - 6.0, m.y - 0.5 * small}, small, tone::text, edges[1]);
    paint.text({m.x, box.top + small + 8.0}, small, tone::text, edges[2]);
    paint.text({m.x, box.bottom - small - 6.0}, small, tone::text, edges[3]);
}

}  // namespace tactus::window
