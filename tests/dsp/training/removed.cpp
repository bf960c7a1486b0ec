// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "tests/dsp/training/block.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;
using test::block_half;
using test::block_plan;
using test::cut_block;
using test::whole_block;

namespace {

/// The normal of the plan, turned about the stroke (x) and about the feed (z).
Vec3 turned(double about_stroke, double about_feed) {
    const Vec3 n(0.0, 1.0, 0.0);
    const Quat q = glm::angleAxis(about_stroke, Vec3(1.0, 0.0, 0.0)) * glm::angleAxis(about_feed, Vec3(0.0, 0.0, 1.0));
    return q * n;
}

}  // namespace

TEST_CASE("the plane of a cut is found to 0.05 mm and 0.2 degrees, whatever its voxels and its kerf") {
    for (const double h : {0.16 * mm, 0.3 * mm, 0.5 * mm})
        for (const double kerf : {0.8 * mm, 1.4 * mm}) {
            if (kerf < 2.0 * h) continue;
            const volume::Grid before = whole_block(h);
            for (const auto& [offset, about_stroke, about_feed] :
                 {std::array{0.0, 0.0, 0.0}, std::array{0.37 * mm, 0.0, 0.0}, std::array{-1.21 * mm, 3.0 * degree, 0.0},
                  std::array{0.5 * mm, -1.0 * degree, 4.0 * degree}}) {
                const Vec3 normal = turned(about_stroke, about_feed);
                const volume::Grid after = cut_block(h, Vec3(0.0, offset, 0.0), normal, kerf, 20 * mm);
                const auto plane = training::fit_cut_plane({before, after}, block_plan(), kerf);
                INFO("voxel " << h << ", kerf " << kerf << ", offset " << offset);
                REQUIRE(plane);
                REQUIRE(plane->angle);
                const double angle = std::acos(std::abs(normal.y));
                CHECK(std::abs(*plane->angle - angle) < 0.2 * degree);
                // Offsets from the plan over the section of the block, by quadrature.
                double sum = 0.0, most = 0.0;
                int count = 0;
                for (double x = -block_half.x; x <= block_half.x; x += 0.1 * mm)
                    for (double z = -block_half.z; z <= block_half.z; z += 0.1 * mm, ++count) {
                        const double y = offset - (normal.x * x + normal.z * z) / normal.y;
                        sum += y * y;
                        most = std::max(most, std::abs(y));
                    }
                CHECK(std::abs(plane->rms - std::sqrt(sum / count)) < 0.05 * mm);
                CHECK(std::abs(plane->max - most) < 0.05 * mm);
                double worst = 0.0;
                for (const training::CutPoint& p : plane->points) worst = std::max(worst, std::abs(p.width - kerf));
                CHECK(worst < 0.1 * mm + 0.1 * h);
            }
        }
}

TEST_CASE("the plane of a cut is that of most of it, and a slip counts in rms and maximum") {
    const double h = 0.3 * mm, kerf = 1.0 * mm;
    const volume::Grid before = whole_block(h);
    volume::Grid after = cut_block(h, Vec3(0.0, 0.3 * mm, 0.0), Vec3(0.0, 1.0, 0.0), kerf, 20 * mm);
    const auto clean = training::fit_cut_plane({before, after}, block_plan(), kerf);
    // A groove of 3 mm depth beside the cut, over a quarter of its length.
    const volume::Grid slip = test::grid_of(
        after.origin, after.position(after.size[0] - 1, after.size[1] - 1, after.size[2] - 1), h, [&](const Vec3& p) {
            return std::max({std::abs(p.y - 1.5 * mm) - 0.9 * mm, p.x + 5.0 * mm, block_half.z - 3.0 * mm - p.z});
        });
    REQUIRE(slip.size == after.size);
    for (std::size_t n = 0; n < slip.values.size(); ++n) after.values[n] = std::max(after.values[n], -slip.values[n]);
    const auto slipped = training::fit_cut_plane({before, after}, block_plan(), kerf);
    REQUIRE(clean);
    REQUIRE(slipped);
    CHECK(*slipped->angle < 0.2 * degree);
    CHECK(std::abs(slipped->point.y - 0.3 * mm) < 0.05 * mm);
    CHECK(slipped->rms > clean->rms + 0.02 * mm);
    CHECK(slipped->max > clean->max + 0.5 * mm);
}

