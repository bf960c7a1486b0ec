// SPDX-License-Identifier: Apache-2.0
#include "tests/dsp/carve/saw.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

using namespace tactus;
using namespace tactus::test;

namespace {

carve::CarveCore saw(const carve::CarveSettings& settings = {}) { return {settings, Vec3(voxel)}; }

const Vec3 above_bone{0, 0.0006, 0};  // 0.1 mm of air under the kerf's front

bool same(const volume::Grid& a, const volume::Grid& b) { return a.values == b.values; }

}  // namespace

TEST_CASE("a saw pressed into bone advances at the reference speed over density") {
    for (const double density : {200.0, 600.0, 1000.0, 1800.0}) {
        DenseField field = block(Vec3(0.0), density);
        carve::CarveCore carver = saw();
        const double speed = 0.67e-3 * 1800.0 / density;
        const double seconds = 0.0025 / speed;
        carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 0.2 * seconds));
        const double before = depth(carver);
        const Vec3 from = above_bone + Vec3(0, -0.002 * seconds, 0);
        carve_through(carver, field, stroke(from, {0, -0.010, 0}, seconds));
        INFO("density " << density);
        CHECK(depth(carver) - before == Approx(0.0025).epsilon(0.02));
    }
}

TEST_CASE("the volume removed does not depend on how often the carver is called") {
    for (const double density : {200.0, 1800.0}) {
        const auto path = stroke(above_bone, {0, -0.010, 0}, density < 1000.0 ? 0.8 : 3.0);
        std::vector<double> volumes;
        for (const std::size_t per_call : {33, 17, 8, 1, 100}) {
            DenseField field = block(Vec3(0.0), density);
            carve::CarveCore carver = saw();
            volumes.push_back(carve_through(carver, field, path, per_call).removed_m3);
        }
        for (const double volume : volumes) CHECK(volume == Approx(volumes[0]).epsilon(0.01));
        CHECK(volumes[0] > 2e-8);
    }
}

TEST_CASE("the volume removed is that of the swept blade, wherever the samples of the grid lie") {
    std::vector<double> volumes;
    for (const double share : {0.0, 0.23, 0.5, 0.81}) {
        DenseField field = block(Vec3(0.4, 1.0, 0.7) * (share * voxel), 600.0);
        carve::CarveCore carver = saw();
        volumes.push_back(carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 2.0)).removed_m3);
        CHECK(volumes.back() == Approx(slot(depth(carver))).epsilon(0.02));
        CHECK(volumes.back() == Approx(volumes[0]).epsilon(0.01));
    }
}

TEST_CASE("the volume removed by an oblique blade in a grid of flat voxels is that of the swept blade") {
    const Quat oblique = glm::angleAxis(0.5, Vec3(0, 1, 0)) * downwards;  // turned about its way into the bone
    DenseField field = block(Vec3(0.0), 600.0, {0.00035, 0.0003, 0.0005});
    carve::CarveCore carver({}, field.spacing());
    const double volume = carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 2.0, oblique)).removed_m3;
    // The slot crosses the block from one long side to the other, 12 mm apart, at 0.5 rad to the 18 mm side.
    const double length = std::min(0.018 / std::cos(0.5), 0.012 / std::sin(0.5));
    CHECK(volume == Approx(slot(depth(carver)) * length / 0.018).epsilon(0.02));
}

TEST_CASE("removed bone is counted in its density class") {
    DenseField field = block();
    field.bone_density = [](const Vec3& p) {
        return p.x < 0.0 ? (p.x < -0.004 ? 300.0 : 500.0) : (p.x < 0.004 ? 900.0 : 1500.0);
    };
    carve::CarveCore carver = saw();
    const auto result =
        carve_through(carver, field, stroke(above_bone, {0, -0.0005, 0}, 4.0));  // slower than the saw can cut
    const double edge = 0.0005 * 3.999 - 0.0006;
    CHECK(depth(carver) == Approx(edge).margin(1e-6));
    const double per_length = slot(edge) / 0.018;
    CHECK(result.removed_by_density[0] == Approx(0.005 * per_length).epsilon(0.02));
    CHECK(result.removed_by_density[1] == Approx(0.004 * per_length).epsilon(0.02));
    CHECK(result.removed_by_density[2] == Approx(0.004 * per_length).epsilon(0.02));
    CHECK(result.removed_by_density[3] == Approx(0.005 * per_length).epsilon(0.02));
    double sum = 0.0;
    for (const double part : result.removed_by_density) sum += part;
    CHECK(sum == Approx(result.removed_m3).epsilon(1e-12));
}

