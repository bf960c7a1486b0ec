// SPDX-License-Identifier: Apache-2.0
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "tools/view/paint/slice_panel.hpp"

#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::view {

SlicePanel::~SlicePanel() {
    if (texture_ != 0) glDeleteTextures(1, &texture_);
}

Point SlicePanel::place_of(const Vec3& position) const { return middle_ + plane_.pixel(position); }

/// Makes the texture again when what it shows has changed.
void SlicePanel::refresh() {
    const volume::Grid& grid = bench_.scan().scan;
    const int normal = axes_of(slice_).normal;
    const long sample = std::lround((bench_.cursor[normal] - grid.origin[normal]) / grid.spacing[normal]);
    const LiveLabelling* const labels = bench_.labels().get();
    std::string wanted = fmt::format("{} {} {} {} {}", sample, bench_.window.low, bench_.window.high,
                                     labels ? labels->number : 0, bench_.shows_certainty);
    const SliceOverlay overlay{&bench_.scan(), labels, bench_.colours(), bench_.shows_certainty};
    for (const auto& c : overlay.colours) wanted += fmt::format(" {:02x}{:02x}{:02x}", c[0], c[1], c[2]);
    if (wanted == shown_) return;
    shown_ = wanted;
    const SlicePicture picture = slice_picture(grid, slice_, bench_.cursor, bench_.window, overlay);
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

void SlicePanel::use_tool(const SlicePlane& plane, Point middle) {
    const Vec3 at = plane.position(point(ImGui::GetIO().MousePos) - middle);
    Painting& painting = bench_.painting();
    if (ImGui::IsItemClicked(ImGuiMouseButton_Left) && !ImGui::GetIO().KeyShift) {
        bench_.move_cursor(at);
        if (bench_.tool == PaintBench::Tool::vessel) bench_.follow_vessel(at);
        else painting.begin(bench_.brush, at, bench_.tool == PaintBench::Tool::erase);
    }
    if (!ImGui::IsItemActive() || !painting.is_open()) {
        if (ImGui::IsItemDeactivated()) painting.end();
        return;
    }
    painting.extend(at);
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) painting.end();
}

void SlicePanel::steer(const SlicePlane& plane, Point middle) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return;
    const Point by = point(io.MouseDelta);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 1.0f) ||
        (io.KeyShift && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0f)))
        sight_.middle = sight_.middle + plane.position({0.0, 0.0}) - plane.position(by);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 1.0f)) {
        const double span = bench_.window.high - bench_.window.low;
        const double wide = std::max(1e-9, span * std::exp(0.005 * by.x)), level = 0.003 * span * by.y;
        const double centre = 0.5 * (bench_.window.low + bench_.window.high) + level;
        bench_.window = {centre - 0.5 * wide, centre + 0.5 * wide};
    }
    if (io.MouseWheel == 0.0f) return;
    if (io.KeyCtrl) {
        const Vec3 fixed = plane.position(point(io.MousePos) - middle);
        const double factor = std::pow(1.2, static_cast<double>(io.MouseWheel));
        const double before = sight_.pixels_per_m;
        sight_.pixels_per_m = std::clamp(before * factor, 200.0, 100'000.0);
        const SliceAxes axes = axes_of(slice_);
        for (const int axis : {axes.right, axes.down})
            sight_.middle[axis] = fixed[axis] + (sight_.middle[axis] - fixed[axis]) * before / sight_.pixels_per_m;
        return;
    }
    const int normal = axes_of(slice_).normal;
    Vec3 to = bench_.cursor;
    to[normal] += static_cast<double>(io.MouseWheel) * bench_.scan().scan.spacing[normal];
    bench_.move_cursor(to);
}

