// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/slice_panel.hpp"

#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::window {

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
    texture_.show(wanted, [&] { return slice_picture(grid, slice_, bench_.cursor, bench_.window, overlay); });
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
    draw_slice_cursor(paint, middle + plane.pixel(bench_.cursor), box, scale);
    for (const auto& found : bench_.vessels())
        for (const vessel::Branch& branch : found->track.branches)
            for (const vessel::Node& node : branch.nodes)
                ring(node.position, std::max(node.radius, 0.5e-3), colour(0xff4040, 180), 1.0f);
    const Painting& painting = bench_.painting();
    if (painting.is_open())
        for (const Vec3& p : painting.open_stroke().points)
            ring(p, painting.open_stroke().radius, painting.is_erasing() ? tone::bad : ink_of(painting.active), 2.0f);
    for (const segmentation::Stroke& stroke : bench_.open_by_hand)
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
        sight_.fit(size, widest, bench_.cursor);
    }
    plane_ = sight_.plane(slice_, bench_.cursor);
    middle_ = box.middle();
    ImGui::InvisibleButton(
        "slice", vec(size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    mark_spot(std::string(name_of(slice_)));
    use_tool(plane_, middle_);
    Vec3 cursor = bench_.cursor;
    steer_slice(plane_, middle_, grid.spacing[axes_of(slice_).normal], sight_, bench_.window, cursor);
    if (cursor != bench_.cursor) bench_.move_cursor(cursor);
    refresh();
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    paint.list()->PushClipRect(vec({box.left, box.top}), vec({box.right, box.bottom}), true);
    paint.box(box, colour(0x000000));
    const auto corners = corners_of(grid, plane_);
    texture_.draw(paint, middle_ + corners[0], middle_ + corners[1]);
    draw_marks(paint, plane_, middle_, box, fonts.scale);
    draw_slice_words(paint, slice_, bench_.cursor, box, fonts.scale);
    if (bench_.labels() && bench_.labels()->is_preview)
        paint.text_left_of({box.right - 6.0, box.top + 4.0}, 12.0 * fonts.scale, tone::warm, "preview");
    paint.list()->PopClipRect();
}

}  // namespace tactus::window
