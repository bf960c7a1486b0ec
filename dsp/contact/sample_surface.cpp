// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/sample_surface.hpp"

#include "dsp/contact/field_sample.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/geometry/point_cubes.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace tactus::contact {

namespace {

constexpr double min_distance = 0.77;  // of the spacing; leaves about one point per spacing²
constexpr double candidates_per_point = 10.0;
constexpr std::size_t first_batch = 4096;
constexpr double finest = 1.0 / 3.0;  // of the spacing, at high curvature
// Points whose normals differ by more than this lie on different sides of an edge or of a thin wall.
constexpr double same_side = -0.3;

struct Candidates {
    std::vector<Vec3> position, normal;
    std::vector<double> area, radius;  // radius: minimum distance of accepted points
};

/// Calls use(first, end) for parts of a range, as jobs.
template <class Use>
void in_parts(std::size_t count, const RunJobs& run, const Use& use) {
    constexpr std::size_t part = 8192;
    run(static_cast<int>((count + part - 1) / part), [&](int job) {
        leave_if_stopped();
        const std::size_t first = static_cast<std::size_t>(job) * part;
        use(first, std::min(count, first + part));
    });
}

double area_of_triangle(const geometry::TriangleSurface& s, const std::array<int, 3>& t, Vec3& normal) {
    const auto at = [&](int n) { return s.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(n)])]; };
    normal = glm::cross(at(1) - at(0), at(2) - at(0));
    const double twice = glm::length(normal);
    if (twice > 0.0) normal /= twice;
    return 0.5 * twice;
}

/// Random points on the triangles, in proportion to area: each triangle gets the integer part of its share and passes
/// the remainder on, so that small triangles are not lost.
Candidates scatter(const geometry::TriangleSurface& surface, double area_of_all, double per_area,
                   const SurfaceSampling& sampling) {
    const Random random{sampling.seed};
    Candidates made;
    const std::size_t expected = static_cast<std::size_t>(area_of_all * per_area) + 2;
    made.position.reserve(expected);
    made.normal.reserve(expected);
    made.area.reserve(expected);
    double owed = 0.5;
    std::uint64_t draw = 0;
    double unplaced = 0.0;  // area of triangles without a point so far
    for (const auto& triangle : surface.triangles) {
        Vec3 normal;
        const double area = area_of_triangle(surface, triangle, normal);
        owed += area * per_area;
        unplaced += area;
        const auto count = static_cast<std::size_t>(owed);
        owed -= static_cast<double>(count);
        for (std::size_t n = 0; n < count; ++n, draw += 2) {
            const double u = std::sqrt(random.uniform(draw)), v = random.uniform(draw + 1);
            const auto at = [&](std::size_t c) { return surface.vertices[static_cast<std::size_t>(triangle[c])]; };
            made.position.push_back((1.0 - u) * at(0) + u * (1.0 - v) * at(1) + u * v * at(2));
            made.normal.push_back(normal);
            made.area.push_back(unplaced / static_cast<double>(count));
        }
        if (count > 0) unplaced = 0.0;
    }
    if (!made.area.empty()) made.area.back() += unplaced;
    return made;
}

/// About the normals of a cube's points. A normal whose cosine with the axis is `enough` or more is within the allowed
/// turn of all of them.
struct NormalCone {
    Vec3 axis{0.0};
    double enough = 2.0;  // more than any cosine: none
};

NormalCone cone_of(std::span<const geometry::PackedCubes::Entry> points, double turn) {
    NormalCone cone;
    for (const auto& point : points) cone.axis += point.normal;
    const double length = glm::length(cone.axis);
    if (!(length > 0.0)) return cone;
    cone.axis /= length;
    double least = 1.0;
    for (const auto& point : points) least = std::min(least, glm::dot(cone.axis, point.normal));
    // A little narrower, so that rounding leaves out nothing that counts.
    const double left = 0.999 * turn - std::acos(std::clamp(least, -1.0, 1.0));
    if (left > 0.0) cone.enough = std::cos(left);
    return cone;
}

void follow_curvature(Candidates& all, const SurfaceSampling& sampling, const RunJobs& run) {
    const geometry::PackedCubes cubes(all.position, all.normal, sampling.spacing);
    // Within this turn the radius is at its greatest: cubes whose normals all are count for nothing.
    std::vector<NormalCone> cones(cubes.slots());
    in_parts(cones.size(), run, [&](std::size_t first, std::size_t end) {
        for (std::size_t s = first; s < end; ++s) cones[s] = cone_of(cubes.in(s), sampling.max_turn);
    });
    // A turn at which the radius is at its least; a little more, so that rounding changes nothing.
    const double tight = std::cos(std::min(1.01 * sampling.max_turn / finest, 3.1));
    const double radius2 = sampling.spacing * sampling.spacing;
    in_parts(cubes.all().size(), run, [&](std::size_t first, std::size_t end) {
        geometry::PackedCubes::Block block;
        for (const auto& own : cubes.all().subspan(first, end - first)) {
            double least = 1.0;
            for (const std::uint32_t slot : cubes.around(own.place, block).slots) {
                if (glm::dot(own.normal, cones[slot].axis) >= cones[slot].enough) continue;
                for (const auto& other : cubes.in(slot)) {
                    const Vec3 apart = other.place - own.place;
                    if (!(glm::dot(apart, apart) <= radius2)) continue;
                    const double along = glm::dot(own.normal, other.normal);
                    if (along > same_side) least = std::min(least, along);
                }
                if (least < tight) break;
            }
            const double turn = std::acos(std::clamp(least, -1.0, 1.0));
            all.radius[own.index] *= std::clamp(sampling.max_turn / std::max(turn, 1e-9), finest, 1.0);
        }
    });
}