void SlicePanel::draw_marks(const Painter& paint, const SlicePlane& plane, Point middle, const Box& box,
                            double scale) const {
    const auto ring = [&](const Vec3& at, double radius, std::uint32_t ink, float width) {
        const double off = plane.off(at);
        if (off >= radius) return;
        const double across = std::sqrt(radius * radius - off * off) * plane.pixels_per_m;
        paint.list()->AddCircle(vec(middle + plane.pixel(at)), static_cast<float>(across), ink, 0, width);
    };
    const auto colours = bench_.colours();
    const auto ink_of = [&](std::size_t label) {
        return colour(static_cast<std::uint32_t>(colours[label][0]) << 16 |
                      static_cast<std::uint32_t>(colours[label][1]) << 8 | colours[label][2]);
    };
    // Linked cursor, open in the middle.
    const Point c = middle + plane.pixel(bench_.cursor);
    const double open = 10.0 * scale;
    for (const double side : {-1.0, 1.0}) {
        paint.line({c.x + side * open, c.y}, {side < 0.0 ? box.left : box.right, c.y}, colour(0x5ab0ff, 110));
        paint.line({c.x, c.y + side * open}, {c.x, side < 0.0 ? box.top : box.bottom}, colour(0x5ab0ff, 110));
    }
    for (const auto& found : bench_.vessels())
        for (const vessel::Branch& branch : found->track.branches)
            for (const vessel::Node& node : branch.nodes)
                ring(node.position, std::max(node.radius, 0.5e-3), colour(0xff4040, 180), 1.0f);
    const Painting& painting = bench_.painting();
    if (painting.is_open())
        for (const Vec3& p : painting.open_stroke().points)
            ring(p, painting.open_stroke().radius, painting.is_erasing() ? tone::bad : ink_of(painting.active), 2.0f);
    for (const segment::Stroke& stroke : bench_.open_by_hand)
        for (const Vec3& p : stroke.points) ring(p, stroke.radius, tone::text, 2.0f);
    if (ImGui::IsItemHovered() && bench_.tool != PaintBench::Tool::vessel)
        paint.list()->AddCircle(ImGui::GetIO().MousePos, static_cast<float>(bench_.brush * plane.pixels_per_m),
                                bench_.tool == PaintBench::Tool::erase ? tone::bad : ink_of(painting.active), 0, 1.5f);
}

void SlicePanel::draw(const Fonts& fonts) {
    const Point corner = point(ImGui::GetCursorScreenPos()), size = point(ImGui::GetContentRegionAvail());
    if (size.x < 8.0 || size.y < 8.0) return;
    const Box box{corner.x, corner.y, corner.x + size.x, corner.y + size.y};
    const volume::Grid& grid = bench_.scan().scan;
    if (sight_.pixels_per_m <= 0.0) {
        const volume::Grid& bone = bench_.scan().box;
        double widest = 1e-3;
        for (int axis = 0; axis < 3; ++axis)
            widest = std::max(widest, bone.spacing[axis] * bone.size[static_cast<std::size_t>(axis)]);
        sight_.pixels_per_m = 0.92 * std::min(size.x, size.y) / widest;
        sight_.middle = bench_.cursor;
    }
    plane_ = {slice_, sight_.middle, sight_.pixels_per_m};
    plane_.middle[axes_of(slice_).normal] = bench_.cursor[axes_of(slice_).normal];
    middle_ = box.middle();
    ImGui::InvisibleButton(
        "slice", vec(size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    mark_spot(std::string(name_of(slice_)));
    use_tool(plane_, middle_);
    steer(plane_, middle_);
    refresh();
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    paint.list()->PushClipRect(vec({box.left, box.top}), vec({box.right, box.bottom}), true);
    paint.box(box, colour(0x000000));
    const auto corners = corners_of(grid, plane_);
    paint.list()->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)),
                           vec(middle_ + corners[0]), vec(middle_ + corners[1]));
    draw_marks(paint, plane_, middle_, box, fonts.scale);
    const double small = 12.0 * fonts.scale;
    const int normal = axes_of(slice_).normal;
    paint.text({box.left + 6.0, box.top + 4.0}, small, tone::dim,
               fmt::format("{} {} {:.1f} mm", name_of(slice_), "xyz"[normal], bench_.cursor[normal] * 1e3));
    if (bench_.labels() && bench_.labels()->is_preview)
        paint.text_left_of({box.right - 6.0, box.top + 4.0}, small, tone::warm, "preview");
    const auto edges = edges_of(slice_);
    const Point m = box.middle();
    paint.text({box.left + 6.0, m.y - 0.5 * small}, small, tone::text, edges[0]);
    paint.text_left_of({box.right - 6.0, m.y - 0.5 * small}, small, tone::text, edges[1]);
    paint.text({m.x, box.top + 4.0}, small, tone::text, edges[2]);
    paint.text({m.x, box.bottom - small - 6.0}, small, tone::text, edges[3]);
    paint.list()->PopClipRect();
}

}  // namespace tactus::view
