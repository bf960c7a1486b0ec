// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/bricks.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tactus;

namespace {

volume::Grid sphere_grid(std::array<int, 3> size, const Vec3& spacing, double radius) {
    volume::Grid grid{size, Vec3(-0.5) * spacing * Vec3(size[0] - 1, size[1] - 1, size[2] - 1), spacing, {}};
    grid.values.resize(grid.count());
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i)
                grid.at(i, j, k) = static_cast<float>(glm::length(grid.position(i, j, k)) - radius);
    return grid;
}

volume::Grid constant_like(const volume::Grid& like, float value) {
    volume::Grid grid = like;
    std::ranges::fill(grid.values, value);
    return grid;
}

/// The same interpolation on the dense grid.
double dense_value(const volume::Grid& grid, const Vec3& p) {
    const Vec3 at = (p - grid.origin) / grid.spacing;
    const int i = std::min(static_cast<int>(at.x), grid.size[0] - 2),
              j = std::min(static_cast<int>(at.y), grid.size[1] - 2),
              k = std::min(static_cast<int>(at.z), grid.size[2] - 2);
    const double x = at.x - i, y = at.y - j, z = at.z - k;
    double sum = 0.0;
    for (int c = 0; c < 8; ++c)
        sum += (c & 1 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 4 ? z : 1 - z) *
               static_cast<double>(grid.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)));
    return sum;
}

Vec3 random_point(const Random& random, std::uint64_t i, double half) {
    return Vec3(random.uniform(3 * i), random.uniform(3 * i + 1), random.uniform(3 * i + 2)) * (2.0 * half) -
           Vec3(half);
}

}  // namespace

TEST_CASE("bricks interpolate as the dense grid does, and the gradient is that of the interpolant") {
    const volume::Grid grid = sphere_grid({37, 41, 25}, Vec3(0.35e-3, 0.35e-3, 0.6e-3), 0.004);
    const volume::BoneEditor editor(grid, constant_like(grid, 1800.0f),
                                    {.band = 1.0, .max_dirty = 8, .max_versions = 2});
    const volume::BoneSnapshot bone = editor.current();
    const Random random{3};
    for (std::uint64_t i = 0; i < 5000; ++i) {
        const Vec3 p = random_point(random, i, 0.0062);
        const volume::Sample s = bone.sample(p);
        REQUIRE(s.inside);
        CHECK(s.value == Approx(dense_value(grid, p)).margin(1e-12));
        CHECK(s.value == Approx(bone.value(p)).margin(1e-15));
        CHECK(bone.density(p) == Approx(1800.0));
        // Within one cell the interpolant is cubic at most: a central difference is exact to rounding.
        const double h = 1e-9;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step(0.0);
            step[axis] = h;
            const double slope = (bone.value(p + step) - bone.value(p - step)) / (2 * h);
            CHECK(s.gradient[axis] == Approx(slope).margin(0.02));
        }
    }
}

TEST_CASE("outside of the grid, far from the bone and at no number everything is far") {
    const volume::Grid grid = sphere_grid({65, 65, 65}, Vec3(0.5e-3), 0.004);
    const volume::BoneEditor editor(grid, constant_like(grid, 1.0f),
                                    {.band = 0.002, .max_dirty = 8, .max_versions = 2});
    for (const Vec3& p :
         {Vec3(1.0, 0.0, 0.0), Vec3(0.0159, 0.0159, 0.0159), Vec3(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0),
          Vec3(0.0, -std::numeric_limits<double>::infinity(), 0.0)}) {
        const volume::Sample s = editor.current().sample(p);
        CHECK_FALSE(s.inside);
        CHECK(s.value == 0.002);
        CHECK(s.gradient == Vec3(0.0));
        CHECK(editor.current().density(p) == 0.0);
    }
}

