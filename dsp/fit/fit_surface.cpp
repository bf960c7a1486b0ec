// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit_surface.hpp"

#include "dsp/contact/neighbours.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/main_axes.hpp"
#include "dsp/geometry/nearest_points.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::fit {

namespace {

constexpr std::size_t min_points = 30;
constexpr double edge = 1.5e-3;  // m: points nearer to the paint are not part of the outline
constexpr double across = 0.6;   // of an outline's normal along that of the paint, at most
constexpr std::uint8_t own_label = 200;  // marks the one face of several that is being made
constexpr double infinite = std::numeric_limits<double>::infinity();

struct Box {
    Vec3 low{infinite}, high{-infinite};
};

/// Farthest-point sampling: at most `most` of the candidates, each as far as possible from those before it.
std::vector<std::size_t> spread_evenly(const std::vector<Vec3>& candidates, std::size_t most) {
    std::vector<std::size_t> picks;
    std::vector<double> nearest(candidates.size(), infinite);
    std::size_t pick = 0;
    while (picks.size() < std::min(most, candidates.size())) {
        picks.push_back(pick);
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const Vec3 difference = candidates[i] - candidates[pick];
            nearest[i] = std::min(nearest[i], glm::dot(difference, difference));
        }
        pick = static_cast<std::size_t>(std::ranges::max_element(nearest) - nearest.begin());
    }
    return picks;
}

/// `position` is relative to the centre.
Vec3 plane_through(const FitSurface& made) {
    constexpr double flat = 0.5;  // of its thickness and its width
    const double length = glm::length(made.mean_normal);
    const Vec3 mean = length > 0.0 ? made.mean_normal / length : Vec3(0.0);
    Mat3 spread(0.0);
    for (std::size_t i = 0; i < made.position.size(); ++i)
        spread += made.share[i] * glm::outerProduct(made.position[i], made.position[i]);
    const Mat3 axes = geometry::main_axes(spread);
    const double thick = glm::dot(axes[2], spread * axes[2]), wide = glm::dot(axes[1], spread * axes[1]);
    const double along = glm::dot(axes[2], mean);
    if (!(thick < flat * flat * wide) || !(std::abs(along) > flat)) return mean;
    return along < 0.0 ? -axes[2] : axes[2];
}

void take_paint(FitSurface& made, std::span<const contact::SurfacePoint> points, const FitSurfaceOptions& options) {
    for (const contact::SurfacePoint& p : points) {
        if (p.label != options.paint || !(glm::length(p.normal) > 0.5)) continue;
        made.position.push_back(p.position);
        made.normal.push_back(glm::normalize(p.normal));
        made.share.push_back(p.area);
        made.area += p.area;
    }
    if (made.position.size() < min_points)
        throw Error(fmt::format("{} of {} surface points are painted; a fit needs at least {}: paint the fracture",
                                made.position.size(), points.size(), min_points));
    if (!(made.area > 0.0)) throw Error("the painted points stand for no area");
    for (std::size_t i = 0; i < made.position.size(); ++i) {
        made.share[i] /= made.area;
        made.centre += made.share[i] * made.position[i];
        made.mean_normal += made.share[i] * made.normal[i];
    }
    for (Vec3& p : made.position) p -= made.centre;
    for (const contact::SurfacePoint& p : points)
        if (const Vec3 arm = p.position - made.centre; glm::dot(arm, arm) > glm::dot(made.far, made.far))
            made.far = arm;
    made.plane_normal = plane_through(made);
    for (std::size_t i = 0; i < made.position.size(); ++i)
        made.gyration += made.share[i] * glm::dot(made.position[i], made.position[i]);
    made.gyration = std::sqrt(made.gyration);
}

/// The grid of the field around the paint: that of `distance`, or coarser.
volume::Grid layout_around(const FitSurface& made, const volume::Grid& distance, const FitSurfaceOptions& options) {
    Box box;
    for (const Vec3& p : made.position) {
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
    }
    const Vec3 low = box.low - Vec3(options.reach), extent = box.high + Vec3(options.reach) - low;
    volume::Grid layout;
    layout.spacing = distance.spacing;
    const auto samples = [&] {
        return std::ceil(extent.x / layout.spacing.x + 2.0) * std::ceil(extent.y / layout.spacing.y + 2.0) *
               std::ceil(extent.z / layout.spacing.z + 2.0);
    };
    while (samples() > static_cast<double>(options.max_samples)) layout.spacing *= 1.25;
    const Vec3 from = distance.origin - made.centre;
    layout.origin = from + glm::floor((low - from) / layout.spacing) * layout.spacing;
    for (int axis = 0; axis < 3; ++axis)
        layout.size[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::ceil((low[axis] + extent[axis] - layout.origin[axis]) / layout.spacing[axis])) + 1;
    return layout;
}

