// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell_contact.hpp"

#include "dsp/contact/pointshell_kernel.hpp"
#include "dsp/core/hash.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <limits>

using namespace tactus;

namespace {

std::uint64_t hash_of(const contact::ContactSum& sum) {
    Hash hash;
    hash.add_bytes(&sum.energy, 8);
    hash.add_bytes(sum.gradient.data(), sizeof sum.gradient);
    hash.add_bytes(sum.stiffness.data(), sizeof sum.stiffness);
    hash.add_bytes(&sum.total_force, 8);
    hash.add_bytes(&sum.penetration, 8);
    hash.add_word(sum.in_contact);
    hash.add_word(sum.evaluated);
    return hash.value();
}

/// Largest difference of the gradients; moments are counted at a lever of 10 mm.
double apart(const contact::ContactSum& a, const contact::ContactSum& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < 6; ++i)
        most = std::max(most, std::abs(a.gradient[i] - b.gradient[i]) / (i < 3 ? 1.0 : 0.01));
    return most;
}

/// A rough body pressed into another in several ways: free, touching, deep, over the border of the grid.
struct Scene {
    contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(3000, 0.006));
    contact::Voxmap map = bodies::rough_ball(48, 1e-3, 0.012);
    Random random{11};

    contact::ContactPair pair(std::uint64_t n) const {
        const Pose map_pose = bodies::random_pose(random, 2 * n, 0.3);
        Pose shell_pose = bodies::random_pose(random, 2 * n + 1, 1.0);
        const double apart = 0.005 + 0.02 * random.uniform(1000000 + n);
        shell_pose.position = map_pose.position + apart * glm::normalize(shell_pose.position);
        return {&shell, shell_pose, &map, map_pose, n % 3 != 0};
    }
    contact::ContactLaw law(std::uint64_t n) const {
        return {
            .stiffness = n % 2 ? 1e4 : 1e11,
            .blend = n % 7 ? 0.03e-3 : 0.0,
            .saturation = n % 5 ? 1e6 : 1e-3,
            .by_area = n % 2 == 0,
            .direction = n % 11 == 10 ? contact::ForceDirection::shell_normal : contact::ForceDirection::field_gradient,
            .interpolation = n % 4 < 2 ? contact::Interpolation::trilinear : contact::Interpolation::quadratic};
    }
};

}  // namespace

TEST_CASE("the vectorised contact is the reference to 1e-5 of the sum of forces") {
    const Scene scene;
    contact::PointshellContact contact(scene.shell.nodes.size());
    int touched = 0;
    for (std::uint64_t n = 0; n < 300; ++n) {
        const contact::ContactPair pair = scene.pair(n);
        const contact::ContactLaw law = scene.law(n);
        const Vec3 about = pair.shell_pose.position + Vec3(0.003, -0.002, 0.001);
        const contact::ContactSum exact = contact::contact_reference({&pair, 1}, about, law);
        const contact::ContactSum fast = contact({&pair, 1}, about, law);
        // A point on a face between cells, but for rounding, may be taken for one of the other cell, where the gradient
        // of a trilinear field differs; nothing can be said of it.
        const Pose into = pair.map_pose.inverse() * pair.shell_pose;
        bool on_face = false;
        for (const Vec3& p : scene.shell.position) {
            const Vec3 at = (into.apply(p) - scene.map.grid.origin) / scene.map.grid.spacing;
            const Vec3 to_face = glm::abs(at - glm::round(at));
            on_face = on_face || std::min({to_face.x, to_face.y, to_face.z}) < 1e-6;
        }
        if (on_face && law.interpolation == contact::Interpolation::trilinear) continue;
        INFO("pose " << n << ", " << exact.in_contact << " points, " << exact.total_force << " N");
        CHECK(apart(exact, fast) <= 1e-5 * exact.total_force);
        CHECK(fast.energy == Approx(exact.energy).epsilon(2e-5));
        CHECK(fast.total_force == Approx(exact.total_force).epsilon(1e-5));
        CHECK(fast.penetration == Approx(exact.penetration).epsilon(1e-5).margin(1e-9));
        CHECK(std::abs(static_cast<double>(fast.in_contact) - static_cast<double>(exact.in_contact)) <=
              1.0 + 1e-3 * static_cast<double>(exact.in_contact));
        // Entries of one size after scaling moments by a lever of 10 mm.
        double scale = 0.0, off = 0.0;
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) {
                const double lever = (i < 3 ? 1.0 : 0.01) * (j < 3 ? 1.0 : 0.01);
                scale = std::max(scale, std::abs(exact.stiffness[6 * i + j]) / lever);
                off = std::max(off, std::abs(exact.stiffness[6 * i + j] - fast.stiffness[6 * i + j]) / lever);
                CHECK(fast.stiffness[6 * i + j] == Approx(fast.stiffness[6 * j + i]));
            }
        CHECK(off <= 1e-4 * scale);
        CHECK(bodies::never_negative(fast.stiffness, 1e-5));
        const contact::ContactSum energy =
            contact({&pair, 1}, about, law, std::numeric_limits<std::size_t>::max(), contact::ContactParts::energy);
        CHECK(energy.energy == fast.energy);
        touched += exact.in_contact > 100;
    }
    CHECK(touched > 100);
}

