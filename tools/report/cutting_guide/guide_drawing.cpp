// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cutting_guide/guide_drawing.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/section.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tactus::report {

namespace {

using display::Colour;
using display::Figure;
using display::FigurePoint;
using display::TextAnchor;

constexpr Colour ink{34, 38, 46}, soft{130, 138, 150}, solid{52, 104, 124}, bone{170, 140, 80}, plan{190, 50, 45};
constexpr double width = 900.0, margin = 40.0, hatch = 6.0;  // units of the figure

geometry::TriangleSurface in_frame(geometry::TriangleSurface surface, const Pose& frame) {
    const Pose to_frame = frame.inverse();
    for (Vec3& v : surface.vertices) v = to_frame.apply(v);
    return surface;
}

/// A view along one axis of the guide's frame: `right` and `up` are axes of it.
struct SectionView {
    int right = 0, up = 1;
    double from = 0.0, low = 0.0, pixels = 1.0, bottom = 0.0;

    FigurePoint point(double x, double y) const { return {margin + (x - from) * pixels, bottom - (y - low) * pixels}; }
    FigurePoint point(const Vec3& p) const { return point(p[right], p[up]); }
};

using Pieces = std::vector<std::pair<FigurePoint, FigurePoint>>;

Pieces section(const geometry::TriangleSurface& surface, const SectionView& view, int axis, double at) {
    Vec3 origin(0.0), normal(0.0);
    origin[axis] = at, normal[axis] = 1.0;
    const reconstruction::Section cut = reconstruction::section_of(surface, {origin, normal});
    Pieces pieces;
    for (const auto& [a, b] : cut.pieces) pieces.emplace_back(view.point(cut.points[a]), view.point(cut.points[b]));
    return pieces;
}

/// Outlines, and lines at 45° where an odd number of them has been crossed.
void draw_section(Figure& figure, const Pieces& pieces, Colour colour, bool is_hatched) {
    for (const auto& [a, b] : pieces) figure.line({a, b}, colour, 1.2);
    if (!is_hatched) return;
    // Along a hatch line x + y is constant, and x − y grows.
    double low = infinity, high = -infinity;
    for (const auto& [a, b] : pieces)
        low = std::min({low, a.x + a.y, b.x + b.y}), high = std::max({high, a.x + a.y, b.x + b.y});
    Colour pale = colour;
    pale.opacity = 0.5;
    for (double line = low + 0.5 * hatch; line < high; line += hatch) {
        std::vector<double> crossings;
        for (const auto& [a, b] : pieces) {
            const double s = a.x + a.y - line, t = b.x + b.y - line;
            if ((s < 0.0) == (t < 0.0)) continue;
            const double share = s / (s - t);
            crossings.push_back((a.x - a.y) + share * ((b.x - b.y) - (a.x - a.y)));
        }
        std::ranges::sort(crossings);
        for (std::size_t n = 0; n + 1 < crossings.size(); n += 2) {
            const auto point = [&](double d) { return FigurePoint{0.5 * (line + d), 0.5 * (line - d)}; };
            figure.line({point(crossings[n]), point(crossings[n + 1])}, pale, 0.6);
        }
    }
}

void dimension(Figure& figure, FigurePoint a, FigurePoint b, const std::string& text) {
    figure.line({a, b}, soft, 0.8);
    const double along = std::hypot(b.x - a.x, b.y - a.y);
    if (!(along > 0.0)) return;
    const FigurePoint across{-(b.y - a.y) / along * 4.0, (b.x - a.x) / along * 4.0};
    for (const FigurePoint& p : {a, b})
        figure.line({{p.x - across.x, p.y - across.y}, {p.x + across.x, p.y + across.y}}, soft, 0.8);
    const FigurePoint middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
    figure.text({middle.x, middle.y - 4.0}, text, 10.0, ink, TextAnchor::middle, false, false, true);
}

/// The plane of a slot in the frame of the guide.
struct DrawnSlot {
    const cutting_guide::MadeSlot* made;
    double measured;  ///< m, width
    Vec3 origin, normal, middle;

