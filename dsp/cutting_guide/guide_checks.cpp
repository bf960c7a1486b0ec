// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/guide_checks.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tactus::cutting_guide {

namespace {

constexpr double opposite = -0.8660254037844386;  // cosine of 150°
constexpr double facing = 0.8, farthest_relief = 4.0 * mm, contact_margin = 0.1 * mm;
constexpr int chunk = 2048, sample = 32;  // facets of a job; every which is sampled first

/// A triangle as its middle, unit normal and area.
struct Facet {
    Vec3 middle, normal;
    double area;
};

Facet facet(const geometry::TriangleSurface& surface, std::size_t t) {
    const auto at = [&](std::size_t n) { return surface.vertices[static_cast<std::size_t>(surface.triangles[t][n])]; };
    const Vec3 a = at(0), b = at(1), c = at(2), n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    return {(a + b + c) / 3.0, length > 0.0 ? n / length : Vec3(0.0), 0.5 * length};
}

int jobs_of(const geometry::TriangleSurface& surface) {
    return (static_cast<int>(surface.triangles.size()) + chunk - 1) / chunk;
}

template <class Each>
void each_of(const geometry::TriangleSurface& surface, int job, const Each& each) {
    const std::size_t first = static_cast<std::size_t>(job) * chunk,
                      last = std::min(surface.triangles.size(), first + chunk);
    for (std::size_t t = first; t < last; ++t) each(facet(surface, t));
}

/// The largest ball within the solid that touches a facet at its middle.
struct Ball {
    double radius = 0.0;  // m
    bool is_bounded = false;  // by an opposite face: its diameter is the thickness of a wall
    double angle = 0.0;  // rad, between the faces
};

Vec3 middle_of(const Facet& f, double radius) { return f.middle - radius * f.normal; }

Ball ball_at(const geometry::TriangleTree& tree, const Facet& f, double max_radius) {
    double radius = max_radius;
    geometry::TriangleTree::Near near;
    for (int round = 0; round < 40; ++round) {
        const auto closer = tree.nearest(middle_of(f, radius), radius * (1.0 - 1e-6));
        if (!std::isfinite(closer.distance)) break;
        near = closer;
        const Vec3 to = f.middle - near.point;
        const double along = glm::dot(to, f.normal);
        if (!(along > 1e-9)) return {};  // the triangle itself or one beside it
        radius = 0.5 * glm::dot(to, to) / along;
    }
    const bool is_opposite =
        std::isfinite(near.distance) && near.normal != Vec3(0.0) && !(glm::dot(near.normal, f.normal) > opposite);
    return {radius, is_opposite,
            is_opposite ? std::acos(std::clamp(-glm::dot(near.normal, f.normal), -1.0, 1.0)) : 0.0};
}

/// The thinnest place of the wall between a facet and the face on the other side of the solid, which three lines from
/// the facet along its normal find; none: there is none, or its normal differs by less than 120°.
std::optional<Taper> taper_at(const geometry::TriangleTree& tree, const std::array<Vec3, 3>& corners, const Facet& f,
                              double limit) {
    // m: from the facet into the solid, and the radius of a ball that replaces a line.
    constexpr double skin = 1e-4 * mm, line = 1e-6 * mm;
    // The normal of a facet without area, as at the corner of two slots, may point into the solid.
    constexpr double min_area = 1e-3 * mm * mm;
    if (f.area < min_area) return {};
    const auto depth = [&](const Vec3& from, const Vec3& along) {
        const double reach = 2.0 * limit + skin;
        const double part = tree.sweep(from + skin * along, reach * along, line);
        return part < 1.0 ? skin + part * reach : infinity;
    };
    std::array<Vec3, 3> other{};
    for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 from = 0.5 * (corners[c] + f.middle);
        const double away = depth(from, -f.normal);
        if (!std::isfinite(away)) return {};
        other[c] = from - away * f.normal;
    }
    Vec3 normal = glm::cross(other[1] - other[0], other[2] - other[0]);
    if (!(glm::length(normal) > 0.0)) return {};
    normal = glm::normalize(glm::dot(normal, f.normal) > 0.0 ? -normal : normal);
    const double angle = std::acos(std::clamp(-glm::dot(normal, f.normal), -1.0, 1.0));
    if (angle > 2.0 * taper_step) return {};
    const Vec3 across = glm::normalize(normal - f.normal);
    std::optional<Taper> thinnest;
    for (const Vec3& corner : corners) {
        const Vec3 from = 0.95 * corner + 0.05 * f.middle;
        // What lies between, such as the end of the wall, is not the other face.
        const double wanted = glm::dot(other[0] - from, normal) / glm::dot(across, normal), found = depth(from, across);
        if (!(found < limit && std::abs(found - wanted) < 0.02 * mm + 0.05 * found)) continue;
        const Vec3 out = tree.nearest(from + found * across, 0.1 * mm).normal;
        if (glm::dot(out, across) < 0.0) continue;  // a line through the air
        if (!thinnest || found < thinnest->thickness) thinnest = Taper{found, angle, from + 0.5 * found * across};
    }
    return thinnest;
}