TEST_CASE("the kerf is as wide as set, and smooth along the blade") {
    for (const double kerf : {0.001, 0.0014}) {
        carve::CarveSettings settings;
        settings.kerf = kerf;
        DenseField field = block(Vec3(0.0), 600.0);
        carve::CarveCore carver = saw(settings);
        carve_through(carver, field, stroke({0, 0.5 * kerf + 0.0001, 0}, {0, -0.010, 0}, 1.6));
        for (double x = -0.008; x <= 0.008; x += 0.0001) {
            const Vec3 middle(x, -0.0015, 0.0);
            double right = 0.0, left = 0.0;
            while (field.value(middle + Vec3(0, 0, right)) > 0.0) right += 1e-6;
            while (field.value(middle - Vec3(0, 0, left)) > 0.0) left += 1e-6;
            REQUIRE(right + left == Approx(kerf).margin(2e-5));
        }
    }
}

TEST_CASE("force, rate and density change the advance as the law says") {
    carve::CarveSettings settings;
    settings.force_exponent = 1.0;
    const auto advance = [&](double force, double rate) {
        DenseField field = block();
        carve::CarveCore carver = saw(settings);
        auto path = stroke(above_bone, {0, -0.010, 0}, 1.5);
        for (carve::CarveSample& sample : path) {
            sample.thrust = force;
            sample.rate = rate;
        }
        carve_through(carver, field, path);
        return depth(carver) + 0.5 * settings.kerf;
    };
    const double reference = advance(7.0, 228.0);
    CHECK(advance(14.0, 228.0) == Approx(2.0 * reference).epsilon(0.02));
    CHECK(advance(7.0, 114.0) == Approx(0.5 * reference).epsilon(0.03));
    CHECK(advance(0.0, 228.0) == Approx(0.0).margin(1e-5));
}

TEST_CASE("a saw that does not run removes nothing and does not pass") {
    DenseField field = block();
    const volume::Grid before = field.grid;
    carve::CarveCore carver = saw();
    const auto result = carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 1.0, downwards, false));
    CHECK(result.removed_m3 == 0.0);
    CHECK(same(field.grid, before));
    CHECK(depth(carver) == Approx(-0.0005).margin(2e-5));
}

TEST_CASE("a saw that starts while pressed against bone cuts from the surface on") {
    DenseField field = block();
    carve::CarveCore carver = saw();
    carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 0.2, downwards, false));
    const auto result = carve_through(carver, field, stroke(above_bone - Vec3(0, 0.002, 0), Vec3(0.0), 1.5));
    CHECK(depth(carver) + 0.0005 == Approx(0.67e-3 * 1.5).epsilon(0.03));
    CHECK(result.removed_m3 > 0.0);
}

TEST_CASE("drawing the blade back is free and it returns to where it had come") {
    DenseField field = block(Vec3(0.0), 600.0);
    carve::CarveCore carver = saw();
    carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 1.5));
    const double reached = depth(carver);
    const Vec3 out = above_bone + Vec3(0, 0.002, 0);
    carve_through(carver, field, stroke({0, -reached, 0}, {0, 0.1, 0}, 0.001 * std::ceil(1e4 * (reached + 0.0026))));
    CHECK(depth(carver) < -0.002);
    const auto back =
        carve_through(carver, field, stroke(out, {0, -0.1, 0}, 0.001 * std::floor(1e4 * (reached + 0.0026))));
    CHECK(depth(carver) == Approx(reached).margin(0.0003));
    CHECK(back.removed_m3 < 0.01 * slot(reached));
}

