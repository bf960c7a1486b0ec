// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/registration/registration.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/fit/registration/mirror.hpp"
#include "dsp/fit/registration/point_registration.hpp"
#include "dsp/geometry/main_axes.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

/// A lump without any symmetry, about 30 mm across: points and normals by formula.
Vec3 lump(double u, double v) {
    const Vec3 d(std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v));
    const double r = 12.0 + 4.0 * d.x + 3.0 * d.y * d.z + 2.5 * std::sin(3.0 * u) * std::sin(v) + 5.0 * d.z * d.z +
                     1.5 * std::cos(2.0 * v + u);
    return r * mm * d;
}

std::vector<contact::SurfacePoint> lump_points(int rows, double from = 0.15) {
    std::vector<contact::SurfacePoint> points;
    const double dv = (std::numbers::pi - 2.0 * from) / rows;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 2 * rows; ++j) {
            const double v = from + dv * (i + 0.5), u = std::numbers::pi * j / rows, h = 1e-5;
            const Vec3 across = glm::cross(lump(u, v + h) - lump(u, v - h), lump(u + h, v) - lump(u - h, v));
            points.push_back({lump(u, v), glm::normalize(across), glm::length(across) / (4.0 * h * h) * dv * dv, 0});
        }
    return points;
}

std::vector<contact::SurfacePoint> moved(std::vector<contact::SurfacePoint> points, const Pose& pose) {
    for (contact::SurfacePoint& p : points) p = {pose.apply(p.position), pose.rotate(p.normal), p.area, p.label};
    return points;
}

double off(const Pose& found, const Pose& truth) {
    double most = 0.0;
    for (const Vec3& corner : {Vec3(15.0, 0.0, 0.0), Vec3(0.0, 15.0, 0.0), Vec3(0.0, 0.0, -15.0)})
        most = std::max(most, glm::length(found.apply(corner * mm) - truth.apply(corner * mm)));
    return most;
}

/// Distances of a ball of radius 10 mm, 0.4 mm apart.
volume::Grid ball(const Vec3& centre) {
    volume::Grid grid{{71, 71, 71}, centre - Vec3(14.0 * mm), Vec3(0.4 * mm), {}};
    for (int k = 0; k < 71; ++k)
        for (int j = 0; j < 71; ++j)
            for (int i = 0; i < 71; ++i)
                grid.values.push_back(static_cast<float>(glm::length(grid.position(i, j, k) - centre) - 10.0 * mm));
    return grid;
}

}  // namespace

TEST_CASE("the tree finds what looking at every point finds") {
    std::vector<Vec3> points;
    const Random random{5};
    for (std::uint64_t n = 0; n < 700; ++n)
        points.emplace_back(random.uniform(3 * n), random.uniform(3 * n + 1), 0.1 * random.uniform(3 * n + 2));
    const geometry::PointTree tree(points);
    for (std::uint64_t n = 0; n < 300; ++n) {
        const Vec3 place(random.normal(n), random.normal(n + 1000), random.normal(n + 2000));
        double least = 1e9;
        for (const Vec3& p : points) least = std::min(least, glm::length(p - place));
        CHECK(glm::length(points[tree.nearest(place)] - place) == least);
    }
}

TEST_CASE("a surface is laid on another sampling of itself from wherever it is", "[slow]") {
    const auto fixed = lump_points(60), moving = lump_points(47, 0.2);
    const fit::RegistrationTarget target(fixed);
    for (const Pose& truth : {Pose{Vec3(40.0, -300.0, 20.0) * mm, rotation_by({2.0, -1.0, 0.5})},
                              Pose{Vec3(-1000.0, 5.0, 0.0) * mm, rotation_by({0.0, 0.0, 3.1})}}) {
        const fit::Registration found = fit::register_from_anywhere(moved(moving, truth.inverse()), fixed, target);
        CHECK(off(found.pose, truth) < 0.1 * mm);
        CHECK(found.median < 0.05 * mm);
        CHECK(found.covered > 0.95);
    }
}