/// Points in cubic cells as wide as the distance within which they are sought.
class NearPoints {
public:
    NearPoints(std::vector<Vec3> points, double within) : within_(within), points_(std::move(points)) {
        std::ranges::sort(points_, [&](const Vec3& a, const Vec3& b) { return cell(a) < cell(b); });
    }
    bool is_any_near(const Vec3& p) const {
        const Cell middle = cell(p);
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
                // Cells along the last axis follow each other.
                const Cell low{middle[0] + i, middle[1] + j, middle[2] - 1},
                    high{middle[0] + i, middle[1] + j, middle[2] + 1};
                auto at = std::ranges::lower_bound(points_, low, {}, [&](const Vec3& q) { return cell(q); });
                for (; at != points_.end() && cell(*at) <= high; ++at)
                    if (glm::dot(*at - p, *at - p) <= within_ * within_) return true;
            }
        return false;
    }

private:
    using Cell = std::array<int, 3>;
    Cell cell(const Vec3& p) const {
        return {static_cast<int>(std::floor(p.x / within_)), static_cast<int>(std::floor(p.y / within_)),
                static_cast<int>(std::floor(p.z / within_))};
    }

    double within_;
    std::vector<Vec3> points_;
};

/// Keeps the `wall_triangles` thinnest.
void keep_thinnest(std::vector<ThinWall>& walls, const ThinWall& wall) {
    walls.insert(std::ranges::upper_bound(walls, wall.thickness, {}, &ThinWall::thickness), wall);
    if (walls.size() > wall_triangles) walls.pop_back();
}

/// The thinnest ends of each class of angles.
struct TaperLists {
    std::array<std::vector<Taper>, 2> tapers;

    void add(const Taper& taper) {
        auto& list = tapers[taper.angle > taper_step ? 1 : 0];
        list.insert(std::ranges::upper_bound(list, taper.thickness, {}, &Taper::thickness), taper);
        if (list.size() > wall_triangles) list.pop_back();
    }
    void add(const TaperLists& others) {
        for (const auto& list : others.tapers)
            for (const Taper& taper : list) add(taper);
    }
    Tapers thinnest() const {
        Tapers found;
        for (std::size_t n = 0; n < tapers.size(); ++n)
            if (tapers[n].size() == wall_triangles) found[n] = tapers[n].back();
        return found;
    }
};

}  // namespace

