// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/blade.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

using namespace tactus;

namespace {

std::unique_ptr<volume::BoneEditor> bone_of(const std::function<double(const Vec3&)>& distance) {
    volume::Grid grid{{181, 121, 61}, Vec3(-0.03, -0.02, -0.01), Vec3(1.0 / 3000.0), {}};
    grid.values.resize(grid.count());
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                grid.at(i, j, k) = static_cast<float>(distance(grid.position(i, j, k)));
    volume::Grid density = grid;
    std::ranges::fill(density.values, 1800.0f);
    return std::make_unique<volume::BoneEditor>(
        grid, density, volume::BoneEditorOptions{.band = 0.1, .max_dirty = 1, .max_versions = 1});
}

/// Bone for y > 0: the blade, whose y points at the bone, is pressed in by raising its y.
double half_space(const Vec3& p) { return -p.y; }

constexpr double stiffness = 3000.0;
const contact::BladePoints points;

}  // namespace

TEST_CASE("a whole edge pressed flat into a plane is pushed out along the normal, proportional to the depth") {
    const auto bone = bone_of(half_space);
    const double flat = stiffness / 4.0 * std::pow(44.0, 0.25);
    for (const double depth : {0.1e-3, 0.4e-3, 1.0e-3}) {
        const contact::BladeContact contact = contact::blade_contact(
            bone->current(), points, {Vec3(0.0, depth, 0.0), Quat(1, 0, 0, 0)}, Vec3(0.0), stiffness);
        CHECK(contact.count == 44);
        CHECK(contact.penetration == Approx(depth).epsilon(1e-4));
        CHECK(contact.wrench.force.y == Approx(-flat * depth).epsilon(1e-4));
        CHECK(std::abs(contact.wrench.force.x) + std::abs(contact.wrench.force.z) < 1e-9);
        CHECK(contact.load == Approx(flat * depth).epsilon(1e-4));
        // Symmetric about the origin; about a point 10 mm to the side it has the lever of 10 mm.
        CHECK(glm::length(contact.wrench.torque) < 1e-6);
        const contact::BladeContact aside = contact::blade_contact(
            bone->current(), points, {Vec3(0.0, depth, 0.0), Quat(1, 0, 0, 0)}, Vec3(0.01, 0.0, 0.0), stiffness);
        CHECK(aside.wrench.torque.z == Approx(-0.01 * aside.wrench.force.y).epsilon(1e-3));
    }
}

TEST_CASE("points in a sphere feel the analytic force") {
    // The middle of the tooth edge reaches into a ball.
    const Vec3 centre(0.0, 0.0085, 0.0);
    const double radius = 0.008;
    const auto bone = bone_of([&](const Vec3& p) { return glm::length(p - centre) - radius; });
    const Vec3 tooth = points.local[21];
    const Vec3 target = centre + glm::normalize(Vec3(0.3, -1.0, 0.2)) * (radius - 0.5e-3);
    const Pose tool{target - tooth, Quat(1, 0, 0, 0)};
    const contact::BladeContact contact = contact::blade_contact(bone->current(), points, tool, Vec3(0.0), stiffness);
    Vec3 expected(0.0);
    double norm8 = 0.0;
    for (const Vec3& local : points.local) {
        const double depth = radius - glm::length(tool.apply(local) - centre);
        if (depth > 0.0) norm8 += std::pow(depth, 8.0);
    }
    for (const Vec3& local : points.local) {
        const Vec3 out = tool.apply(local) - centre;
        const double depth = radius - glm::length(out);
        if (depth > 0.0)
            expected += glm::normalize(out) * (stiffness / 4.0 * std::pow(depth, 7.0) * std::pow(norm8, -0.75));
    }
    CHECK(glm::length(contact.wrench.force - expected) < 0.03 * glm::length(expected));
}

TEST_CASE("the force is the gradient of an energy and no motion feels more than the given stiffness") {
    const auto bone = bone_of([](const Vec3& p) {
        // A rough surface with bumps narrower than the blade, and a groove.
        return -(p.y + 0.4e-3 * std::sin(1800.0 * p.x) * std::cos(900.0 * p.z) + 0.3e-3 * std::sin(500.0 * p.x)) / 1.35;
    });
    const Random random{9};
    for (std::uint64_t n = 0; n < 300; ++n) {
        const Vec3 axis(random.normal(8 * n), random.normal(8 * n + 1), random.normal(8 * n + 2));
        const Pose tool{Vec3(0.002 * random.uniform(8 * n + 3), 1.2e-3 * random.uniform(8 * n + 4) - 0.2e-3, 0.0),
                        glm::angleAxis(0.03 * random.normal(8 * n + 5), glm::normalize(axis))};
        const auto force_at = [&](const Vec3& shift) {
            Pose moved = tool;
            moved.position += shift;
            return contact::blade_contact(bone->current(), points, moved, moved.position, stiffness).wrench.force;
        };
        const double h = 1e-7;
        for (int a = 0; a < 3; ++a) {
            Vec3 step(0.0);
            step[a] = h;
            const Vec3 slope = (force_at(step) - force_at(-step)) / (2.0 * h);
            // −∂F/∂x is the stiffness along that motion.
            CHECK(-slope[a] <= 1.15 * stiffness);
        }
        // Continuity: a nanometre never changes the force by more than the stiffness allows, many times over.
        CHECK(glm::length(force_at(Vec3(1e-9, 1e-9, 1e-9)) - force_at(Vec3(0.0))) < 1e-9 * stiffness * 20.0);
    }
}