TEST_CASE("after random edits every brick agrees with a dense copy, borders included") {
    volume::Grid grid = sphere_grid({30, 33, 26}, Vec3(0.4e-3), 0.004);
    volume::BoneEditor editor(grid, constant_like(grid, 1.0f), {.band = 1.0, .max_dirty = 80, .max_versions = 3});
    const Random random{11};
    for (std::uint64_t n = 0; n < 3000; ++n) {
        const int i = static_cast<int>(random.bits(4 * n) % 30), j = static_cast<int>(random.bits(4 * n + 1) % 33),
                  k = static_cast<int>(random.bits(4 * n + 2) % 26);
        const auto value = static_cast<float>(random.uniform(4 * n + 3));
        REQUIRE(editor.set(i, j, k, value));
        grid.at(i, j, k) = value;
        if (n % 100 == 0) {
            editor.publish();
            editor.reclaim(editor.current().version);
        }
    }
    editor.publish();
    CHECK(volume::to_grid(editor.current()).values == grid.values);
    for (std::uint64_t n = 0; n < 4000; ++n) {
        const Vec3 p = random_point(random, 50000 + n, 0.005);
        CHECK(editor.current().value(p) == Approx(dense_value(grid, p)).margin(1e-9));
    }
}

TEST_CASE("a version that is held never changes while others come and go, and the pool does not shrink") {
    const volume::Grid grid = sphere_grid({40, 40, 40}, Vec3(0.4e-3), 0.005);
    volume::BoneEditor editor(grid, constant_like(grid, 1.0f), {.band = 1.0, .max_dirty = 20, .max_versions = 4});
    const std::size_t free_at_first = editor.free_bricks();
    const auto edit = [&editor](std::uint64_t n) {
        const Random random{5};
        for (std::uint64_t i = 0; i < 3; ++i)
            editor.set(static_cast<int>(random.bits(9 * n + i) % 40), static_cast<int>(random.bits(9 * n + i + 3) % 40),
                       static_cast<int>(random.bits(9 * n + i + 6) % 40), static_cast<float>(n));
    };
    edit(1);
    const volume::BoneSnapshot held = editor.publish();
    const volume::Grid before = volume::to_grid(held);
    std::uint64_t last_hash = held.content_hash;
    for (std::uint64_t n = 2; n < 10000; ++n) {
        edit(n);
        const volume::BoneSnapshot next = editor.publish();
        REQUIRE(next.version == held.version + static_cast<std::int64_t>(n) - 1);
        CHECK(next.content_hash != last_hash);
        last_hash = next.content_hash;
        // The reader of `held` stands still: every other version is dropped before anyone reads it.
        if (n > 2) editor.forget(next.version - 1);
        editor.reclaim(held.version);
    }
    CHECK(volume::to_grid(held).values == before.values);
    editor.reclaim(editor.current().version);
    CHECK(editor.free_bricks() == free_at_first);
}

TEST_CASE("the content hash depends on the edits, not on who reads when") {
    const volume::Grid grid = sphere_grid({40, 40, 40}, Vec3(0.4e-3), 0.005);
    const auto hash_with = [&grid](bool reclaims) {
        volume::BoneEditor editor(grid, constant_like(grid, 1.0f), {.band = 1.0, .max_dirty = 20, .max_versions = 40});
        for (int n = 0; n < 30; ++n) {
            editor.set(n, 39 - n, 20, static_cast<float>(n));
            editor.publish();
            if (reclaims) editor.reclaim(editor.current().version);
        }
        return editor.current().content_hash;
    };
    CHECK(hash_with(true) == hash_with(false));
}

TEST_CASE("an edit beyond the budget of dirty bricks is refused whole") {
    const volume::Grid grid = sphere_grid({40, 40, 40}, Vec3(0.4e-3), 0.005);
    volume::BoneEditor editor(grid, constant_like(grid, 1.0f), {.band = 1.0, .max_dirty = 7, .max_versions = 4});
    CHECK_FALSE(editor.set(16, 16, 16, 1.0f));  // a corner shared by eight bricks
    CHECK(editor.dirty() == 0);
    CHECK(editor.get(16, 16, 16) == grid.at(16, 16, 16));
    CHECK(editor.set(17, 16, 16, 1.0f));  // an edge shared by four
    CHECK(editor.dirty() == 4);
}