Walls walls_of(const geometry::TriangleSurface& surface, const geometry::TriangleTree& tree, double limit,
               const std::function<bool(const Vec3&)>& counts, const RunJobs& run) {
    struct Part {
        std::vector<ThinWall> thin, thicker;  // thicker: the thinnest of those that are not thin
        std::vector<Vec3> balls;  // see Walls
        std::vector<double> angles;  // between the faces of each of `thin`
        TaperLists tapers;
    };
    // Balls begin at `widest`, or at the thinnest walls that their job has found.
    const auto measure = [&](Part& part, std::size_t triangle, double widest) {
        const Facet f = facet(surface, triangle);
        if (f.normal == Vec3(0.0) || !counts(f.middle)) return;
        if (part.thicker.size() == wall_triangles) widest = part.thicker.back().thickness;
        const Ball ball = ball_at(tree, f, 0.5 * widest);
        const ThinWall wall{2.0 * ball.radius, middle_of(f, ball.radius)};
        if (wall.thickness >= limit) {
            part.balls.push_back(middle_of(f, 0.5 * limit));
            if (ball.is_bounded) keep_thinnest(part.thicker, wall);
        } else if (ball.is_bounded) {
            part.thin.push_back(wall);
            part.angles.push_back(ball.angle);
        } else if (ball.radius > 0.0) {
            const auto corner = [&](std::size_t n) {
                return surface.vertices[static_cast<std::size_t>(surface.triangles[triangle][n])];
            };
            if (const auto taper = taper_at(tree, {corner(0), corner(1), corner(2)}, f, limit)) part.tapers.add(*taper);
        }
    };
    const auto run_parts = [&](int jobs, const auto& of_job) {
        std::vector<Part> parts(static_cast<std::size_t>(jobs));
        run(jobs, [&](int job) { of_job(job, parts[static_cast<std::size_t>(job)]); });
        return parts;
    };
    const auto thicker_of = [](const std::vector<Part>& parts) {
        std::vector<ThinWall> all;
        for (const Part& part : parts)
            for (const ThinWall& wall : part.thicker) keep_thinnest(all, wall);
        return all;
    };
    const double most = std::max(limit, max_measured_wall);
    const std::vector<ThinWall> sampled =
        thicker_of(run_parts((jobs_of(surface) + sample - 1) / sample, [&](int job, Part& part) {
            const auto end = std::min(surface.triangles.size(), (static_cast<std::size_t>(job) + 1) * chunk * sample);
            for (std::size_t t = static_cast<std::size_t>(job) * chunk * sample; t < end; t += sample)
                measure(part, t, most);
        }));
    const double widest = sampled.size() < wall_triangles ? most : sampled.back().thickness;
    const std::vector<Part> parts = run_parts(jobs_of(surface), [&](int job, Part& part) {
        const std::size_t first = static_cast<std::size_t>(job) * chunk,
                          last = std::min(surface.triangles.size(), first + chunk);
        for (std::size_t t = first; t < last; ++t) measure(part, t, widest);
    });
    Walls walls;
    TaperLists tapers;
    for (const Part& part : parts) tapers.add(part.tapers);
    std::vector<ThinWall> thinnest = thicker_of(parts);
    if (std::ranges::any_of(parts, [](const Part& part) { return !part.thin.empty(); })) {
        for (const Part& part : parts) walls.balls.insert(walls.balls.end(), part.balls.begin(), part.balls.end());
        const NearPoints near(walls.balls, 0.5 * limit);
        for (const Part& part : parts)
            for (std::size_t n = 0; n < part.thin.size(); ++n) {
                const ThinWall& wall = part.thin[n];
                if (near.is_any_near(wall.at)) continue;
                walls.thin.push_back(wall);
                tapers.add({wall.thickness * std::cos(0.5 * part.angles[n]), part.angles[n], wall.at});
            }
        if (walls.thin.empty()) walls.balls.clear();
        for (const ThinWall& wall : walls.thin) keep_thinnest(thinnest, wall);
    }
    if (thinnest.size() == wall_triangles) walls.thinnest = thinnest.back();
    walls.tapers = tapers.thinnest();
    return walls;
}

