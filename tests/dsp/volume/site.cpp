// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/site.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

struct Made {
    volume::Grid distance, density;
};

/// A bone of one density from its distance function, in a box of half widths `half` at 1 mm.
template <class Distance>
Made make(const Vec3& half, Distance&& distance, double spacing = 1e-3) {
    Made made;
    volume::Grid& grid = made.distance;
    grid.spacing = Vec3(spacing);
    grid.origin = -half;
    for (std::size_t a = 0; a < 3; ++a)
        grid.size[a] = static_cast<int>(std::lround(2.0 * half[static_cast<int>(a)] / spacing)) + 1;
    grid.values.resize(grid.count());
    made.density = grid;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const double d = distance(grid.position(i, j, k));
                grid.at(i, j, k) = static_cast<float>(d);
                made.density.at(i, j, k) = d < 0.0 ? 1700.0f : 0.0f;
            }
    return made;
}

double box(const Vec3& p, const Vec3& half) {
    const Vec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

std::optional<volume::SawSite> find(const Made& made) { return volume::find_saw_site(made.distance, made.density); }

}  // namespace

TEST_CASE("a bar is cut across: square to a face, with the blade over its width") {
    const auto site = find(make(Vec3(45e-3, 30e-3, 30e-3), [](const Vec3& p) { return box(p, {30e-3, 6e-3, 9e-3}); }));
    REQUIRE(site);
    CHECK(std::abs(site->feed.x) < 0.05);
    CHECK(std::max(std::abs(site->feed.y), std::abs(site->feed.z)) > 0.99);
    CHECK(std::abs(site->stroke.x) < 0.05);
    CHECK(glm::dot(site->feed, site->stroke) == Approx(0.0).margin(1e-9));
    CHECK((std::abs(site->thickness - 12e-3) < 1.5e-3 || std::abs(site->thickness - 18e-3) < 1.5e-3));
    CHECK(std::abs(box(site->point, {30e-3, 6e-3, 9e-3})) < 0.3e-3);
}

TEST_CASE("a shell with a cavity that a blade would fit into is cut from outside") {
    const auto shell = [](const Vec3& p) { return std::abs(glm::length(p * Vec3(1.0, 1.1, 1.0)) - 65e-3) - 3e-3; };
    const auto site = find(make(Vec3(80e-3), shell, 1.25e-3));
    REQUIRE(site);
    CHECK(glm::dot(site->feed, site->point) < 0.0);
    CHECK(glm::length(site->point) > 60e-3);
    CHECK(site->thickness == Approx(6e-3).margin(1.5e-3));
}

TEST_CASE("the blade keeps clear of a bone that stands beside the one to be cut") {
    // Two bars; between them, and across the top of both, there is no room for a blade.
    const auto bars = [](const Vec3& p) {
        return std::min(box(p, {25e-3, 5e-3, 6e-3}), box(p - Vec3(0.0, 22e-3, 8e-3), {25e-3, 5e-3, 14e-3}));
    };
    const auto site = find(make(Vec3(45e-3, 60e-3, 45e-3), bars));
    REQUIRE(site);
    for (double t = -30e-3; t <= 30e-3; t += 1e-3)
        for (const double height : {1.5e-3, 4e-3, 8e-3})
            CHECK(bars(site->point - site->feed * height + site->stroke * t) > 0.3e-3);
}

TEST_CASE("the flat face where the scan ends is no place for a cut") {
    const auto cut = [](const Vec3& p) {
        return std::max(glm::length(Vec3(p.x, p.y, 0.0)) - 8e-3, std::abs(p.z) - 26e-3);
    };
    const auto site = find(make(Vec3(30e-3), cut));
    REQUIRE(site);
    CHECK(std::abs(site->feed.z) < 0.3);
    CHECK(std::abs(site->point.z) < 24e-3);
}

TEST_CASE("the same bone gives the same site to the last bit") {
    const auto bone = make(Vec3(30e-3), [](const Vec3& p) { return glm::length(p) - 10e-3; });
    const auto a = find(bone), b = find(bone);
    REQUIRE(a);
    CHECK(a->point == b->point);
    CHECK(a->stroke == b->stroke);
    CHECK(glm::dot(a->feed, glm::normalize(a->point)) < -0.99);
}