TEST_CASE("a wall is cut through and the blade goes on through air") {
    DenseField field = block(Vec3(0.0), 1000.0);
    field.grid = sampled(field.grid.origin, Vec3(0.013, 0.004, 0.009), Vec3(voxel),
                         [](const Vec3& p) { return box_distance(p, {-0.009, -0.003, -0.006}, block_high); });
    carve::CarveCore carver = saw();
    const auto result = carve_through(carver, field, stroke(above_bone, {0, -0.003, 0}, 3.0));
    CHECK(depth(carver) == Approx(0.003 * 2.999 - 0.0006).margin(1e-6));
    CHECK(result.removed_m3 == Approx(0.018 * 0.003 * 0.001).epsilon(0.02));
}

TEST_CASE("a blade that does not touch the bone removes nothing, and one that does cuts as deep as it is held") {
    DenseField field = block(Vec3(0.0), 200.0);
    const volume::Grid before = field.grid;
    carve::CarveCore carver = saw();
    const auto held = [](double height) {
        return std::vector<carve::CarveSample>(500, {Pose{Vec3(0, height, 0), downwards}, 0.001, 7.0, 228.0, true});
    };
    carve_through(carver, field, held(0.00002));
    CHECK(same(field.grid, before));
    carve_through(carver, field, held(-0.001));
    CHECK(field.value({0, -0.00095, 0}) > 0.0);
    CHECK(field.value({0, -0.00105, 0}) < 0.0);
}

TEST_CASE("two cuts leave an island between them untouched") {
    DenseField field = block(Vec3(0.0), 600.0);
    carve::CarveCore carver = saw();
    carve_through(carver, field, stroke(above_bone + Vec3(0, 0, -0.002), {0, -0.010, 0}, 1.0));
    carve_through(carver, field, stroke(above_bone + Vec3(0, 0.020, -0.002), Vec3(0.0), 0.01));
    carve_through(carver, field, stroke(above_bone + Vec3(0, 0.020, 0.002), Vec3(0.0), 0.01));
    carve_through(carver, field, stroke(above_bone + Vec3(0, 0, 0.002), {0, -0.010, 0}, 1.0));
    CHECK(field.value({0, -0.001, -0.002}) > 0.0003);
    CHECK(field.value({0, -0.001, 0.002}) > 0.0003);
    CHECK(field.value({0, -0.001, 0.0}) == Approx(-0.001).margin(0.00005));
    CHECK(field.value({0, -0.0053, 0.0}) < -0.001);
}

TEST_CASE("a blade outside the grid removes nothing") {
    DenseField field = block();
    const volume::Grid before = field.grid;
    carve::CarveCore carver = saw();
    CHECK(carve_through(carver, field, stroke({0, 0.5, 0}, {0, -0.010, 0}, 0.2)).removed_m3 == 0.0);
    CHECK(same(field.grid, before));
}

TEST_CASE("a blade that is tilted by next to nothing touches no voxel outside the grid") {
    struct BoundedField : DenseField {
        int outside = 0;
        float get(int i, int j, int k) noexcept {
            const std::array<int, 3> n = size();
            if (i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2]) return grid.at(i, j, k);
            if (++outside > 1000) std::abort();  // a loop over the whole range of int
            return 1.0f;
        }
    };
    // Rolled, so that many rows of the blade's box in the grid pass it at a distance.
    const Quat rolled = glm::angleAxis(0.6, Vec3(1, 0, 0)) * downwards;
    double volume = 0.0;
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(0, 0.6, -0.8)}) {
        for (double tilt = 1e-10; tilt < 1e-6; tilt *= 1.3) {
            BoundedField field{block(Vec3(0.0), 600.0)};
            carve::CarveCore carver = saw();
            const Quat orientation = glm::angleAxis(tilt, axis) * rolled;
            const auto result = carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 0.15, orientation));
            INFO("tilt " << tilt);
            REQUIRE(field.outside == 0);
            if (volume == 0.0) volume = result.removed_m3;
            CHECK(result.removed_m3 == Approx(volume).epsilon(1e-3));
        }
    }
    CHECK(volume > 0.0);
}