    double x_at(double y, double z) const {
        return origin.x - (normal.y * (y - origin.y) + normal.z * (z - origin.z)) / normal.x;
    }
};

std::vector<DrawnSlot> drawn_slots(const analysis::PlannedGuide& guide) {
    const Pose to_frame = guide.made.frame.inverse();
    std::vector<DrawnSlot> slots;
    for (std::size_t n = 0; n < guide.made.slots.size(); ++n) {
        const cutting_guide::MadeSlot& s = guide.made.slots[n];
        slots.push_back({&s, guide.refits[n].width, to_frame.apply(s.cut.plane.origin),
                         to_frame.rotate(s.cut.plane.normal), to_frame.apply(s.middle)});
    }
    return slots;
}

void draw_slots_from_above(Figure& figure, const SectionView& view, std::vector<DrawnSlot> slots, double y, double z,
                           double high) {
    // Planes of neighbours may have crossed at this height.
    std::ranges::sort(slots, {}, [&](const DrawnSlot& s) { return s.x_at(y, z); });
    double before = 0.0;
    for (std::size_t n = 0; n < slots.size(); ++n) {
        const DrawnSlot& s = slots[n];
        const double x = s.x_at(y, z), end = s.x_at(high, z);
        figure.line({view.point(s.x_at(view.low, z), view.low), view.point(end, high)}, plan, 1.0, 5.0);
        // Neighbours that stand close take rows of their own.
        const double row = n % 2 == 0 ? 18.0 : 44.0;
        const FigurePoint top = view.point(end, high);
        figure.text({top.x, top.y - row - 12.0}, std::string(1, s.made->cut.letter), 15.0, ink, TextAnchor::middle,
                    true);
        figure.text({top.x, top.y - row}, s.measured > 0.0 ? fmt::format("{:.2f} wide", s.measured / mm) : "ledge", 9.5,
                    ink, TextAnchor::middle);
        if (n > 0) {
            const double lowest = view.bottom + (n % 2 == 0 ? 34.0 : 18.0);
            dimension(figure, {view.point(before, y).x, lowest}, {view.point(x, y).x, lowest},
                      fmt::format("{:.2f}", (x - before) / mm));
        }
        before = x;
    }
}

void draw_holes(Figure& figure, const SectionView& view, const analysis::PlannedGuide& guide) {
    const Pose to_frame = guide.made.frame.inverse();
    for (const cutting_guide::GuideHole& hole : guide.made.holes) {
        const Vec3 at = to_frame.apply(hole.at), u = to_frame.rotate(hole.axis);
        std::vector<FigurePoint> ring;
        const Vec3 a = glm::normalize(glm::cross(u, std::abs(u.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0))),
                   b = glm::cross(u, a);
        for (int k = 0; k <= 24; ++k)
            ring.push_back(view.point(at + hole.radius * (std::cos(k * pi / 12.0) * a + std::sin(k * pi / 12.0) * b)));
        figure.line(std::move(ring), ink, 1.2);
        const FigurePoint middle = view.point(at);
        figure.text({middle.x, middle.y - hole.radius * view.pixels - 4.0},
                    fmt::format("Ø {:.1f}{}", 2.0 * hole.radius / mm, hole.is_predictive ? " predictive" : ""), 9.5,
                    ink, TextAnchor::middle, false, false, true);
    }
}

void draw_slots_along(Figure& figure, const SectionView& view, const std::vector<DrawnSlot>& slots, double y) {
    for (const DrawnSlot& s : slots) {
        const double top = s.middle.z + 0.5 * s.made->depth, foot = top - s.made->depth;
        const FigurePoint a = view.point(s.x_at(y, foot), foot), b = view.point(s.x_at(y, top), top);
        figure.line({view.point(s.x_at(y, view.low), view.low), b}, plan, 1.0, 5.0);
        figure.text({b.x, b.y - 20.0}, std::string(1, s.made->cut.letter), 15.0, ink, TextAnchor::middle, true);
        const double lean = std::atan2(s.normal.z, std::abs(s.normal.x)) / degree;
        figure.text({b.x, b.y - 7.0}, fmt::format("{:.1f}°", std::abs(lean)), 9.5, ink, TextAnchor::middle);
        const double aside = s.normal.x > 0.0 ? -26.0 : 26.0;
        figure.line({{a.x + aside, a.y}, {a.x + aside, b.y}}, soft, 0.8);
        for (const double end : {a.y, b.y})
            figure.line({{a.x + aside - 4.0, end}, {a.x + aside + 4.0, end}}, soft, 0.8);
        figure.text({a.x + aside + (aside > 0.0 ? 4.0 : -4.0), 0.5 * (a.y + b.y)},
                    fmt::format("{:.1f}", s.made->depth / mm), 10.0, ink,
                    aside > 0.0 ? TextAnchor::start : TextAnchor::end, false, false, true);
    }
}

}  // namespace