Seat seat_of(const geometry::TriangleSurface& guide, const geometry::TriangleTree& bone, const Vec3& removal,
             double offset, double gap, double free_path, const RunJobs& run) {
    struct Part {
        double contact = 0.0, relieved = 0.0, least = infinity;
        bool is_free = true;
        Vec3 blocked{0.0};
        std::vector<Facet> facets;
    };
    std::vector<Part> parts(static_cast<std::size_t>(jobs_of(guide)));
    run(jobs_of(guide), [&](int job) {
        Part& part = parts[static_cast<std::size_t>(job)];
        int count = 0;
        each_of(guide, job, [&](const Facet& f) {
            const auto near = bone.nearest(f.middle, farthest_relief);
            part.least = std::min(part.least, near.distance);
            if (near.distance < farthest_relief && glm::dot(f.normal, near.point - f.middle) > facing * near.distance) {
                if (std::abs(near.distance - offset) <= contact_margin) {
                    part.contact += f.area;
                    part.facets.push_back(f);
                } else {
                    part.relieved += f.area;
                }
            }
            // Facets are far smaller than what blocks a guide.
            if (count++ % 4 != 0 || !part.is_free) return;
            if (bone.sweep(f.middle, free_path * removal, 0.02 * mm) < 1.0)
                part.is_free = false, part.blocked = f.middle;
        });
    });
    Seat seat;
    seat.min_distance = infinity;
    Vec3 middle(0.0);
    for (const Part& part : parts) {
        seat.contact_area += part.contact, seat.relieved_area += part.relieved;
        seat.min_distance = std::min(seat.min_distance, part.least);
        if (!part.is_free && seat.is_path_free) seat.is_path_free = false, seat.blocked_at = part.blocked;
        for (const Facet& f : part.facets) middle += f.area * f.middle;
    }
    seat.play = max_play, seat.play_angle = max_play_angle;
    if (!(seat.contact_area > 0.0)) return seat;
    middle /= seat.contact_area;
    double spread = 0.0;
    for (const Part& part : parts)
        for (const Facet& f : part.facets) spread += f.area * glm::dot(f.middle - middle, f.middle - middle);
    const double size = std::sqrt(spread / seat.contact_area);
    if (!(size > 0.0)) return seat;
    std::array<double, 36> m{};
    for (const Part& part : parts)
        for (const Facet& f : part.facets) {
            const Vec3 turn = glm::cross(f.middle - middle, f.normal) / size;
            const std::array<double, 6> row{f.normal.x, f.normal.y, f.normal.z, turn.x, turn.y, turn.z};
            for (std::size_t i = 0; i < 6; ++i)
                for (std::size_t j = 0; j < 6; ++j) m[6 * i + j] += f.area / seat.contact_area * row[i] * row[j];
        }
    const auto stiff = geometry::symmetric_eigen<6>(m);
    std::array<double, 9> move{}, turn{};
    for (std::size_t k = 0; k < 6; ++k) {
        const double inverse = 1.0 / std::max(stiff.value[k], 1e-7);
        const auto& e = stiff.vector[k];
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                move[3 * i + j] += inverse * e[i] * e[j];
                turn[3 * i + j] += inverse * e[3 + i] * e[3 + j];
            }
    }
    const auto moves = geometry::symmetric_eigen<3>(move), turns = geometry::symmetric_eigen<3>(turn);
    seat.play = std::min(max_play, gap * std::sqrt(moves.value[2]));
    seat.play_direction = Vec3(moves.vector[2][0], moves.vector[2][1], moves.vector[2][2]);
    seat.play_angle = std::min(max_play_angle, gap / size * std::sqrt(turns.value[2]));
    return seat;
}

