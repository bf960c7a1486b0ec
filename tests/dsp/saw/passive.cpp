// SPDX-License-Identifier: Apache-2.0
// A saw never pulls and gives no energy, whatever it cuts through.
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

double box(const Vec3& p, const Vec3& low, const Vec3& high) {
    const Vec3 q = glm::max(low - p, p - high);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

struct Body {
    const char* name;
    std::function<double(const Vec3&)> distance;
    Vec3 low, high;
};

const Vec3 low(-0.006, -0.004, -0.008), high(0.006, 0.004, 0.0);

std::vector<Body> bodies() {
    const auto plate = [](double thickness) {
        return [=](const Vec3& p) { return box(p, Vec3(low.x, low.y, -thickness), high); };
    };
    return {
        {"block", [](const Vec3& p) { return box(p, low, high); }, low, high},
        {"plate of 1 mm", plate(0.001), {low.x, low.y, -0.001}, high},
        {"plate of 2.5 mm", plate(0.0025), {low.x, low.y, -0.0025}, high},
        // Bars of 1.2 mm every 2.4 mm, in three layers.
        {"lattice",
         [](const Vec3& p) {
             double d = 1.0;
             for (int layer = 0; layer < 3; ++layer)
                 for (int bar = -2; bar <= 2; ++bar) {
                     const double across = layer % 2 ? p.x : p.y, z = p.z + 0.0012 + 0.002 * layer;
                     const double radius = std::hypot(across - 0.0024 * bar, z);
                     const double end = std::abs(layer % 2 ? p.y : p.x) - 0.005;
                     d = std::min(d, std::max(radius - 0.0006, end));
                 }
             return d;
         },
         low, high},
    };
}

struct Cycle {
    double work = 0.0, bound = 0.0, pull = 0.0, most = 0.0, removed = 0.0;
};

/// Down by `depth`, along by `along` m and back, up again. The hand moves as it is told.
Cycle cycle_of(const Body& body, double voxel, bool running, double depth, const Vec3& aside, double seconds) {
    const auto bone = bone_where({.low = body.low, .high = body.high, .voxel = voxel}, body.distance);
    Sawing sawing(*bone, 1000.0, 20e3);
    sawing.drive.running = running;
    const auto eased = [](double s, double a, double b) {
        const double u = std::clamp((s - a) / (b - a), 0.0, 1.0);
        return u * u * (3.0 - 2.0 * u);
    };
    Cycle cycle;
    Vec3 last_force(0.0), last(0.0, 0.0, 0.002);
    const auto ticks = static_cast<int>(seconds * 1000.0);
    for (int n = 0; n <= ticks; ++n) {
        const double s = static_cast<double>(n) / ticks;
        const Vec3 at = Vec3(0.0003, 0.0002, 0.002 - (0.002 + depth) * (eased(s, 0.0, 0.6) - eased(s, 0.85, 1.0))) +
                        aside * (eased(s, 0.6, 0.7) - eased(s, 0.75, 0.85));
        const Vec3 force = sawing.step({at, teeth_down}).wrench.force;
        if (n > 0) {
            const Vec3 move = at - last;
            cycle.work += glm::dot(last_force, move);
            cycle.bound += 0.5 * std::min(std::abs(glm::dot(force - last_force, move)), 20e3 * glm::dot(move, move));
        }
        cycle.pull = std::max(cycle.pull, -force.z);
        cycle.most = std::max(cycle.most, glm::length(force));
        last_force = force;
        last = at;
    }
    // A blade that hooked under a bar is released when the hand has been outside for 2 s.
    for (int n = 0; n < 2200 && last_force != Vec3(0.0); ++n)
        last_force = sawing.step({Vec3(0.0003, 0.0002, 0.002), teeth_down}).wrench.force;
    CHECK(glm::length(last_force) == 0.0);
    cycle.removed = sawing.removed;
    return cycle;
}

}  // namespace

TEST_CASE("approach, cut, break-through and retreat give the hand no energy, and bone never pulls", "[slow]") {
    for (const Body& body : bodies())
        for (const double voxel : {0.16e-3, 0.3e-3, 0.5e-3})
            for (const bool running : {false, true})
                for (const Vec3& aside : {Vec3(0.0), Vec3(0.008, 0.0, 0.0), Vec3(0.0, 0.002, 0.0)}) {
                    // The finest grid only where it is small.
                    if (voxel < 0.2e-3 && body.low.z < -0.003) continue;
                    if (running && aside != Vec3(0.0) && voxel > 0.4e-3) continue;
                    const Cycle cycle = cycle_of(body, voxel, running, 0.003, aside, running ? 3.0 : 1.0);
                    CAPTURE(body.name, voxel, running, aside.x, aside.y);
                    CAPTURE(cycle.work, cycle.bound, cycle.pull, cycle.most, cycle.removed * 1e9);
                    CHECK(cycle.work <= 1.02 * cycle.bound + 1e-9);  // 2 %: kinks where points touch
                    // Aside, a blade that stands still hooks under the bars of the lattice: they hold it back.
                    const bool hooks = body.name == std::string("lattice") && !running && aside.y != 0.0;
                    CHECK(cycle.pull <= (hooks ? 0.02 * cycle.most : 1e-9));
                    CHECK(cycle.most > 0.5);
                    CHECK((cycle.removed > 0.0) == running);
                }
}