Figure guide_drawing(const analysis::PlannedGuide& guide) {
    const geometry::TriangleSurface surface = in_frame(guide.made.surface, guide.made.frame);
    const std::vector<DrawnSlot> slots = drawn_slots(guide);
    Vec3 low(infinity), high(-infinity);
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    double y = 0.0, z = 0.0;
    // Without slots, at the height of the base in the middle of the bone.
    if (slots.empty()) z = guide.made.frame.inverse().apply(guide.design.base.front().on->at).z;
    for (const DrawnSlot& s : slots)
        y += s.middle.y / static_cast<double>(slots.size()), z += s.middle.z / static_cast<double>(slots.size());
    geometry::TriangleSurface bone_surface = in_frame(guide.design.bone, guide.made.frame);
    // Of the bone what lies around the guide.
    constexpr double around = 10.0 * mm;
    std::erase_if(bone_surface.triangles, [&](const auto& t) {
        const Vec3 v = bone_surface.vertices[static_cast<std::size_t>(t[0])];
        return v.x < low.x - around || v.x > high.x + around || v.z < low.z - around;
    });
    const double pixels = std::min((width - 2.0 * margin) / (high.x - low.x), 9.0 / mm);
    SectionView above{0, 1, low.x, low.y, pixels, 0.0}, along{0, 2, low.x, low.z - around, pixels, 0.0};
    above.bottom = 110.0 + (high.y - low.y) * pixels;
    along.bottom = above.bottom + 125.0 + (high.z - along.low) * pixels;
    Figure figure(width, along.bottom + 40.0);
    figure.text({margin, 20.0},
                slots.empty() ? "section through the base, seen from where the guide is put on"
                              : "section at half the depth of the slots, seen from where the guide is put on",
                12.0, ink, TextAnchor::start, true);
    draw_section(figure, section(surface, above, 2, z), solid, true);
    draw_slots_from_above(figure, above, slots, y, z, high.y);
    draw_holes(figure, above, guide);
    figure.text({margin, above.bottom + 60.0},
                slots.empty() ? "section along the bone, through the bridge"
                              : "section along the bone; angles against the approach",
                12.0, ink, TextAnchor::start, true);
    draw_section(figure, section(bone_surface, along, 1, y), bone, false);
    draw_section(figure, section(surface, along, 1, y), solid, true);
    draw_slots_along(figure, along, slots, y);
    dimension(figure, {margin, along.bottom + 22.0}, {margin + 10.0 * mm * pixels, along.bottom + 22.0}, "10 mm");
    figure.text({margin + 10.0 * mm * pixels + 16.0, along.bottom + 26.0},
                slots.empty() ? "mm" : "mm; dashed: planes of the plan, which are the walls on the kept side", 10.0,
                ink);
    return figure;
}

}  // namespace tactus::report