SlotFit refit_slot(const geometry::TriangleSurface& surface, const MadeSlot& slot) {
    // Faces of the walls: triangles near the plane that look into the slot.
    struct Sum {
        double weight = 0.0;
        Vec3 mean{0.0};
        std::array<double, 9> m{};
    };
    constexpr double flat = 0.99;  // cosine of 8°: triangles that lean more belong to the edge of a wall
    const Vec3 n = slot.cut.plane.normal;
    std::vector<std::pair<Vec3, double>> kept, other;
    for (const auto& t : surface.triangles) {
        const auto at = [&](std::size_t c) { return surface.vertices[static_cast<std::size_t>(t[c])]; };
        const Vec3 cross = glm::cross(at(1) - at(0), at(2) - at(0));
        const double area = glm::length(cross);
        if (!(area > 0.0)) continue;
        const Vec3 normal = cross / area, middle = (at(0) + at(1) + at(2)) / 3.0, from = middle - slot.middle;
        const double out = glm::dot(middle - slot.cut.plane.origin, n);
        if (std::abs(glm::dot(from, slot.deep)) > 0.55 * slot.depth ||
            std::abs(glm::dot(from, slot.wide)) > 0.6 * slot.length)
            continue;
        if (std::abs(out) < 0.3 * slot.width && glm::dot(normal, n) > flat) kept.emplace_back(middle, area);
        if (std::abs(out - slot.width) < 0.3 * slot.width && glm::dot(normal, n) < -flat)
            other.emplace_back(middle, area);
    }
    const auto fit = [](const std::vector<std::pair<Vec3, double>>& points) {
        Sum sum;
        for (const auto& [p, w] : points) sum.weight += w, sum.mean += w * p;
        if (sum.weight > 0.0) sum.mean /= sum.weight;
        for (const auto& [p, w] : points)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    sum.m[static_cast<std::size_t>(3 * i + j)] += w * (p - sum.mean)[i] * (p - sum.mean)[j];
        return sum;
    };
    const Sum wall = fit(kept), opposite_wall = fit(other);
    SlotFit found;
    found.kept_area = 0.5 * wall.weight, found.other_area = 0.5 * opposite_wall.weight;
    if (kept.size() < 20) {
        found.offset = found.angle = infinity;  // the wall on the kept side is missing
        return found;
    }
    const auto eigen = geometry::symmetric_eigen<3>(wall.m);
    const Vec3 normal(eigen.vector[0][0], eigen.vector[0][1], eigen.vector[0][2]);
    found.offset = glm::dot(wall.mean - slot.cut.plane.origin, n);
    found.angle = std::asin(std::min(1.0, glm::length(glm::cross(normal, n))));
    if (other.size() >= 20 && slot.sides != Sides::one) found.width = glm::dot(opposite_wall.mean - wall.mean, n);
    return found;
}

double hole_wall(const geometry::TriangleTree& tree, const MadeHole& hole) {
    constexpr int directions = 24;
    // m: of the mesh from the cylinder, from its wall into the solid, and the radius of a ball that replaces a line.
    constexpr double slack = 0.1 * mm, step = 0.01 * mm, line = 1e-6 * mm;
    const Vec3 u = glm::normalize(
                   glm::cross(hole.axis, std::abs(hole.axis.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0))),
               v = glm::cross(hole.axis, u);
    double least = max_measured_wall;
    for (int k = 0; k < directions; ++k) {
        const double angle = 2.0 * pi * k / directions;
        const Vec3 out = std::cos(angle) * u + std::sin(angle) * v;
        const double rim = (hole.radius + slack) * tree.sweep(hole.middle, (hole.radius + slack) * out, line);
        if (!(rim < hole.radius + slack)) return 0.0;
        const Vec3 from = hole.middle + (rim + step) * out;
        const double rest = max_measured_wall * tree.sweep(from, max_measured_wall * out, line);
        least = std::min(least, step + rest);
    }
    return least;
}

double overhang_share(const geometry::TriangleSurface& surface, const Vec3& up, double angle) {
    double lowest = infinity, all = 0.0, hanging = 0.0;
    for (const Vec3& v : surface.vertices) lowest = std::min(lowest, glm::dot(v, up));
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Facet f = facet(surface, t);
        all += f.area;
        if (glm::dot(f.middle, up) < lowest + 0.3 * mm) continue;
        if (glm::dot(f.normal, up) < -std::sin(angle)) hanging += f.area;
    }
    return all > 0.0 ? hanging / all : 0.0;
}

}  // namespace tactus::cutting_guide
