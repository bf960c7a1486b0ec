// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/voxmap.hpp"

#include "dsp/core/error.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/support/catch.hpp"

#include <limits>

using namespace tactus;

TEST_CASE(
    "a voxmap reads a linear field exactly, value and gradient, trilinear and quadratic, also with oblong cells") {
    const Vec3 slope(0.3, -0.5, 0.8);
    const volume::Grid layout{{9, 12, 7}, Vec3(-0.01, 0.02, 0.005), Vec3(1e-3, 0.7e-3, 2e-3), {}};
    const contact::Voxmap map = contact::sample_voxmap(layout, [&](const Vec3& p) { return glm::dot(slope, p) + 0.1; });
    const Random random{4};
    for (std::uint64_t n = 0; n < 200; ++n) {
        // The spline repeats the border, so it is linear only one cell away from it.
        const Vec3 share(random.uniform(3 * n), random.uniform(3 * n + 1), random.uniform(3 * n + 2));
        const Vec3 p = layout.origin + (1.0 + share * Vec3(6.0, 9.0, 4.0)) * layout.spacing;
        for (const volume::Sample& sample : {map.sample(p), map.smooth_sample(p)}) {
            REQUIRE(sample.inside);
            CHECK(sample.value == Approx(glm::dot(slope, p) + 0.1).epsilon(1e-6));
            CHECK(glm::length(sample.gradient - slope) < 3e-5);
        }
    }
}

TEST_CASE("a voxmap's gradients are the derivatives of its values") {
    const contact::Voxmap map = bodies::rough_ball(40, 1e-3, 0.012);
    const Random random{5};
    for (std::uint64_t n = 0; n < 1000; ++n) {
        const auto u = [&](std::uint64_t k) { return 0.034 * (random.uniform(3 * n + k) - 0.5); };
        const Vec3 p(u(0), u(1), u(2));
        const double h = 1e-8;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step(0.0);
            step[axis] = h;
            // Within one cell a trilinear interpolant is linear along each axis; skip steps that leave it.
            const Vec3 cell = (p - map.grid.origin) / map.grid.spacing;
            const double share = cell[axis] - std::floor(cell[axis]);
            if (share > 1e-4 && share < 1.0 - 1e-4)
                CHECK(map.sample(p).gradient[axis] ==
                      Approx((map.sample(p + step).value - map.sample(p - step).value) / (2.0 * h)).margin(1e-7));
            CHECK(map.smooth_sample(p).gradient[axis] ==
                  Approx((map.smooth_sample(p + step).value - map.smooth_sample(p - step).value) / (2.0 * h))
                      .margin(1e-6));
        }
    }
}

TEST_CASE("outside of its grid, and at no place at all, a voxmap reads far") {
    const contact::Voxmap map = bodies::ball(20, 1e-3, 0.005);
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    for (const Vec3& p : {Vec3(0.0096, 0, 0), Vec3(0, -1.0, 0), Vec3(nan, 0, 0), Vec3(0, infinite, 0), Vec3(1e300)}) {
        for (const volume::Sample& sample : {map.sample(p), map.smooth_sample(p)}) {
            CHECK_FALSE(sample.inside);
            CHECK(sample.value == map.far);
            CHECK(sample.gradient == Vec3(0.0));
        }
    }
    CHECK(map.sample(Vec3(0.0095)).inside);
    CHECK(map.far >= map.sample(Vec3(0.0095)).value);
    CHECK(contact::Voxmap{}.sample(Vec3(0.0)).value == 1.0);
    CHECK(contact::Voxmap{}.smooth_sample(Vec3(0.0)).inside == false);
}

