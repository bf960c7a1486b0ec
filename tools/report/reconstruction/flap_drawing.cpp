// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/flap_drawing.hpp"

#include "dsp/core/constants.hpp"
#include "tools/render/flap_scene.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::report {

namespace {

using display::Colour;
using display::Figure;
using display::FigurePoint;

constexpr Colour ink{34, 38, 46}, soft{130, 138, 150}, bone{236, 228, 208}, kept{250, 206, 140};
constexpr double to_mm = 1e3;

Colour of(const Vec3& c) {
    return {static_cast<std::uint8_t>(255 * c.x), static_cast<std::uint8_t>(255 * c.y),
            static_cast<std::uint8_t>(255 * c.z)};
}

/// One of two views along the line: `across` is up in it.
struct BoneView {
    Vec3 origin, along, across;
    double low = 0.0;                              // m along, of the end at the ankle
    std::vector<double> station, least, greatest;  // the silhouette, per station

    double at(const Vec3& p) const { return glm::dot(p - origin, along) - low; }
    double aside(const Vec3& p) const { return glm::dot(p - origin, across); }
};

std::array<Vec3, 2> medial_and_anterior(const reconstruction::FibulaInputs& inputs, const Vec3& along) {
    // As plan_fibula has them: LPS, the left leg's medial side is the patient's right.
    const Vec3 anterior(0.0, -1.0, 0.0);
    const Vec3 front = glm::normalize(anterior - glm::dot(anterior, along) * along);
    Vec3 medial = glm::cross(front, along);
    if (medial.x * (inputs.leg == reconstruction::Leg::left ? -1.0 : 1.0) < 0.0) medial = -medial;
    return {medial, front};
}

BoneView view_of(const reconstruction::FibulaInputs& inputs, const geometry::TriangleSurface& donor,
                 const Vec3& across) {
    constexpr double step = 2e-3;
    BoneView view{inputs.line_point, glm::normalize(inputs.line_direction), across, 0.0, {}, {}, {}};
    double low = infinity, high = -infinity;
    for (const Vec3& v : donor.vertices) low = std::min(low, view.at(v)), high = std::max(high, view.at(v));
    view.low = low;
    const auto count = static_cast<std::size_t>(std::ceil((high - low) / step)) + 1;
    view.least.assign(count, infinity);
    view.greatest.assign(count, -infinity);
    for (const auto& t : donor.triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3 a = donor.vertices[static_cast<std::size_t>(t[c])],
                       b = donor.vertices[static_cast<std::size_t>(t[(c + 1) % 3])];
            const double from = std::min(view.at(a), view.at(b)), to = std::max(view.at(a), view.at(b));
            for (auto n = static_cast<std::size_t>(std::max(0.0, std::ceil(from / step)));
                 n < count && static_cast<double>(n) * step <= to; ++n) {
                const double share =
                    to > from ? (static_cast<double>(n) * step - view.at(a)) / (view.at(b) - view.at(a)) : 0.0;
                const double w = view.aside(a) + share * (view.aside(b) - view.aside(a));
                view.least[n] = std::min(view.least[n], w);
                view.greatest[n] = std::max(view.greatest[n], w);
            }
        }
    for (std::size_t n = 0; n < count; ++n) view.station.push_back(static_cast<double>(n) * step);
    return view;
}

/// Where a view lies in a figure.
struct Place {
    double left, middle, pixels, from;  // from: m along, at the left edge