TEST_CASE("at 20 N a blade that stands still passes no bone") {
    for (const double voxel : {0.33e-3, 0.5e-3})
        for (const Body& body : bodies()) {
            const auto bone = bone_where({.low = body.low, .high = body.high, .voxel = voxel}, body.distance);
            Sawing sawing(*bone);
            sawing.drive.running = false;
            Pushing hand;
            double force = 0.0;
            hand.push(sawing, 20.0, 1.0, [&](const saw::SawContact& now) { force = now.thrust; });
            CAPTURE(body.name, voxel, force, hand.position.z);
            CHECK(force == Approx(20.0).epsilon(0.02));
            // The front rests on the surface; the blade is an elastic depth below.
            for (const saw::Tooth& tooth : sawing.blade.teeth().teeth())
                if (tooth.density[1] > 0.0) CHECK(bone->current().value(tooth.at) > 0.0);
            CHECK(hand.position.z > -0.005);
        }
}

TEST_CASE("at break-through the force falls to zero and does not change its sign") {
    for (const double voxel : {0.16e-3, 0.33e-3, 0.5e-3}) {
        const Body plate = bodies()[1];
        const auto bone = bone_where({.low = plate.low, .high = plate.high, .voxel = voxel}, plate.distance);
        Sawing sawing(*bone);
        Pushing hand;
        hand.damping = 2000.0;
        double least = 1.0, last = 0.0;
        hand.push(sawing, 20.0, 6.0, [&](const saw::SawContact& now) {
            least = std::min(least, now.wrench.force.z);
            last = now.wrench.force.z;
        });
        CAPTURE(voxel, least, last, hand.position.z);
        CHECK(least > -1e-9);
        CHECK(last == 0.0);
        CHECK(hand.position.z < -0.002);
    }
}

TEST_CASE("a blade that slides sideways at 140 mm/s planes off little") {
    for (const auto& [way, most] : {std::pair{Vec3(0.0, 0.014, 0.0), 2.0}, std::pair{Vec3(0.014, 0.0, 0.0), 8.0}}) {
        const auto bone = bone_block({.voxel = 0.33e-3});
        Sawing sawing(*bone);
        Pushing hand;
        hand.push(sawing, 10.0, 1.0);
        const double before = sawing.removed;
        const Vec3 from = hand.position;
        for (int n = 0; n < 117; ++n) sawing.step({from + way * std::min(1.0, 0.01 * n), teeth_down});
        CAPTURE(way.x, way.y);
        CHECK((sawing.removed - before) * 1e9 < most);
    }
}

TEST_CASE("removal of bone at 60 Hz is not felt") {
    const auto bone = bone_block({.voxel = 0.33e-3});
    Sawing sawing(*bone);
    std::vector<double> thrust;
    for (int n = 0; n < 4000; ++n) {
        const double z = 0.2e-3 - 0.0015e-3 * std::min(n, 1000) - 0.00025e-3 * std::max(n - 1000, 0);
        const double force = sawing.step({Vec3(0.0, 0.0, z), teeth_down}).thrust;
        if (n >= 2000) thrust.push_back(force);
    }
    double mean = 0.0;
    for (const double force : thrust) mean += force / static_cast<double>(thrust.size());
    const auto line = [&](double hz) {
        double re = 0.0, im = 0.0;
        for (std::size_t n = 0; n < thrust.size(); ++n) {
            const double phase = 2.0 * std::numbers::pi * hz * static_cast<double>(n) / 1000.0;
            const double hann =
                1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(thrust.size()));
            re += (thrust[n] - mean) * hann * std::cos(phase);
            im += (thrust[n] - mean) * hann * std::sin(phase);
        }
        return 2.0 * std::hypot(re, im) / static_cast<double>(thrust.size());
    };
    const double floor = 0.25 * (line(52.0) + line(56.0) + line(64.0) + line(68.0));
    CAPTURE(mean, floor, line(60.0), line(120.0));
    CHECK(mean > 3.0);
    CHECK(line(60.0) < floor + 0.01);
    CHECK(line(120.0) < floor + 0.01);
}