/// Indices in the order of their random numbers.
std::vector<std::uint32_t> drawn_order(std::size_t count, const Random& random) {
    // The numbers are even: their first bits put nearly all into place.
    const int bits = std::bit_width(count), shift = 64 - std::max(bits, 1);
    std::vector<std::uint32_t> first((std::size_t{1} << (64 - shift)) + 1, 0);
    for (std::uint32_t n = 0; n < count; ++n) ++first[(random.bits(n) >> shift) + 1];
    for (std::size_t b = 1; b < first.size(); ++b) first[b] += first[b - 1];
    std::vector<std::uint32_t> order(count), next(first.begin(), first.end() - 1);
    for (std::uint32_t n = 0; n < count; ++n) order[next[random.bits(n) >> shift]++] = n;
    for (std::size_t b = 0; b + 1 < first.size(); ++b)
        std::ranges::stable_sort(order.begin() + first[b], order.begin() + first[b + 1], {},
                                 [&random](std::uint32_t n) { return random.bits(n); });
    return order;
}

/// Poisson-disc sampling by dart throwing: visits candidates in random order and accepts each one that keeps the
/// distance to accepted ones, then adds every candidate's area to the nearest accepted point.
std::vector<SurfacePoint> thin_out(const Candidates& all, const SurfaceSampling& sampling, const RunJobs& run) {
    const std::size_t count = all.position.size();
    const std::vector<std::uint32_t> order = drawn_order(count, Random{mix(sampling.seed)});
    geometry::GrowingCubes cubes(count / 8, sampling.spacing);
    std::vector<std::uint32_t> kept;
    const double widest = min_distance * sampling.spacing;
    const auto is_free = [&](std::uint32_t c) {
        bool free = true;
        cubes.around(all.position[c], widest, [&](std::uint32_t k, double d2) {
            if (sampling.follow_curvature) {
                const double least = std::min(all.radius[c], all.radius[kept[k]]);
                if (d2 >= least * least) return true;
            }
            free = !(d2 < widest * widest) || glm::dot(all.normal[c], all.normal[kept[k]]) < same_side;
            return free;
        });
        return free;
    };
    // Jobs reject the candidates that earlier batches exclude, in the order of the surface, which is that of memory: nearly
    // all of most batches. What is left is decided in random order. Batches grow with the accepted points, so that few
    // candidates of one exclude each other.
    std::vector<std::uint8_t> is_excluded(count, 0);
    std::vector<std::uint32_t> batch;
    for (std::size_t begin = 0; begin < count; begin += batch.size()) {
        const std::size_t end = std::min(count, begin + std::max(first_batch, kept.size()));
        batch.assign(order.begin() + static_cast<std::ptrdiff_t>(begin),
                     order.begin() + static_cast<std::ptrdiff_t>(end));
        std::ranges::sort(batch);
        in_parts(batch.size(), run, [&](std::size_t first, std::size_t last) {
            for (std::size_t n = first; n < last; ++n) is_excluded[batch[n]] = !is_free(batch[n]);
        });
        for (std::size_t n = begin; n < end; ++n) {
            const std::uint32_t c = order[n];
            if (is_excluded[c] || !is_free(c)) continue;
            if (kept.size() == sampling.max_points)
                throw Error(fmt::format("a spacing of {:.4g} mm gives more than {} points; take a larger one",
                                        1e3 * sampling.spacing, sampling.max_points));
            cubes.add(all.position[c]);
            kept.push_back(c);
        }
    }
    std::vector<SurfacePoint> points;
    for (const std::uint32_t c : kept) points.push_back({all.position[c], all.normal[c], 0.0, surface_label::none});
    std::vector<Vec3> places, normals;
    for (const SurfacePoint& point : points) {
        places.push_back(point.position);
        normals.push_back(point.normal);
    }
    const geometry::PackedCubes owners(places, normals, sampling.spacing);
    const double radius2 = sampling.spacing * sampling.spacing;
    std::vector<std::uint32_t> owner_of(count, 0);
    in_parts(count, run, [&](std::size_t first, std::size_t end) {
        geometry::PackedCubes::Block block;
        for (std::size_t i = first; i < end; ++i) {
            double nearest = std::numeric_limits<double>::infinity();
            std::uint32_t owner = 0;
            owners.around(all.position[i], block);
            const auto apart2 = owners.apart2(all.position[i], block);
            for (std::size_t s = 0; s < block.slots.size(); ++s) {
                // A little more, so that rounding leaves out nothing.
                if (apart2[s] > 1.001 * nearest) continue;
                for (const auto& point : owners.in(block.slots[s])) {
                    const Vec3 apart = point.place - all.position[i];
                    const double d2 = glm::dot(apart, apart);
                    if (!(d2 <= radius2)) continue;
                    // Ties go to the lower index, for any order of visits.
                    const bool better = d2 < nearest || (d2 == nearest && point.index < owner);
                    if (better && glm::dot(all.normal[i], point.normal) >= same_side) nearest = d2, owner = point.index;
                }
            }
            owner_of[i] = owner;
        }
    });
    for (std::size_t i = 0; i < count; ++i) points[owner_of[i]].area += all.area[i];
    return points;
}