TEST_CASE("where there is no bone, or no way to it, there is no site") {
    CHECK_FALSE(find(make(Vec3(20e-3), [](const Vec3&) { return 1.0; })));
    CHECK_FALSE(find(make(Vec3(20e-3), [](const Vec3&) { return -1.0; })));
    const auto walled = [](const Vec3& p) {
        return std::min(glm::length(p) - 5e-3, std::abs(glm::length(p) - 30e-3) - 8e-3);
    };
    const auto site = find(make(Vec3(45e-3), walled));
    REQUIRE(site);
    CHECK(glm::length(site->point) > 30e-3);
}

TEST_CASE("a plain block in a grid that ends close around it has a site") {
    for (const Vec3& half : {Vec3(15e-3), Vec3(30e-3, 15e-3, 7.5e-3)}) {
        const auto site = find(make(half + Vec3(4e-3), [half](const Vec3& p) { return box(p, half); }));
        REQUIRE(site);
        CHECK(std::abs(box(site->point, half)) < 0.5e-3);
        CHECK(glm::dot(site->feed, site->point) < 0.0);
    }
}

TEST_CASE("a rib cage is sawn from outside") {
    // A ring of 8 mm thick bone, open at both ends: its inside faces are reached through the ends.
    const auto ring = [](const Vec3& p) {
        return std::max(std::abs(std::hypot(p.x, p.y) - 60e-3) - 4e-3, std::abs(p.z) - 20e-3);
    };
    const auto site = find(make(Vec3(90e-3, 90e-3, 70e-3), ring, 1.5e-3));
    REQUIRE(site);
    CHECK(glm::dot(site->feed, site->point) < 0.0);
}

TEST_CASE("a plate with thin processes, as a sternum with ribs, is cut in the middle of the plate") {
    // A plate of 120 by 36 mm, 11 mm thick, and five bars on each side, which are narrower and as good for a blade.
    const auto sternum = [](const Vec3& p) {
        double d = box(p, {60e-3, 18e-3, 5.5e-3});
        for (const double x : {-48e-3, -24e-3, 0.0, 24e-3, 48e-3})
            for (const double side : {-1.0, 1.0})
                d = std::min(d, box(p - Vec3(x, side * 30e-3, 0.0), {5e-3, 14e-3, 5e-3}));
        return d;
    };
    for (const double spacing : {1e-3, 1.5e-3}) {
        const auto site = find(make(Vec3(90e-3, 75e-3, 40e-3), sternum, spacing));
        REQUIRE(site);
        CAPTURE(spacing, site->point.x, site->point.y, site->point.z);
        CHECK(std::abs(site->point.y) < 4e-3);
        CHECK(std::abs(site->point.x) < 42e-3);
        CHECK(std::abs(site->feed.z) > 0.95);
    }
}

TEST_CASE("a blade rests clear of all bone in front of a site, as between two humps") {
    const auto valley = [](const Vec3& p) {
        return std::min({box(p, {40e-3, 8e-3, 6e-3}), box(p - Vec3(18e-3, 0.0, 10e-3), {4e-3, 8e-3, 6e-3}),
                         box(p + Vec3(18e-3, 0.0, -10e-3), {4e-3, 8e-3, 6e-3})});
    };
    const Made bone = make(Vec3(60e-3, 30e-3, 40e-3), valley);
    const auto site =
        volume::saw_site_at(bone.distance, bone.density, {0.0, 0.0, 30e-3}, {0.0, 0.0, -1.0}, {1.0, 0.0, 0.0});
    REQUIRE(site);
    CHECK(site->point.z == Approx(6e-3).margin(0.3e-3));
    // The humps are 10 mm higher than the site.
    CHECK(volume::resting_clearance(bone.distance, *site, 5e-3) == Approx(11e-3).margin(1e-3));
    const auto across =
        volume::saw_site_at(bone.distance, bone.density, {0.0, 0.0, 30e-3}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0});
    REQUIRE(across);
    CHECK(volume::resting_clearance(bone.distance, *across, 5e-3) == 5e-3);
}