TEST_CASE("depth added to any point never lowers the total push of a flat contact") {
    // A step in the surface: the second half of the teeth comes in later.
    const auto bone = bone_of([](const Vec3& p) { return -(p.y - (p.x > 0.0 ? 0.3e-3 : 0.0)); });
    double last = 0.0;
    for (double depth = 0.0; depth < 1e-3; depth += 1e-6) {
        const double load = contact::blade_contact(bone->current(), points, {Vec3(0.0, depth, 0.0), Quat(1, 0, 0, 0)},
                                                   Vec3(0.0), stiffness)
                                .load;
        CHECK(load >= last - 1e-9);
        last = load;
    }
}

TEST_CASE("in a kerf: centred no side force, shifted pushed back, tilted a righting torque, pinched both walls") {
    const auto kerf = [](double half_width) {
        return bone_of([half_width](const Vec3& p) {
            // A slot around z = 0, open towards −y, closed at y = 1 mm.
            const double wall = half_width - std::abs(p.z), end = 1.0e-3 - p.y;
            return std::min(wall, end);
        });
    };
    const auto wide = kerf(0.55e-3);
    const auto at = [](double z, double tilt) {
        return Pose{Vec3(0.0, 0.0, z), glm::angleAxis(tilt, Vec3(1.0, 0.0, 0.0))};
    };
    CHECK(glm::length(
              contact::blade_contact(wide->current(), points, at(0.0, 0.0), Vec3(0.0), stiffness).wrench.force) == 0.0);
    const contact::BladeContact shifted =
        contact::blade_contact(wide->current(), points, at(0.2e-3, 0.0), Vec3(0.0), stiffness);
    CHECK(shifted.wrench.force.z < -0.05);
    const contact::BladeContact tilted =
        contact::blade_contact(wide->current(), points, at(0.0, 0.06), Vec3(0.0), stiffness);
    CHECK(tilted.wrench.torque.x < -1e-4);
    const auto narrow = kerf(0.35e-3);
    const contact::BladeContact pinched =
        contact::blade_contact(narrow->current(), points, at(0.0, 0.0), Vec3(0.0), stiffness);
    CHECK(pinched.count == 88);
    CHECK(std::abs(pinched.wrench.force.z) < 1e-6);
}

TEST_CASE("a hand on the blade does not ring at the stated stiffness, however many points touch") {
    // 0.2 kg, 5 N s/m, force held for a tick: b/(T/2) = 10 N/mm is the limit; 3 N/mm must settle.
    for (const double tilt : {0.0, 0.004, 0.03}) {
        const auto bone = bone_of(half_space);
        double y = -0.1e-3, v = 0.0, late = 0.0;
        for (int tick = 0; tick < 2000; ++tick) {
            const Pose tool{Vec3(0.0, y, 0.0), glm::angleAxis(tilt, Vec3(0.0, 0.0, 1.0))};
            const double force =
                contact::blade_contact(bone->current(), points, tool, tool.position, stiffness).wrench.force.y + 2.0;
            for (int sub = 0; sub < 10; ++sub) {
                v += (force - 5.0 * v) / 0.2 * 1e-4;
                y += v * 1e-4;
            }
            if (tick > 1500) late = std::max(late, std::abs(v));
        }
        INFO("tilt " << tilt);
        CHECK(late < 1e-6);
    }
}

TEST_CASE("a pinched blade feels no more than the stated stiffness, and rests") {
    for (const double half_width : {0.45e-3, 0.35e-3, 0.2e-3}) {
        const auto bone = bone_of([half_width](const Vec3& p) { return half_width - std::abs(p.z); });
        const auto side = [&](double z) {
            return contact::blade_contact(bone->current(), points, {Vec3(0.0, 0.0, z), Quat(1, 0, 0, 0)}, Vec3(0.0),
                                          stiffness)
                .wrench.force.z;
        };
        INFO("half width " << half_width);
        const double h = 1e-7;
        CHECK((side(-h) - side(h)) / (2.0 * h) <= 1.05 * stiffness);
        CHECK((side(-h) - side(h)) / (2.0 * h) > 0.0);
        double z = 1e-6, v = 0.0;
        for (int tick = 0; tick < 3000; ++tick) {
            const double force = side(z);
            for (int sub = 0; sub < 10; ++sub) {
                v += (force - 5.0 * v) / 0.2 * 1e-4;
                z += v * 1e-4;
            }
        }
        CHECK(std::abs(side(z)) < 1e-3);
    }
}

TEST_CASE("a pose that is no pose, or far away, feels nothing") {
    const auto bone = bone_of(half_space);
    for (const Pose& pose : {Pose{Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Quat(1, 0, 0, 0)},
                             Pose{Vec3(0.0), Quat(0, 0, 0, 0)}, Pose{Vec3(5.0, 0, 0), Quat(1, 0, 0, 0)}}) {
        const contact::BladeContact contact =
            contact::blade_contact(bone->current(), points, pose, Vec3(0.0), stiffness);
        CHECK(contact.count == 0);
        CHECK(contact.wrench.force == Vec3(0.0));
    }
}