/// The smoothed gradient, where it is reliable.
Vec3 normal_in(const volume::Grid& distance, const Vec3& position, const Vec3& otherwise) {
    const Vec3 out = smooth_sample_field(distance, position).gradient;
    const double steep = glm::length(out);
    return steep > 0.5 ? out / steep : otherwise;
}

/// With a field, curvature comes from its normals: those of the triangles follow the noise of the samples.
std::vector<SurfacePoint> spread(const geometry::TriangleSurface& surface, const SurfaceSampling& sampling,
                                 const volume::Grid* distance, const RunJobs& run) {
    if (!(sampling.spacing > 0.0) || !std::isfinite(sampling.spacing))
        throw Error("the spacing of a pointshell must be positive");
    double area = 0.0;
    Vec3 ignored;
    for (const auto& triangle : surface.triangles) area += area_of_triangle(surface, triangle, ignored);
    const double densest = sampling.follow_curvature ? 4.0 : 1.0;
    const double per_area = candidates_per_point * densest / (sampling.spacing * sampling.spacing);
    if (!std::isfinite(area)) throw Error("a surface with corners that are no numbers cannot be sampled");
    if (area / (sampling.spacing * sampling.spacing) > 2.0 * static_cast<double>(sampling.max_points))
        throw Error(fmt::format("a spacing of {:.4g} mm on {:.4g} mm² gives more than {} points; take a larger one",
                                1e3 * sampling.spacing, 1e6 * area, sampling.max_points));
    Candidates all = scatter(surface, area, per_area, sampling);
    all.radius.assign(all.position.size(), min_distance * sampling.spacing);
    if (sampling.follow_curvature) {
        if (distance)
            in_parts(all.position.size(), run, [&](std::size_t first, std::size_t end) {
                for (std::size_t i = first; i < end; ++i)
                    all.normal[i] = normal_in(*distance, all.position[i], all.normal[i]);
            });
        follow_curvature(all, sampling, run);
    }
    return thin_out(all, sampling, run);
}

}  // namespace

std::vector<SurfacePoint> sample_surface(const geometry::TriangleSurface& surface, const SurfaceSampling& sampling,
                                         const RunJobs& run) {
    return spread(surface, sampling, nullptr, run);
}

std::vector<SurfacePoint> sample_surface(const volume::Grid& distance, const SurfaceSampling& sampling,
                                         const RunJobs& run) {
    const geometry::TriangleSurface surface = geometry::iso_surface(distance, 0.0f, /*inside_above=*/false);
    if (surface.triangles.empty()) return spread(surface, sampling, nullptr, run);
    std::vector<SurfacePoint> points = spread(surface, sampling, &distance, run);
    in_parts(points.size(), run, [&](std::size_t first, std::size_t end) {
        for (SurfacePoint& point : std::span(points).subspan(first, end - first)) {
            for (int step = 0; step < 3; ++step) {
                const volume::Sample here = sample_field(distance, point.position);
                const double steep2 = glm::dot(here.gradient, here.gradient);
                if (!here.inside || steep2 < 0.25) break;
                const Vec3 move = here.gradient * (here.value / steep2);
                // Where the field has a kink a step may go astray; the triangle's point is then close enough.
                if (glm::length(move) > 0.5 * glm::length(distance.spacing)) break;
                point.position -= move;
            }
            point.normal = normal_in(distance, point.position, point.normal);
        }
    });
    return points;
}

std::size_t label_facing(std::span<SurfacePoint> points, const Voxmap& other, const Pose& into_map, double reach,
                         double max_angle, std::uint8_t label) {
    std::size_t count = 0;
    for (SurfacePoint& point : points) {
        const volume::Sample there = other.smooth_sample(into_map.apply(point.position));
        const double steep = glm::length(there.gradient);
        if (!there.inside || std::abs(there.value) > reach || !(steep > 0.0)) continue;
        const double against = -glm::dot(into_map.rotate(point.normal), there.gradient) / steep;
        if (against < std::cos(max_angle)) continue;
        point.label = label;
        ++count;
    }
    return count;
}

}  // namespace tactus::contact