TEST_CASE("every variant of the kernel gives the same bits") {
    const Scene scene;
    contact::PointshellContact contact(scene.shell.nodes.size());
    std::vector<std::uint64_t> first;
    const auto names = contact::kernel::variants();
    for (const std::string_view name : names) {
        REQUIRE(contact::kernel::use_variant(name));
        CHECK(contact::kernel::variant_in_use() == name);
        for (std::uint64_t n = 0; n < 200; ++n) {
            const contact::ContactPair pair = scene.pair(n);
            const std::uint64_t hash = hash_of(contact({&pair, 1}, pair.shell_pose.position, scene.law(n)));
            if (name == names.front()) first.push_back(hash);
            INFO(name << " against " << names.front() << ", pose " << n);
            CHECK(hash == first[n]);
        }
    }
    REQUIRE(contact::kernel::use_variant(""));
    CHECK(contact::kernel::variant_in_use() == names.front());
    CHECK_FALSE(contact::kernel::use_variant("abacus"));
}

TEST_CASE("contact allocates nothing, locks nothing and calls no system") {
    const Scene scene;
    contact::PointshellContact contact(2 * scene.shell.nodes.size());
    const contact::ContactPair pairs[2] = {scene.pair(1), scene.pair(2)};
    contact::ContactSum sum;
    const RealtimeViolations violations = watch([&] {
        sum = contact(pairs, Vec3(0.0), {});
        sum = contact(pairs, Vec3(0.0), {.interpolation = contact::Interpolation::quadratic}, 500);
        sum = contact::contact_reference(pairs, Vec3(0.0), {});
    });
    CHECK(violations.describe() == "none");
}

TEST_CASE("what is culled could not touch: light contact of many points looks at few and gives the same sums") {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(100000, 0.02));
    const contact::Voxmap map = bodies::ball(64, 1e-3, 0.02);
    contact::PointshellContact contact(shell.nodes.size());
    for (const double depth : {-3e-3, -0.1e-3, 0.0, 0.05e-3, 0.4e-3, 39.5e-3}) {
        const Pose pose{(0.04 - depth) * glm::normalize(Vec3(1, 2, -1)), glm::angleAxis(0.7, Vec3(0, 0, 1))};
        const contact::ContactPair pair{&shell, pose, &map, {}, true};
        const contact::ContactSum exact = contact::contact_reference({&pair, 1}, pose.position, {});
        const contact::ContactSum fast = contact({&pair, 1}, pose.position, {});
        CHECK(fast.in_contact == exact.in_contact);
        CHECK(apart(exact, fast) <= 1e-5 * exact.total_force);
        CHECK_FALSE(fast.reduced);
        if (depth < 1e-3) CHECK(fast.evaluated < 10000);
        if (depth < -1e-3) CHECK(fast.evaluated == 0);
        if (depth > 0.0 && depth < 1e-3) CHECK(exact.in_contact > 20);
    }
}

TEST_CASE("a budget bounds the points, the nearest are kept whole and the rest are stood for") {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(40000, 0.018));
    const contact::Voxmap map = bodies::ball(64, 1e-3, 0.02);
    contact::PointshellContact contact(shell.nodes.size());
    // All around: the shell lies 2 mm deep in the ball, a little to one side.
    const contact::ContactPair pair{&shell, {Vec3(0.2e-3, 0, 0), Quat(1, 0, 0, 0)}, &map, {}, true};
    for (const bool by_area : {false, true}) {
        const contact::ContactLaw law{.stiffness = by_area ? 1e11 : 1e4, .by_area = by_area};
        const contact::ContactSum whole = contact({&pair, 1}, Vec3(0.0), law);
        CHECK(whole.evaluated == 40000);
        for (const std::size_t budget : {20000u, 5000u, 1000u, 64u, 1u}) {
            const contact::ContactSum part = contact({&pair, 1}, Vec3(0.0), law, budget);
            INFO("budget " << budget);
            CHECK(part.evaluated <= std::max<std::size_t>(budget, 64));
            CHECK(part.reduced);
            CHECK(part.energy == Approx(whole.energy).epsilon(budget > 500 ? 0.02 : 0.05));
            CHECK(part.total_force == Approx(whole.total_force).epsilon(budget > 500 ? 0.01 : 0.03));
            CHECK(part.gradient[0] == Approx(whole.gradient[0]).epsilon(0.2));
        }
        CHECK_FALSE(contact({&pair, 1}, Vec3(0.0), law, 40000).reduced);
    }
    // Light contact under a small budget: the points near the other body are all there.
    const contact::ContactPair light{&shell, {Vec3(0.0378, 0, 0), Quat(1, 0, 0, 0)}, &map, {}, true};
    const contact::ContactSum whole = contact({&light, 1}, Vec3(0.0), {}),
                              part = contact({&light, 1}, Vec3(0.0), {}, 2000);
    CHECK(whole.in_contact > 50);
    CHECK(part.evaluated <= 2000);
    CHECK(part.gradient[0] == Approx(whole.gradient[0]).epsilon(1e-3));
}

