// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/site.hpp"
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
