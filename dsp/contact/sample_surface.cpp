// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/sample_surface.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"

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

constexpr double least_distance = 0.77;  // of the spacing; leaves about one point per spacing²
constexpr double candidates_per_point = 10.0;
constexpr double finest = 1.0 / 3.0;  // of the spacing, at high curvature
// Points whose normals differ by more than this lie on different sides of an edge or of a thin wall.
constexpr double same_side = -0.3;

/// Spatial hash of points by cubes of two radii: a ball touches at most eight of them, its own first.
class Cubes {
public:
    /// `radius`: the greatest of a query.
    Cubes(std::size_t expected, double radius) : side_(2.001 * radius), head_(std::bit_ceil(expected + 1), none) {}

    void add(const Vec3& p) {
        const std::size_t slot = slot_of(cell(p.x), cell(p.y), cell(p.z));
        points_.push_back({p, head_[slot]});
        head_[slot] = static_cast<std::uint32_t>(points_.size() - 1);
    }

    /// Calls visit(index, distance²) for all within `radius`; stops when it returns false. Twice for the same point
    /// when two cubes share a slot.
    template <class Visit>
    void around(const Vec3& p, double radius, const Visit& visit) const {
        const std::int64_t x = cell(p.x), y = cell(p.y), z = cell(p.z);
        const std::int64_t bx = beside(p.x, x), by = beside(p.y, y), bz = beside(p.z, z);
        for (int n = 0; n < 8; ++n) {
            const std::size_t slot = slot_of(x + (n & 1 ? bx : 0), y + (n & 2 ? by : 0), z + (n & 4 ? bz : 0));
            for (std::uint32_t i = head_[slot]; i != none; i = points_[i].next) {
                const Vec3 apart = points_[i].place - p;
                const double d2 = glm::dot(apart, apart);
                if (d2 <= radius * radius && !visit(i, d2)) return;
            }
        }
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    struct Entry {
        Vec3 place;
        std::uint32_t next;  // in the same slot
    };

    std::int64_t cell(double x) const { return static_cast<std::int64_t>(std::floor(x / side_)); }
    /// The nearer neighbour of a cube along an axis.
    std::int64_t beside(double x, std::int64_t cell) const {
        return x / side_ - static_cast<double>(cell) < 0.5 ? -1 : 1;
    }
    std::size_t slot_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
        const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1fffff; };
        return mix(bits(x) | bits(y) << 21 | bits(z) << 42) & (head_.size() - 1);
    }

    double side_;
    std::vector<std::uint32_t> head_;
    std::vector<Entry> points_;
};

struct Candidates {
    std::vector<Vec3> position, normal;
    std::vector<double> area, radius;  // radius: minimum distance of accepted points
};

double area_of_triangle(const geometry::TriangleSurface& s, const std::array<int, 3>& t, Vec3& normal) {
    const auto at = [&](int n) { return s.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(n)])]; };
    normal = glm::cross(at(1) - at(0), at(2) - at(0));
    const double twice = glm::length(normal);
    if (twice > 0.0) normal /= twice;
    return 0.5 * twice;
}