    FigurePoint point(double along, double aside) const {
        return {left + (along - from) * pixels, middle - aside * pixels};
    }
};

void draw_bone(Figure& figure, const BoneView& view, const Place& place, double from, double to, Colour colour) {
    std::vector<FigurePoint> outline;
    for (std::size_t n = 0; n < view.station.size(); ++n)
        if (view.station[n] >= from && view.station[n] <= to && view.least[n] < infinity)
            outline.push_back(place.point(view.station[n], view.greatest[n]));
    for (std::size_t n = view.station.size(); n-- > 0;)
        if (view.station[n] >= from && view.station[n] <= to && view.least[n] < infinity)
            outline.push_back(place.point(view.station[n], view.least[n]));
    if (outline.size() < 3) return;
    figure.fill(outline, colour);
    outline.push_back(outline.front());
    figure.line(outline, soft, 1.0);
}

/// A cut seen edge-on in a view: along as a function of aside.
double along_of(const BoneView& view, const reconstruction::Plane& plane, double aside) {
    const double slope = glm::dot(plane.normal, view.across) / glm::dot(plane.normal, view.along);
    return view.at(plane.origin) - slope * (aside - view.aside(plane.origin));
}

void draw_cut(Figure& figure, const BoneView& view, const Place& place, const reconstruction::Plane& plane, double half,
              Colour colour) {
    const double centre = view.aside(plane.origin);
    std::vector<FigurePoint> line;
    for (const double side : {-half, half})
        line.push_back(place.point(along_of(view, plane, centre + side), centre + side));
    figure.line(line, colour, 1.6);
}

double lean(const BoneView& view, const reconstruction::Plane& plane) {
    return std::atan2(glm::dot(plane.normal, view.across), glm::dot(plane.normal, view.along)) * 180.0 /
           std::numbers::pi;
}

geometry::TriangleSurface donor_of(const reconstruction::FibulaInputs& inputs) {
    return reconstruction::parts_near_line(*inputs.donor, inputs.line_point, glm::normalize(inputs.line_direction),
                                           inputs.farthest_from_line);
}

std::array<BoneView, 2> views_of(const reconstruction::FibulaInputs& inputs) {
    const geometry::TriangleSurface donor = donor_of(inputs);
    const auto [medial, anterior] = medial_and_anterior(inputs, glm::normalize(inputs.line_direction));
    return {view_of(inputs, donor, medial), view_of(inputs, donor, anterior)};
}

constexpr const char* view_names[] = {"seen from the front; up: medial", "seen from the medial side; up: anterior"};

}  // namespace

double ankle_end(const reconstruction::FibulaInputs& inputs) {
    const Vec3 along = glm::normalize(inputs.line_direction);
    double low = infinity;
    for (const Vec3& v : donor_of(inputs).vertices) low = std::min(low, glm::dot(v - inputs.line_point, along));
    return low;
}

Figure donor_drawing(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                     const reconstruction::Flap& flap) {
    constexpr double width = 900.0, left = 20.0, high = 230.0;
    Figure figure(width, 2.0 * high + 20.0);
    const std::array<BoneView, 2> views = views_of(inputs);
    const double length = views[0].station.back(), pixels = (width - 2.0 * left) / length;
    for (std::size_t v = 0; v < 2; ++v) {
        const BoneView& view = views[v];
        const Place place{left, high * static_cast<double>(v) + 95.0, pixels, 0.0};
        figure.text({left, place.middle - 78.0}, view_names[v], 12.0, ink, display::TextAnchor::start, true);
        draw_bone(figure, view, place, 0.0, length, bone);
        for (const reconstruction::FlapVessel& vessel : flap.vessels) {
            std::vector<FigurePoint> line;
            for (const Vec3& p : vessel.points) line.push_back(place.point(view.at(p), view.aside(p)));
            figure.line(line,
                        of(vessel.kind == reconstruction::VesselKind::artery ? render::flap_artery_colour
                                                                             : render::flap_vein_colour),
                        1.4);
        }
        std::vector<std::pair<double, std::string>> dimensions;
        for (std::size_t n = 0; n < plan.segments.size(); ++n) {
            const reconstruction::FibulaSegment& s = plan.segments[n];
            // What is kept, between its two cuts.
            const bool is_reversed = s.along_line[0] > s.along_line[1];
            std::vector<FigurePoint> area;
            for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
                const double centre = view.aside(s.donor_plane[end].origin);
                for (const double side : {end == 0 ? -9e-3 : 9e-3, end == 0 ? 9e-3 : -9e-3})
                    area.push_back(place.point(along_of(view, s.donor_plane[end], centre + side), centre + side));
            }
            Colour shade = kept;
            shade.opacity = 0.55;
            figure.fill(area, shade);
            figure.text(
                place.point(0.5 * (view.at(s.donor_plane[0].origin) + view.at(s.donor_plane[1].origin)), -1.5e-3),
                fmt::format("{}", n + 1), 14.0, ink, display::TextAnchor::middle, true);
            for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
                draw_cut(figure, view, place, s.donor_plane[end], 11e-3, ink);
                dimensions.emplace_back(view.at(s.donor_plane[end].origin),
                                        fmt::format("{}{}", n + 1, (end == 0) != is_reversed ? "a" : "b"));
            }
        }
        std::ranges::sort(dimensions);
        for (std::size_t n = 0; n < dimensions.size(); ++n) {
            const auto& [at, name] = dimensions[n];
            const FigurePoint foot = place.point(at, 0.0);
            const double low = place.middle + 84.0 + 15.0 * static_cast<double>(n % 3);
            figure.line({{foot.x, place.middle + 30.0}, {foot.x, low - 10.0}}, soft, 0.7);
            figure.text({foot.x, low}, fmt::format("{}: {:.1f} mm", name, at * to_mm), 10.0, ink,
                        display::TextAnchor::middle);
        }
        for (const reconstruction::Perforator& p : flap.perforators) {
            const FigurePoint at = place.point(view.at(p.at), view.aside(p.at));
            figure.line({{at.x - 4.0, at.y - 4.0}, {at.x + 4.0, at.y + 4.0}}, of(render::site_colour), 1.6);
            figure.line({{at.x - 4.0, at.y + 4.0}, {at.x + 4.0, at.y - 4.0}}, of(render::site_colour), 1.6);
        }
        figure.text({left, place.middle + 28.0}, "ankle", 10.0, soft);
        figure.text({width - left, place.middle + 28.0}, "knee", 10.0, soft, display::TextAnchor::end);
    }
    return figure;
}