TEST_CASE("a wire in a bone is no place for a cut") {
    const auto plate = [](const Vec3& p) { return box(p, {40e-3, 14e-3, 5e-3}); };
    const auto wire = [](const Vec3& p) { return std::hypot(p.x, p.z - 6.5e-3) - 3e-3; };
    Made made = make(Vec3(60e-3, 40e-3, 35e-3),
                     [&](const Vec3& p) { return std::min(plate(p), std::max(wire(p), std::abs(p.y) - 14e-3)); });
    for (int k = 0; k < made.density.size[2]; ++k)
        for (int j = 0; j < made.density.size[1]; ++j)
            for (int i = 0; i < made.density.size[0]; ++i)
                if (wire(made.density.position(i, j, k)) < 0.0) made.density.at(i, j, k) = 3000.0f;
    const auto site = find(made);
    REQUIRE(site);
    CAPTURE(site->point.x, site->point.y, site->point.z);
    CHECK(wire(site->point) > 0.5e-3);
    CHECK(std::abs(plate(site->point)) < 0.5e-3);
}

TEST_CASE("a site is chosen by a point and a direction") {
    const Vec3 half(30e-3, 6e-3, 9e-3);
    const Made bar = make(Vec3(45e-3, 30e-3, 30e-3), [half](const Vec3& p) { return box(p, half); });
    const auto at = [&](const Vec3& point, const Vec3& approach) {
        return volume::saw_site_at(bar.distance, bar.density, point, approach);
    };
    const auto straight = at({10e-3, 0.0, 40e-3}, {0.0, 0.0, -2.0});
    REQUIRE(straight);
    CHECK(glm::length(straight->point - Vec3(10e-3, 0.0, 9e-3)) < 0.3e-3);
    CHECK(straight->feed == Vec3(0.0, 0.0, -1.0));
    CHECK(std::abs(straight->stroke.y) > 0.99);  // over the narrow side
    CHECK(straight->thickness == Approx(18e-3).margin(1e-3));
    // From inside the bone the line is followed back to where it enters.
    CHECK(glm::length(at({10e-3, 0.0, 0.0}, {0.0, 0.0, -1.0})->point - straight->point) < 0.3e-3);
    const auto nearest = at({-5e-3, 20e-3, 1e-3}, Vec3(0.0));
    REQUIRE(nearest);
    CHECK(glm::length(nearest->point - Vec3(-5e-3, 6e-3, 1e-3)) < 0.5e-3);
    CHECK(nearest->feed.y < -0.99);
    // The stroke can be given; what it has along the approach does not count.
    const auto given =
        volume::saw_site_at(bar.distance, bar.density, {10e-3, 0.0, 40e-3}, {0.0, 0.0, -2.0}, {3.0, 0.0, 1.0});
    REQUIRE(given);
    CHECK(glm::length(given->stroke - Vec3(1.0, 0.0, 0.0)) < 1e-9);
    CHECK(given->point == straight->point);
    CHECK(given->feed == straight->feed);
    CHECK(given->width > 30e-3);
    CHECK_THROWS_AS(
        volume::saw_site_at(bar.distance, bar.density, {10e-3, 0.0, 40e-3}, {0.0, 0.0, -2.0}, {0.1, 0.0, -1.0}), Error);
    // A point far from the bone names no place on it.
    CHECK_FALSE(at({0.0, 500e-3, 0.0}, Vec3(0.0)));
}

TEST_CASE("a coarse bone is resampled around a site") {
    const Vec3 half(30e-3, 6e-3, 9e-3);
    const Made bar = make(Vec3(45e-3, 30e-3, 30e-3), [half](const Vec3& p) { return box(p, half); });
    const auto site = volume::saw_site_at(bar.distance, bar.density, {0.0, 0.0, 40e-3}, {0.0, 0.0, -1.0});
    REQUIRE(site);
    const volume::SiteVolume fine = volume::refine_at(*site, bar.distance, bar.density, 0.33e-3);
    CHECK(fine.distance.size == fine.density.size);
    double worst = 0.0;
    for (int k = 0; k < fine.distance.size[2]; k += 3)
        for (int j = 0; j < fine.distance.size[1]; j += 3)
            for (int i = 0; i < fine.distance.size[0]; i += 3) {
                const Vec3 p = fine.distance.position(i, j, k);
                if (std::abs(p.x) > 15e-3) continue;
                worst = std::max(worst, std::abs(static_cast<double>(fine.distance.at(i, j, k)) - box(p, half)));
            }
    CHECK(worst < 0.25e-3);  // at the edges; a cell of the coarse grid is 1 mm
    CHECK_THROWS_AS(volume::refine_at(*site, bar.distance, bar.density, 0.05e-3), Error);
}