/// Random points on the triangles, in proportion to area: each triangle gets the integer part of its share and passes
/// the remainder on, so that small triangles are not lost.
Candidates scatter(const geometry::TriangleSurface& surface, double per_area, const SurfaceSampling& sampling) {
    const Random random{sampling.seed};
    Candidates made;
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

void follow_curvature(Candidates& all, const SurfaceSampling& sampling) {
    Cubes cubes(all.position.size(), sampling.spacing);
    for (const Vec3& p : all.position) cubes.add(p);
    for (std::size_t i = 0; i < all.position.size(); ++i) {
        double least = 1.0;
        cubes.around(all.position[i], sampling.spacing, [&](std::uint32_t j, double) {
            const double along = glm::dot(all.normal[i], all.normal[j]);
            if (along > same_side) least = std::min(least, along);
            return true;
        });
        const double turn = std::acos(std::clamp(least, -1.0, 1.0));
        all.radius[i] *= std::clamp(sampling.most_turn / std::max(turn, 1e-9), finest, 1.0);
    }
}

/// Poisson-disc sampling by dart throwing: visits candidates in random order and accepts each one that keeps the
/// distance to accepted ones, then adds every candidate's area to the nearest accepted point.
std::vector<SurfacePoint> thin_out(const Candidates& all, const SurfaceSampling& sampling) {
    const std::size_t count = all.position.size();
    const Random random{mix(sampling.seed)};
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(count);
    for (std::uint32_t n = 0; n < count; ++n) order[n] = {random.bits(n), n};
    std::ranges::sort(order);
    Cubes cubes(count / 8, sampling.spacing);
    std::vector<std::uint32_t> kept;
    for (const auto& drawn : order) {
        const std::uint32_t c = drawn.second;
        bool free = true;
        cubes.around(all.position[c], least_distance * sampling.spacing, [&](std::uint32_t k, double d2) {
            const double least = std::min(all.radius[c], all.radius[kept[k]]);
            free = d2 >= least * least || glm::dot(all.normal[c], all.normal[kept[k]]) < same_side;
            return free;
        });
        if (!free) continue;
        if (kept.size() == sampling.most_points)
            throw Error(fmt::format("a spacing of {:.4g} mm gives more than {} points; take a larger one",
                                    1e3 * sampling.spacing, sampling.most_points));
        cubes.add(all.position[c]);
        kept.push_back(c);
    }
    std::vector<SurfacePoint> points;
    for (const std::uint32_t c : kept) points.push_back({all.position[c], all.normal[c], 0.0, surface_label::none});
    for (std::size_t i = 0; i < count; ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        std::uint32_t owner = 0;
        cubes.around(all.position[i], sampling.spacing, [&](std::uint32_t k, double d2) {
            // Ties go to the lower index, for any order of visits.
            const bool better = d2 < nearest || (d2 == nearest && k < owner);
            if (better && glm::dot(all.normal[i], all.normal[kept[k]]) >= same_side) nearest = d2, owner = k;
            return true;
        });
        points[owner].area += all.area[i];
    }
    return points;
}

/// The smoothed gradient, where it is reliable.
Vec3 normal_in(const Voxmap& map, const Vec3& position, const Vec3& otherwise) {
    const Vec3 out = map.smooth_sample(position).gradient;
    const double steep = glm::length(out);
    return steep > 0.5 ? out / steep : otherwise;
}

/// With a map, curvature comes from its normals: those of the triangles follow the noise of the samples.
std::vector<SurfacePoint> spread(const geometry::TriangleSurface& surface, const SurfaceSampling& sampling,
                                 const Voxmap* map) {
    if (!(sampling.spacing > 0.0) || !std::isfinite(sampling.spacing))
        throw Error("the spacing of a pointshell must be positive");
    double area = 0.0;
    Vec3 ignored;
    for (const auto& triangle : surface.triangles) area += area_of_triangle(surface, triangle, ignored);
    const double densest = sampling.follow_curvature ? 4.0 : 1.0;
    const double per_area = candidates_per_point * densest / (sampling.spacing * sampling.spacing);
    if (!std::isfinite(area)) throw Error("a surface with corners that are no numbers cannot be sampled");
    if (area / (sampling.spacing * sampling.spacing) > 2.0 * static_cast<double>(sampling.most_points))
        throw Error(fmt::format("a spacing of {:.4g} mm on {:.4g} mm² gives more than {} points; take a larger one",
                                1e3 * sampling.spacing, 1e6 * area, sampling.most_points));
    Candidates all = scatter(surface, per_area, sampling);
    all.radius.assign(all.position.size(), least_distance * sampling.spacing);
    if (sampling.follow_curvature) {
        if (map)
            for (std::size_t i = 0; i < all.position.size(); ++i)
                all.normal[i] = normal_in(*map, all.position[i], all.normal[i]);
        follow_curvature(all, sampling);
    }
    return thin_out(all, sampling);
}

}  // namespace

std::vector<SurfacePoint> sample_surface(const geometry::TriangleSurface& surface, const SurfaceSampling& sampling) {
    return spread(surface, sampling, nullptr);
}

std::vector<SurfacePoint> sample_surface(const volume::Grid& distance, const SurfaceSampling& sampling) {
    const geometry::TriangleSurface surface = geometry::iso_surface(distance, 0.0f, /*inside_above=*/false);
    if (surface.triangles.empty()) return spread(surface, sampling, nullptr);
    const Voxmap map = make_voxmap(distance);
    std::vector<SurfacePoint> points = spread(surface, sampling, &map);
    for (SurfacePoint& point : points) {
        for (int step = 0; step < 3; ++step) {
            const volume::Sample here = map.sample(point.position);
            const double steep2 = glm::dot(here.gradient, here.gradient);
            if (!here.inside || steep2 < 0.25) break;
            const Vec3 move = here.gradient * (here.value / steep2);
            // Where the field has a kink a step may go astray; the triangle's point is then close enough.
            if (glm::length(move) > 0.5 * glm::length(distance.spacing)) break;
            point.position -= move;
        }
        point.normal = normal_in(map, point.position, point.normal);
    }
    return points;
}

std::size_t label_facing(std::span<SurfacePoint> points, const Voxmap& other, const Pose& into_map, double reach,
                         double most_angle, std::uint8_t label) {
    std::size_t count = 0;
    for (SurfacePoint& point : points) {
        const volume::Sample there = other.smooth_sample(into_map.apply(point.position));
        const double steep = glm::length(there.gradient);
        if (!there.inside || std::abs(there.value) > reach || !(steep > 0.0)) continue;
        const double against = -glm::dot(into_map.rotate(point.normal), there.gradient) / steep;
        if (against < std::cos(most_angle)) continue;
        point.label = label;
        ++count;
    }
    return count;
}

}  // namespace tactus::contact