/// Distances and paint at the samples of `field`. Returns the number of samples taken from the grid.
std::size_t fill(volume::Grid& field, std::vector<std::uint8_t>& painted, const Vec3& centre,
                 const contact::Voxmap& source, std::span<const contact::SurfacePoint> points, std::uint8_t paint) {
    std::vector<glm::vec3> places;
    places.reserve(points.size());
    for (const contact::SurfacePoint& p : points)
        places.emplace_back((p.position - centre - field.origin) / field.spacing);
    const std::vector<std::int32_t> nearest = geometry::nearest_points(field, places, run_in_turn);
    field.values.resize(field.count());
    painted.resize(field.count());
    std::size_t from_grid = 0, n = 0;
    for (int k = 0; k < field.size[2]; ++k)
        for (int j = 0; j < field.size[1]; ++j)
            for (int i = 0; i < field.size[0]; ++i, ++n) {
                const Vec3 at = field.position(i, j, k) + centre;
                const contact::SurfacePoint& point = points[static_cast<std::size_t>(nearest[n])];
                const volume::Sample here = source.sample(at);
                const double value = here.inside ? here.value : glm::length(at - point.position);
                from_grid += here.inside;
                field.values[n] = static_cast<float>(value);
                painted[n] = point.label == paint;
            }
    return from_grid;
}

void take_outline(FitSurface& made, std::span<const contact::SurfacePoint> points, const FitSurfaceOptions& options) {
    // Distances to all painted points would take long; a thinned paint is accurate to half a millimetre,
    // which suffices.
    std::vector<Vec3> paint;
    for (const std::size_t i : spread_evenly(made.position, 400)) paint.push_back(made.position[i]);
    const double steep = glm::length(made.mean_normal);
    const Vec3 axis = steep > 0.0 ? made.mean_normal / steep : Vec3(0.0);
    Box box;
    for (const Vec3& p : paint) {
        box.low = glm::min(box.low, p - Vec3(options.outline));
        box.high = glm::max(box.high, p + Vec3(options.outline));
    }
    std::vector<Vec3> positions, normals;
    for (const contact::SurfacePoint& point : points) {
        const Vec3 p = point.position - made.centre;
        if (point.label == options.paint || point.label == options.other_paint ||
            point.label == contact::surface_label::as_scanned)
            continue;
        if (!(glm::length(point.normal) > 0.5)) continue;
        if (glm::any(glm::lessThan(p, box.low)) || glm::any(glm::greaterThan(p, box.high))) continue;
        // The edge itself is rounded, and some unpainted points may be fracture too.
        if (std::abs(glm::dot(glm::normalize(point.normal), axis)) > across) continue;
        double least = infinite;
        for (const Vec3& q : paint) least = std::min(least, glm::dot(p - q, p - q));
        if (least < edge * edge || least > options.outline * options.outline) continue;
        positions.push_back(p);
        normals.push_back(glm::normalize(point.normal));
    }
    for (const std::size_t i : spread_evenly(positions, options.max_outline)) {
        made.outline.push_back(positions[i]);
        made.outline_normal.push_back(normals[i]);
    }
}

}  // namespace

bool FitSurface::is_painted_near(const Vec3& place) const noexcept {
    const Vec3 at = (place - field.grid.origin) / field.grid.spacing + Vec3(0.5);
    const auto& size = field.grid.size;
    // The comparison treats NaN as outside.
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.z >= 0.0 && at.x < size[0] && at.y < size[1] && at.z < size[2]))
        return false;
    return painted[field.grid.index(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z))] != 0;
}

FitSurface make_fit_surface(std::span<const contact::SurfacePoint> points, const volume::Grid& distance,
                            const FitSurfaceOptions& options) {
    FitSurface made;
    take_paint(made, points, options);
    take_outline(made, points, options);
    volume::Grid field = layout_around(made, distance, options);
    if (fill(field, made.painted, made.centre, contact::make_voxmap(distance), points, options.paint) == 0)
        throw Error("the painted points lie outside of the distance field of their bone");
    made.field = contact::make_voxmap(std::move(field));
    return made;
}

FitSurface make_live_fit_surface(std::span<const contact::SurfacePoint> points, const volume::Grid& distance) {
    FitSurfaceOptions options;
    options.max_outline /= 2;
    return make_fit_surface(points, distance, options);
}

std::vector<FitSurface> make_fit_faces(std::span<const contact::SurfacePoint> points, const volume::Grid& distance,
                                       const FitSurfaceOptions& options) {
    auto patches =
        contact::patches_of(points, options.max_gap, [&](std::size_t i) { return points[i].label == options.paint; });
    std::erase_if(patches, [](const auto& patch) { return patch.size() < min_points; });
    std::ranges::stable_sort(patches, std::ranges::greater{}, [](const auto& patch) { return patch.size(); });
    std::vector<FitSurface> faces;
    if (patches.size() < 2) {
        faces.push_back(make_fit_surface(points, distance, options));
        return faces;
    }
    for (const auto& patch : patches) faces.push_back(make_fit_face(points, patch, distance, options));
    return faces;
}

FitSurface make_fit_face(std::span<const contact::SurfacePoint> points, std::span<const std::size_t> face,
                         const volume::Grid& distance, const FitSurfaceOptions& options) {
    std::vector<contact::SurfacePoint> one(points.begin(), points.end());
    for (const std::size_t i : face) one[i].label = own_label;
    FitSurfaceOptions own = options;
    own.paint = own_label;
    own.other_paint = options.paint;
    return make_fit_surface(one, distance, own);
}

}  // namespace tactus::fit