TEST_CASE("a blade that appears in the middle of bone cuts from the surface on") {
    DenseField field = block();
    carve::CarveCore carver = saw();
    const auto result = carve_through(carver, field, stroke({0, -0.006, 0}, Vec3(0.0), 0.1));
    CHECK(depth(carver) == Approx(0.67e-3 * 0.1 - 0.0005).margin(2e-5));
    CHECK(result.removed_m3 < 0.018 * 0.001 * 0.67e-4);
}

TEST_CASE("bone without density gives way and is removed") {
    DenseField field = block(Vec3(0.0), 0.0);
    carve::CarveCore carver = saw();
    const auto result = carve_through(carver, field, stroke(above_bone, {0, -0.010, 0}, 0.4));
    CHECK(depth(carver) == Approx(0.010 * 0.399 - 0.0006).margin(1e-6));
    CHECK(result.removed_m3 == Approx(slot(depth(carver))).epsilon(0.02));
    CHECK(result.removed_by_density[0] == result.removed_m3);
}

TEST_CASE("samples that are not numbers are ignored") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    auto path = stroke(above_bone, {0, -0.010, 0}, 0.5);
    DenseField clean = block(Vec3(0.0), 600.0), noisy = block(Vec3(0.0), 600.0);
    carve::CarveCore a = saw(), b = saw();
    carve_through(a, clean, path);
    std::vector<carve::CarveSample> mixed;
    for (std::size_t n = 0; n < path.size(); ++n) {
        mixed.push_back(path[n]);
        if (n % 7 != 3) continue;
        mixed.push_back(path[n]);
        if (n % 3 == 0) mixed.back().pose.position.x = nan;
        if (n % 3 == 1) mixed.back().pose.orientation = Quat(0, 0, 0, 0);
        if (n % 3 == 2) mixed.back().dt = nan;
    }
    carve_through(b, noisy, mixed);
    CHECK(depth(b) == depth(a));
    for (carve::CarveSample& sample : mixed) sample.thrust = sample.rate = nan;
    DenseField still = block();
    carve::CarveCore c = saw();
    CHECK(carve_through(c, still, mixed).removed_m3 == 0.0);
}

TEST_CASE("a blade that is pulled away from the bone cuts as little as one without thrust") {
    std::vector<double> volumes;
    for (const double thrust : {0.0, -7.0}) {
        DenseField field = block(Vec3(0.0), 600.0);
        carve::CarveCore carver = saw({.force_exponent = 1.0});
        auto path = stroke(above_bone, {0, -0.010, 0}, 0.5);
        for (carve::CarveSample& sample : path) sample.thrust = thrust;
        volumes.push_back(carve_through(carver, field, path).removed_m3);
    }
    CHECK(volumes[1] == volumes[0]);
}

TEST_CASE("a front cuts with its own kerf, and with no more than the kerf that the bone was prepared for") {
    const auto removed = [](double kerf) {
        DenseField field = block(Vec3(0.0), 600.0);
        carve::CarveCore carver = saw();
        std::vector<carve::CutFront> path;
        for (int n = 0; n <= 40; ++n) {
            carve::CutFront front;
            front.pose = {{0.0, 0.001 - 0.0001 * n, 0.0}, downwards};
            front.kerf = kerf;
            front.pitch = 0.002;
            front.count = 8;
            front.running = 1;
            for (std::size_t k = 0; k < 8; ++k) {
                front.place(k, front.pose.apply({0.002 * (static_cast<double>(k) - 3.5), 0.0, 0.0}));
                front.seated |= std::uint64_t{1} << k;
                front.fresh |= std::uint64_t{n == 0} << k;
            }
            path.push_back(front);
        }
        return carver.update(field, std::span<const carve::CutFront>(path)).removed_m3;
    };
    const double widest = carve::CarveSettings{}.kerf, whole = removed(widest);
    CHECK(whole > 1e-8);
    const double narrow = removed(0.6 * widest);
    CHECK(narrow < 0.7 * whole);
    CHECK(narrow > 0.3 * whole);
    CHECK(removed(3.0 * widest) == whole);
}