TEST_CASE("a bone that was not cut, and a groove as shallow as its kerf, have no plane") {
    const double h = 0.3 * mm;
    const volume::Grid before = whole_block(h);
    CHECK_FALSE(training::fit_cut_plane({before, before}, block_plan(), 1.0 * mm));
    const volume::Grid groove = cut_block(h, Vec3(0.0), Vec3(0.0, 1.0, 0.0), 1.0 * mm, 1.0 * mm);
    const auto plane = training::fit_cut_plane({before, groove}, block_plan(), 1.0 * mm);
    CHECK((!plane || !plane->angle));
}

TEST_CASE("over-cut and under-cut are the volumes that they are") {
    const double h = 0.3 * mm, kerf = 1.0 * mm, length = 2.0 * block_half.x, height = 2.0 * block_half.z;
    const volume::Grid before = whole_block(h);
    training::PlannedCut plan = block_plan();
    const Vec3 y(0.0, 1.0, 0.0);
    SECTION("as planned") {
        const volume::Grid after = cut_block(h, Vec3(0.0), y, kerf, 20 * mm);
        const training::CutVolumes v = training::cut_volumes({before, after}, plan, kerf);
        CHECK(std::abs(v.removed_m3 - length * height * kerf) < 0.02 * length * height * kerf);
        CHECK(v.over_m3 < 1e-12);
        CHECK(v.under_m3 < 1e-12);
    }
    SECTION("beside the plan by less and by more than the tolerance") {
        const volume::Grid near = cut_block(h, Vec3(0.0, 0.8 * mm, 0.0), y, kerf, 20 * mm);
        const training::CutVolumes within = training::cut_volumes({before, near}, plan, kerf);
        CHECK(within.over_m3 < 0.5e-9);
        CHECK(within.under_m3 < 0.5e-9);
        const volume::Grid far = cut_block(h, Vec3(0.0, 3.0 * mm, 0.0), y, kerf, 20 * mm);
        const training::CutVolumes beyond = training::cut_volumes({before, far}, plan, kerf);
        CHECK(std::abs(beyond.over_m3 - length * height * kerf) < 0.02 * length * height * kerf);
        CHECK(std::abs(beyond.under_m3 - length * height * kerf) < 0.02 * length * height * kerf);
    }
    SECTION("not as deep as planned, and deeper than the stop") {
        const volume::Grid after = cut_block(h, Vec3(0.0), y, kerf, 9 * mm);
        const training::CutVolumes shallow = training::cut_volumes({before, after}, plan, kerf);
        CHECK(std::abs(shallow.under_m3 - length * 7 * mm * kerf) < 0.03 * length * 7 * mm * kerf);
        CHECK(shallow.over_m3 < 0.5e-9);
        plan.depth = 5 * mm;
        plan.depth_tolerance = 1 * mm;
        const training::CutVolumes deep = training::cut_volumes({before, after}, plan, kerf);
        CHECK(std::abs(deep.over_m3 - length * 3 * mm * kerf) < 0.05 * length * 3 * mm * kerf);
        CHECK(deep.under_m3 < 0.5e-9);
    }
    SECTION("longer than a guide") {
        plan.half_length = 6 * mm;
        const volume::Grid after = cut_block(h, Vec3(0.0), y, kerf, 20 * mm);
        const training::CutVolumes v = training::cut_volumes({before, after}, plan, kerf);
        CHECK(std::abs(v.over_m3 - 2 * 3 * mm * height * kerf) < 0.04 * 6 * mm * height * kerf);
    }
}

TEST_CASE("a cut goes through when no bone is left in its plane") {
    const double h = 0.3 * mm, kerf = 1.0 * mm;
    const volume::Grid before = whole_block(h);
    for (const double depth : {20 * mm, 15 * mm}) {
        const volume::Grid after = cut_block(h, Vec3(0.0, 0.4 * mm, 0.0), turned(2.0 * degree, 0.0), kerf, depth);
        const auto plane = training::fit_cut_plane({before, after}, block_plan(), kerf);
        REQUIRE(plane);
        const training::Severance s = training::severance_of({before, after}, block_plan(), *plane, 20 * mm);
        CHECK(s.severed == (depth > 16 * mm));
        CHECK(std::abs(s.exit - 16 * mm) < h);
        CHECK(std::abs(s.high - block_half.x) < h);
        CHECK(std::abs(s.low + block_half.x) < h);
    }
}