Figure osteotomy_drawing(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                         std::size_t segment, std::size_t end) {
    constexpr double width = 640.0, height = 200.0, reach = 24e-3;
    Figure figure(width, height);
    const std::array<BoneView, 2> views = views_of(inputs);
    const reconstruction::FibulaSegment& s = plan.segments[segment];
    const reconstruction::Plane& plane = s.donor_plane[end];
    const bool keeps_knee_side = (s.along_line[0] < s.along_line[1]) == (end == 0);
    for (std::size_t v = 0; v < 2; ++v) {
        const BoneView& view = views[v];
        const double at = view.at(plane.origin), centre = view.aside(plane.origin);
        const double pixels = 280.0 / (2.0 * reach);
        const Place place{20.0 + 315.0 * static_cast<double>(v), 105.0 + centre * pixels, pixels, at - reach};
        figure.text({place.left, 16.0}, view_names[v], 11.0, ink, display::TextAnchor::start, true);
        draw_bone(figure, view, place, std::max(0.0, at - reach), at + reach, bone);
        figure.line({place.point(at - reach, centre), place.point(at + reach, centre)}, soft, 0.7, 4.0);
        figure.line({place.point(at, centre - 12e-3), place.point(at, centre + 12e-3)}, soft, 0.7, 4.0);
        draw_cut(figure, view, place, plane, 13e-3, of(render::resected_colour));
        // Where the cut meets the two sides of the bone.
        for (const bool upper : {false, true}) {
            const auto n =
                static_cast<std::size_t>(std::clamp(at / 2e-3, 0.0, static_cast<double>(view.station.size() - 1)));
            const double side = upper ? view.greatest[n] : view.least[n];
            if (!std::isfinite(side)) continue;
            const double meets = along_of(view, plane, side);
            const FigurePoint p = place.point(meets, side);
            figure.line({{p.x, p.y - 3.0}, {p.x, p.y + 3.0}}, ink, 2.0);
            // Beside the cut, on the side that it leaves free.
            const double tilt = std::min(std::abs(lean(view, plane)), 60.0) * std::numbers::pi / 180.0;
            const double away = 16.0 * std::tan(tilt) + 6.0;
            figure.text({p.x + away, upper ? p.y - 10.0 : p.y + 18.0}, fmt::format("{:.1f} mm", meets * to_mm), 10.5,
                        ink);
        }
        const FigurePoint name = place.point(at + (keeps_knee_side ? 0.5 : -0.5) * reach, centre - 1e-3);
        figure.text(name, fmt::format("segment {}", segment + 1), 11.0, ink, display::TextAnchor::middle);
        figure.text({place.left, height - 10.0}, fmt::format("{:+.1f}°", lean(view, plane)), 14.0,
                    of(render::resected_colour), display::TextAnchor::start, true);
        figure.text({place.left + 70.0, height - 10.0},
                    fmt::format("on the line {:.1f} mm from the ankle's end", at * to_mm), 10.5, ink);
    }
    return figure;
}

}  // namespace tactus::report
