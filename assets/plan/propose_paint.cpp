// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/propose_paint.hpp"

#include "dsp/contact/neighbours.hpp"
#include "dsp/contact/scanned_border.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/faces.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::plan {

namespace {

/// Roughness: mean of 1 − cos of the angle between a point's normal and the normals nearby.
std::vector<double> roughness_of(std::span<const contact::SurfacePoint> points, double near) {
    const contact::Neighbours neighbours(points, near);
    std::vector<double> rough(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        double sum = 0.0, count = 0.0;
        neighbours.around(i, [&](std::size_t j) {
            sum += 1.0 - glm::dot(points[i].normal, points[j].normal);
            count += 1.0;
        });
        rough[i] = sum / count;
    }
    return rough;
}

/// Labels the connected patches of broken points that are large enough, and nothing else. Those as scanned stay so.
std::size_t label_patches(std::span<contact::SurfacePoint> points, const std::vector<std::uint8_t>& broken, double near,
                          double min_area) {
    contact::remove_paint(points);
    const auto is_broken = [&](std::size_t i) {
        return broken[i] != 0 && points[i].label != contact::surface_label::as_scanned;
    };
    std::size_t count = 0;
    for (const auto& patch : contact::patches_of(points, near, is_broken)) {
        double area = 0.0;
        for (const std::size_t i : patch) area += points[i].area;
        if (area < min_area) continue;
        for (const std::size_t i : patch) points[i].label = contact::surface_label::fracture;
        count += patch.size();
    }
    return count;
}

geometry::PointTree tree_of(std::span<const contact::SurfacePoint> other) {
    if (other.empty()) throw Error("the other fragment has no surface");
    std::vector<Vec3> places;
    places.reserve(other.size());
    for (const contact::SurfacePoint& p : other) places.push_back(p.position);
    return geometry::PointTree(places);
}

/// m: greatest distance between neighbours in one patch.
double patch_gap(std::span<const contact::SurfacePoint> points) {
    double largest = 0.0;
    for (const contact::SurfacePoint& p : points) largest = std::max(largest, p.area);
    return std::max(1.5e-3, 1.5 * std::sqrt(largest));
}

}  // namespace

std::size_t propose_fracture(std::span<contact::SurfacePoint> points, const ProposalOptions& options) {
    const std::vector<double> rough = roughness_of(points, options.near);
    const contact::Neighbours neighbours(points, options.smooth);
    std::vector<std::uint8_t> broken(points.size(), 0);
    std::vector<double> nearby;
    for (std::size_t i = 0; i < points.size(); ++i) {
        // A median, because a sharp rim is rough along a line only and would spread in a mean.
        nearby.clear();
        neighbours.around(i, [&](std::size_t j) {
            if (glm::dot(points[i].normal, points[j].normal) > 0.0) nearby.push_back(rough[j]);
        });
        const auto middle = nearby.begin() + static_cast<std::ptrdiff_t>(nearby.size() / 2);
        std::nth_element(nearby.begin(), middle, nearby.end());
        broken[i] = *middle > options.roughness;
    }
    return label_patches(points, broken, options.near, options.min_area);
}

std::size_t propose_facing(std::span<contact::SurfacePoint> points, std::span<const contact::SurfacePoint> other,
                           const FacingOptions& options) {
    constexpr double looks_back = -0.5, ahead = 0.3, touching = 1e-3;
    const geometry::PointTree tree = tree_of(other);
    std::vector<std::uint8_t> faces(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const contact::SurfacePoint &p = points[i], &q = other[tree.nearest(points[i].position)];
        const Vec3 way = q.position - p.position;
        const double away = glm::length(way);
        faces[i] = away < options.reach && glm::dot(p.normal, q.normal) < looks_back &&
                   (away < touching || glm::dot(p.normal, way) > ahead * away);
    }
    return label_patches(points, faces, patch_gap(points), options.min_area);
}

std::vector<std::uint8_t> broken_inside(std::span<const contact::SurfacePoint> points,
                                        const fit::RegistrationTarget& intact, const Pose& place,
                                        const IntactOptions& options) {
    std::vector<std::uint8_t> inside(points.size(), 0), broken(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 at = place.apply(points[i].position);
        const std::size_t nearest = intact.nearest(at);
        const Vec3 way = intact.position(nearest) - at, &out = intact.normal(nearest);
        const double depth = glm::dot(way, out) > 0.0 ? glm::length(way) : 0.0;
        const bool is_askew = glm::dot(place.rotate(points[i].normal), out) < options.looks_along;
        inside[i] = depth > options.deep || (is_askew && depth > options.askew);
    }
    const contact::Neighbours neighbours(points, options.smooth);
    for (std::size_t i = 0; i < points.size(); ++i) {
        double all = 0.0, those_inside = 0.0;
        neighbours.around(i, [&](std::size_t j) {
            if (!(glm::dot(points[i].normal, points[j].normal) > 0.0)) return;
            all += points[j].area;
            those_inside += inside[j] ? points[j].area : 0.0;
        });
        broken[i] = those_inside > 0.5 * all;
    }
    return broken;
}

std::size_t label_broken(std::span<contact::SurfacePoint> points, const std::vector<std::uint8_t>& broken,
                         double min_area) {
    return label_patches(points, broken, patch_gap(points), min_area);
}

std::size_t propose_inside(std::span<contact::SurfacePoint> points, const fit::RegistrationTarget& intact,
                           const Pose& place, const IntactOptions& options) {
    return label_broken(points, broken_inside(points, intact, place, options), options.min_area);
}

std::size_t keep_patches_near(std::span<contact::SurfacePoint> points, std::span<const contact::SurfacePoint> other,
                              double reach) {
    const geometry::PointTree tree = tree_of(other);
    const auto is_near = [&](std::size_t i) {
        return glm::length(other[tree.nearest(points[i].position)].position - points[i].position) < reach;
    };
    std::size_t count = 0;
    for (const auto& patch : contact::patches_of(points, patch_gap(points), [&](std::size_t i) {
             return points[i].label == contact::surface_label::fracture;
         }))
        if (std::ranges::any_of(patch, is_near)) count += patch.size();
        else
            for (const std::size_t i : patch) points[i].label = contact::surface_label::none;
    return count;
}

std::size_t drop_small_faces(std::span<contact::SurfacePoint> points, double min_area) {
    const auto labelled = [&] {
        return static_cast<std::size_t>(
            std::ranges::count(points, contact::surface_label::fracture, &contact::SurfacePoint::label));
    };
    std::size_t left = labelled();
    if (!(min_area > 0.0)) return left;
    // Without a small face its neighbours may be split otherwise.
    for (int round = 0; round < 5; ++round) {
        const auto faces = fit::split_faces(points);
        for (contact::SurfacePoint& p : points)
            if (p.label == contact::surface_label::fracture) p.label = contact::surface_label::none;
        for (const auto& face : faces) {
            double area = 0.0;
            for (const std::size_t n : face) area += points[n].area;
            if (area < min_area) continue;
            for (const std::size_t n : face) points[n].label = contact::surface_label::fracture;
        }
        const std::size_t now = labelled();
        if (now == left) break;
        left = now;
    }
    return left;
}

}  // namespace tactus::plan