TEST_CASE("several pairs under one budget: as one after the other when it is enough, and shared when it is not") {
    const Scene scene;
    const contact::Pointshell small = contact::make_pointshell(contact::spread_over_ball(700, 0.004));
    const contact::Voxmap floor =
        contact::sample_voxmap(contact::centred_layout(40, 1e-3), [](const Vec3& p) { return p.z; });
    const Pose pose{Vec3(0.003, 0.001, 0.002), glm::angleAxis(0.5, glm::normalize(Vec3(1, 1, 0)))};
    const contact::ContactPair pairs[3] = {
        {&scene.shell, pose, &floor, {}, true},
        {&small, {Vec3(0.012, 0.003, 0.0), Quat(1, 0, 0, 0)}, &scene.map, pose, false},
        {&scene.shell, pose, &scene.map, {Vec3(0.015, 0, 0), Quat(1, 0, 0, 0)}, true}};
    contact::PointshellContact contact(2 * scene.shell.nodes.size() + small.nodes.size());
    const contact::ContactSum all = contact(pairs, pose.position, {}),
                              exact = contact::contact_reference(pairs, pose.position, {});
    CHECK(exact.in_contact > 500);
    CHECK(apart(all, exact) < 1e-5 * exact.total_force);
    double energy = 0.0;
    for (const contact::ContactPair& pair : pairs) energy += contact({&pair, 1}, pose.position, {}).energy;
    CHECK(energy == Approx(all.energy).epsilon(1e-12));
    const contact::ContactSum part = contact(pairs, pose.position, {}, 1500);
    CHECK(part.reduced);
    CHECK(part.evaluated <= 1500);
    CHECK(part.energy == Approx(all.energy).epsilon(0.1));
    // Room for fewer nodes than there are keeps things coarse, not broken.
    contact::PointshellContact narrow(8);
    const contact::ContactSum coarse = narrow(pairs, pose.position, {});
    CHECK(coarse.reduced);
    CHECK(coarse.evaluated <= 8 * 64);
    CHECK(coarse.energy == Approx(all.energy).epsilon(0.2));
}

TEST_CASE("what is no scene is nothing to the vectorised form either") {
    const Scene scene;
    const contact::Pointshell none;
    contact::PointshellContact contact(scene.shell.nodes.size());
    const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
    const contact::ContactPair empty{&none, {}, &scene.map, {}, true}, no_map{&scene.shell, {}, nullptr, {}, true};
    const contact::ContactPair no_pose{&scene.shell, {Vec3(nan, 0, 0), Quat(1, 0, 0, 0)}, &scene.map, {}, true};
    const contact::ContactPair no_turn{&scene.shell, {}, &scene.map, {Vec3(0.0), Quat(nan, 0, 0, 0)}, true};
    const contact::ContactPair away{&scene.shell, {Vec3(huge, 0, 0), Quat(1, 0, 0, 0)}, &scene.map, {}, true};
    for (const contact::ContactPair& pair : {empty, no_map, no_pose, no_turn, away, contact::ContactPair{}}) {
        const contact::ContactSum sum = contact({&pair, 1}, Vec3(0.0), {});
        CHECK(sum.energy == 0.0);
        CHECK(sum.evaluated == 0);
    }
    const contact::ContactPair touching{&scene.shell, {Vec3(0.014, 0, 0), Quat(1, 0, 0, 0)}, &scene.map, {}, true};
    CHECK(contact({&touching, 1}, Vec3(0, nan, 0), {}).energy == 0.0);
    CHECK(contact({&touching, 1}, Vec3(0.0), {}).in_contact > 0);
    CHECK(contact({}, Vec3(0.0), {}).energy == 0.0);
    // Half of the shell outside of the grid; a field that is flat; a body in itself.
    const contact::ContactPair border{&scene.shell, {Vec3(0.0215, 0.0, 0.0), Quat(1, 0, 0, 0)}, &scene.map, {}, true};
    const contact::ContactSum exact =
        contact::contact_reference({&border, 1}, Vec3(0.0), {.stiffness = 1e4, .blend = 0.008});
    const contact::ContactSum fast = contact({&border, 1}, Vec3(0.0), {.stiffness = 1e4, .blend = 0.008});
    CHECK(exact.in_contact > 100);
    CHECK(fast.in_contact == exact.in_contact);
    CHECK(apart(exact, fast) < 1e-5 * exact.total_force);
    const contact::Voxmap flat =
        contact::sample_voxmap(contact::centred_layout(20, 1e-3), [](const Vec3&) { return -1e-3; });
    const contact::ContactPair plateau{&scene.shell, {}, &flat, {}, true};
    const contact::ContactSum level = contact({&plateau, 1}, Vec3(0.0), {});
    CHECK(level.in_contact == 3000);
    CHECK(level.energy > 0.0);
    for (const double g : level.gradient) CHECK(g == 0.0);
}