TEST_CASE("a part that is elsewhere does not draw the rest along, is found, and is laid in its place by itself") {
    const auto fixed = lump_points(60);
    auto moving = lump_points(53, 0.2);
    const Pose shift{Vec3(2.5, 1.0, 1.5) * mm, rotation_by({0.0, 0.02, 0.0})},
        start{Vec3(2.0, 1.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    std::size_t shifted = 0;
    for (contact::SurfacePoint& p : moving)
        if (p.position.z > 9.0 * mm) p = moved({p}, shift)[0], ++shifted;
    REQUIRE(shifted > 100);
    const fit::RegistrationTarget target(fixed);
    const fit::Registration bulk = fit::register_surface(moving, target, start, {.widest = 10e-3, .finest = 0.4e-3});
    CHECK(off(bulk.pose, {}) < 0.15 * mm);
    const auto region = fit::displaced_region(moving, bulk.pose, target, 0.8 * mm, 2.5 * mm, 1.0 * mm);
    CHECK(region.size() > shifted / 2);
    std::vector<contact::SurfacePoint> part;
    for (const std::size_t n : region) part.push_back(moving[n]);
    const fit::Registration back = fit::register_surface(part, target, bulk.pose, {.widest = 6e-3, .finest = 0.5e-3});
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : part) middle += p.position / static_cast<double>(part.size());
    CHECK(glm::length(back.pose.apply(middle) - shift.inverse().apply(middle)) < 0.3 * mm);
}

TEST_CASE("the mirror of a body is found from its two sides, and what of one side was moved is put back", "[slow]") {
    // A body that is symmetric about a tilted plane; its right side lies where it was scanned, turned a little.
    const fit::MirrorPlane truth{glm::normalize(Vec3(0.9, 0.3, -0.2)), 55.0 * mm};
    const auto left = lump_points(50);
    const Pose posture{Vec3(1.0, -2.0, 0.5) * mm, rotation_by({0.01, 0.0, 0.02})};
    const auto right = moved(fit::mirrored(lump_points(57, 0.2), truth), posture);
    const fit::MirrorFit fit = fit::fit_mirror(left, right);
    CHECK(fit.registration.median < 0.1 * mm);
    CHECK(glm::dot(fit.plane.normal, truth.normal) > std::cos(0.03));
    CHECK(fit.rotation < 0.04);
    // Together they are the body's own symmetry: corners of the left side come to lie on the right one.
    for (const Vec3& p : {Vec3(10.0, 2.0, 3.0) * mm, Vec3(-4.0, 9.0, -8.0) * mm})
        CHECK(glm::length(fit.pose.apply(fit.plane.reflect(p)) - posture.apply(truth.reflect(p))) < 0.3 * mm);
    CHECK(glm::length(truth.reflect(truth.reflect(Vec3(0.1, 0.2, 0.3))) - Vec3(0.1, 0.2, 0.3)) < 1e-15);
}

TEST_CASE("there is no registration without points") {
    CHECK_THROWS_AS(fit::RegistrationTarget({}), Error);
    const auto fixed = lump_points(10);
    CHECK_THROWS_AS(fit::register_surface({}, fit::RegistrationTarget(fixed), {}), Error);
}

TEST_CASE("gap and overlap of two balls are those of the formula") {
    const volume::Grid still = ball(Vec3(0.0));
    const contact::Voxmap map = contact::make_voxmap(still);
    std::vector<contact::SurfacePoint> points;
    constexpr int rows = 120;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < rows; ++j) {
            const double z = -1.0 + 2.0 * (i + 0.5) / rows, u = 2.0 * std::numbers::pi * j / rows;
            const Vec3 d(z, std::sqrt(1.0 - z * z) * std::cos(u), std::sqrt(1.0 - z * z) * std::sin(u));
            points.push_back({10.0 * mm * d, d, 4.0 * std::numbers::pi * 100.0 * mm * mm / (rows * rows), 0});
        }
    // 21 mm apart: nothing touches, and within 3 mm the surfaces face each other.
    const Pose apart{Vec3(21.0, 0.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    const fit::SurfaceGap open = fit::gap_between(points, apart, map, {});
    CHECK(open.contact_area == 0.0);
    CHECK(open.deepest == 0.0);
    CHECK(open.facing_area > 50e-6);
    CHECK(open.median > 1.0 * mm);
    CHECK(fit::overlap_volume(still, apart, map, {}) == 0.0);
    // 18 mm apart: two caps of 1 mm height. The ring of points nearest to the middle lies 1.82 mm inside.
    const Pose inside{Vec3(18.0, 0.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    const double caps = 2.0 * std::numbers::pi * 1.0 * (3.0 * 10.0 - 1.0) / 3.0 * mm * mm * mm;
    CHECK(fit::overlap_volume(still, inside, map, {}) == Approx(caps).epsilon(0.03));
    const fit::SurfaceGap deep = fit::gap_between(points, inside, map, {});
    CHECK(deep.deepest == Approx(1.82 * mm).epsilon(0.02));
    CHECK(deep.contact_area > 60e-6);
    // 12 mm apart they do not face each other in the middle, and are 8 mm deep there all the same.
    const Pose deeper{Vec3(12.0, 0.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    CHECK(fit::gap_between(points, deeper, map, {}).deepest == Approx(7.8 * mm).epsilon(0.04));
    // Far from the origin the numbers are the same.
    const Pose far{Vec3(1.0, 2.0, -1.0), rotation_by({0.3, 0.2, 0.1})};
    CHECK(fit::overlap_volume(still, far * inside, map, far) == Approx(caps).epsilon(0.03));
    CHECK(fit::gap_between(points, far * inside, map, far).deepest == Approx(deep.deepest).epsilon(1e-6));
}

TEST_CASE("main axes of a turned box are its edges, longest first, and a rotation") {
    const Quat turn = rotation_by({0.4, -1.1, 0.7});
    const Mat3 r = glm::mat3_cast(turn);
    const Mat3 axes = geometry::main_axes(r * Mat3(Vec3(2.0, 0.0, 0.0), Vec3(0.0, 9.0, 0.0), Vec3(0.0, 0.0, 5.0)) *
                                          glm::transpose(r));
    CHECK(std::abs(glm::dot(axes[0], r[1])) == Approx(1.0));
    CHECK(std::abs(glm::dot(axes[1], r[2])) == Approx(1.0));
    CHECK(std::abs(glm::dot(axes[2], r[0])) == Approx(1.0));
    CHECK(glm::determinant(axes) == Approx(1.0));
}

TEST_CASE("where a third of a surface is elsewhere, the place that most of it agrees on is found", "[slow]") {
    const auto fixed = lump_points(60);
    auto moving = lump_points(53, 0.2);
    const Pose shift{Vec3(2.5, 1.0, 1.5) * mm, rotation_by({0.0, 0.03, 0.02})};
    for (contact::SurfacePoint& p : moving)
        if (p.position.z > 3.0 * mm) p = moved({p}, shift)[0];
    const fit::RegistrationTarget target(fixed);
    const fit::Registration bulk =
        fit::register_surface(moving, target, {Vec3(1.0, 2.0, -1.0) * mm, rotation_by({0.02, 0.0, 0.0})},
                              {.widest = 10e-3, .finest = 0.8e-3, .by_parts = true});
    CHECK(off(bulk.pose, {}) < 0.4 * mm);
    // All that moved is told from the rest once its motion is known, also what slid along the surface.
    const auto region = fit::region_nearer(moving, bulk.pose, shift.inverse(), target, 0.1 * mm, 0.5 * mm, 3.0 * mm);
    std::size_t right = 0, moved_points = 0;
    for (const std::size_t n : region) right += shift.inverse().apply(moving[n].position).z > 3.0 * mm;
    for (const contact::SurfacePoint& p : moving) moved_points += shift.inverse().apply(p.position).z > 3.0 * mm;
    CHECK(right > 0.9 * static_cast<double>(region.size()));
    CHECK(right > 0.5 * static_cast<double>(moved_points));
}

TEST_CASE("plain registration of points stops short along a smooth surface, that of surfaces does not") {
    // An ellipsoid that slid along itself by 3 mm: its points lie near others long before they lie on their own.
    const auto ellipsoid = [](int rows) {
        std::vector<contact::SurfacePoint> points;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < 2 * rows; ++j) {
                const double v = std::numbers::pi * (i + 0.5) / rows, u = std::numbers::pi * j / rows;
                const Vec3 d(std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v));
                const Vec3 axes(30.0 * mm, 18.0 * mm, 12.0 * mm);
                points.push_back({axes * d, glm::normalize(d / axes), std::sin(v), 0});
            }
        return points;
    };
    const auto fixed = ellipsoid(40), moving = ellipsoid(37);
    const fit::RegistrationTarget target(fixed);
    const Pose start{Vec3(3.0, 0.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    const fit::PointRegistration points = fit::register_points(moving, target, start);
    const fit::Registration surface = fit::register_surface(moving, target, start, {.widest = 4e-3, .finest = 0.5e-3});
    CHECK(glm::length(surface.pose.position) < 0.2 * mm);
    CHECK(glm::length(points.pose.position) > 2.0 * glm::length(surface.pose.position));
    CHECK(points.to_surface > surface.median);
    CHECK_THROWS_AS(fit::register_points({}, target, {}), Error);
}

namespace {

/// A closed cylinder with rounded ends, 40 mm long; `bump`: height of a lump on one side near one end, m.
std::vector<contact::SurfacePoint> bar_points(int rows, double bump) {
    const auto at = [&](double u, double z) {
        const double end = std::max(0.0, std::abs(z) - 14.0 * mm) / (6.0 * mm);
        const double r = 4.0 * mm * std::sqrt(std::max(0.0, 1.0 - end * end));
        const double swell = bump * std::exp(-std::pow((z - 8.0 * mm) / (4.0 * mm), 2.0)) * std::max(0.0, std::cos(u));
        return Vec3((r + swell) * std::cos(u), (r + swell) * std::sin(u), z);
    };
    std::vector<contact::SurfacePoint> points;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < rows / 2; ++j) {
            const double z = (-19.5 + 39.0 * (i + 0.5) / rows) * mm, u = 2.0 * std::numbers::pi * j / (rows / 2),
                         h = 1e-5;
            const Vec3 across = glm::cross(at(u + h, z) - at(u - h, z), at(u, z + h) - at(u, z - h));
            points.push_back({at(u, z), glm::normalize(across), 1e-6, 0});
        }
    return points;
}

}  // namespace

TEST_CASE("a search from the position in the files finds every pose, and says when another fits as well", "[slow]") {
    const auto fixed = lump_points(40), moving = lump_points(33, 0.2);
    const fit::RegistrationTarget target(fixed);
    const Pose start;
    const Random random{9};
    for (std::uint64_t n = 0; n < 4; ++n) {
        const Vec3 axis =
            glm::normalize(Vec3(random.normal(3 * n), random.normal(3 * n + 1), random.normal(3 * n + 2)));
        const Pose truth{Vec3(5.0, -10.0 * double(n), 3.0) * mm,
                         rotation_by(axis * (0.5 * std::numbers::pi + 0.5 * double(n)))};
        // Another person's: a little larger.
        auto other = moved(moving, truth.inverse());
        if (n % 2 == 1)
            for (contact::SurfacePoint& p : other) p.position *= 1.03;
        const fit::JudgedRegistration found = fit::search_registration(other, fixed, target, &start);
        CAPTURE(n, found.score, found.rivals.empty() ? 0.0 : found.rivals.front().score);
        CHECK(found.verdict == fit::RegistrationVerdict::fit);
        CHECK(off(found.best.pose, truth) < (n % 2 == 1 ? 6.0 : 0.2) * mm);
    }
}

TEST_CASE("a bar without a mark is ambiguous, one with a lump is not, whatever end comes first", "[slow]") {
    const Pose turn{Vec3(0.0, 0.0, 0.0), rotation_by({std::numbers::pi, 0.0, 0.0})}, start;
    for (const double bump : {0.0, 2.0 * mm}) {
        const auto fixed = bar_points(40, bump), moving = moved(bar_points(34, bump), turn.inverse());
        const fit::JudgedRegistration found =
            fit::search_registration(moving, fixed, fit::RegistrationTarget(fixed), &start);
        CAPTURE(bump, found.score, found.rivals.empty() ? 0.0 : found.rivals.front().score);
        if (bump == 0.0) {
            CHECK(found.verdict == fit::RegistrationVerdict::ambiguous);
            CHECK_FALSE(found.rivals.empty());
        } else {
            CHECK(found.verdict == fit::RegistrationVerdict::fit);
            CHECK(off(found.best.pose, turn) < 0.3 * mm);
        }
    }
}