TEST_CASE("nothing within a radius reads less than the bound that culling uses") {
    const contact::Voxmap exact = bodies::rough_ball(40, 1e-3, 0.010);
    const contact::Voxmap plain = bodies::ball(40, 1e-3, 0.010);
    const contact::Voxmap chamfer = contact::make_voxmap(contact::chamfer_distance(exact.grid));
    const Random random{6};
    for (std::uint64_t n = 0; n < 2000; ++n) {
        const auto u = [&](std::uint64_t k) { return 2.0 * random.uniform(8 * n + k) - 1.0; };
        const Vec3 p = 0.03 * Vec3(u(0), u(1), u(2));
        const double radius = 0.006 * random.uniform(8 * n + 3);
        const Vec3 q = p + radius * random.uniform(8 * n + 7) * glm::normalize(Vec3(u(4), u(5), u(6)));
        for (const contact::Voxmap* map : {&exact, &chamfer}) {
            const double least = map->min_within(p, radius);
            CHECK(least <= map->sample(q).value);
            CHECK(least <= map->smooth_sample(q).value);
        }
        // And for a true distance it is worth something: within 1.13 times the radius and three cells of the value.
        const volume::Sample here = plain.sample(p);
        if (here.inside) CHECK(plain.min_within(p, radius) > here.value - 1.13 * radius - 3.0e-3);
    }
}

TEST_CASE("the 3-4-5 distance of a ball errs as its weights say, near the surface by half a cell") {
    const double h = 1e-3, radius = 0.012;
    const volume::Grid chamfer = contact::chamfer_distance(bodies::ball(48, h, radius).grid);
    double most = 0.0;
    for (int k = 0; k < 48; ++k)
        for (int j = 0; j < 48; ++j)
            for (int i = 0; i < 48; ++i) {
                const double d = glm::length(chamfer.position(i, j, k)) - radius;
                const double error = std::abs(static_cast<double>(chamfer.at(i, j, k)) - d);
                most = std::max(most, error - 0.1055 * std::abs(d));
            }
    CHECK(most < h);
    // Along an axis steps are exact to the half cell.
    CHECK(static_cast<double>(chamfer.at(47, 23, 23)) == Approx(23.5e-3 - radius).margin(0.6 * h));
    volume::Grid oblong = contact::centred_layout(8, h);
    oblong.spacing.z *= 1.5;
    oblong.values.resize(oblong.count());
    CHECK_THROWS_AS(contact::chamfer_distance(oblong), Error);
}

TEST_CASE("a voxmap refuses grids that are no field") {
    volume::Grid grid = bodies::ball(8, 1e-3, 0.002).grid;
    volume::Grid broken = grid;
    broken.values[17] = std::numeric_limits<float>::infinity();
    CHECK_THROWS_AS(contact::make_voxmap(broken), Error);
    broken = grid;
    broken.values.pop_back();
    CHECK_THROWS_AS(contact::make_voxmap(broken), Error);
    broken = grid;
    broken.spacing.y = 0.0;
    CHECK_THROWS_AS(contact::make_voxmap(broken), Error);
    CHECK_THROWS_AS(contact::make_voxmap(volume::Grid{{1, 8, 8}, Vec3(0.0), Vec3(1e-3), std::vector<float>(64, 0.0f)}),
                    Error);
}

TEST_CASE("a voxmap of a bone reads what the bone reads near its surface") {
    const volume::Grid grid = bodies::ball(50, 0.5e-3, 0.008).grid;
    const volume::BoneEditor bone(grid, grid, {.band = 0.002, .max_dirty = 1, .max_versions = 1});
    const contact::Voxmap map = contact::make_voxmap(bone.current());
    CHECK(map.far == 0.002);
    CHECK(map.steepness < 1.3);
    for (int i = 0; i < 100; ++i) {
        const Vec3 p = glm::normalize(Vec3(std::sin(i), std::cos(2.0 * i), std::sin(3.0 * i))) * (0.007 + i * 1e-5);
        CHECK(map.sample(p).value == bone.current().sample(p).value);
        CHECK(map.sample(p).gradient == bone.current().sample(p).gradient);
        CHECK(map.smooth_sample(p).value == bone.current().smooth_sample(p).value);
    }
}
