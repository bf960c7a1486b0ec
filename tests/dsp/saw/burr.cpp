// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/burr.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double radius = 0.002;

struct Milling {
    volume::BoneEditor& bone;
    double rate = 1000.0;
    bool running = true;
    saw::Burr burr{{radius, 8.0}, 20e3};
    saw::CuttingLaw law;
    carve::Carver carver;
    std::vector<carve::CutFront> path;
    volume::BoneSnapshot read = bone.current();
    double removed = 0.0;
    int ticks = 0, carved = 0;

    explicit Milling(volume::BoneEditor& bone_, double rate_ = 1000.0) : bone(bone_), rate(rate_) {
        carve::CarveSettings settings;
        settings.kerf = 2.0 * radius;
        settings.tooth_pitch = saw::tooth_pitch;
        settings.blade_length = (carve::CutFront::max_nodes - 1) * settings.tooth_pitch - settings.stroke;
        carver.prepare(bone, settings);
    }

    saw::BurrContact step(const Vec3& at) {
        const Pose pose{at, teeth_down};
        const saw::BurrContact contact = burr.step(read, pose, {running, 1000.0, 1.0 / rate}, law);
        burr.fill(path.emplace_back(), pose, running);
        if (++ticks * 60.0 >= (carved + 1) * rate) {
            ++carved;
            read = bone.publish();
            bone.reclaim(read.version);
            removed += carver.update(bone, path).removed_m3;
            path.clear();
        }
        return contact;
    }
};

/// Sinks a burr under a constant force; m of depth after `seconds`.
double sink(double force, double rate, double voxel, double seconds = 1.0) {
    const auto bone = bone_block({.voxel = voxel});
    Milling milling(*bone, rate);
    Vec3 at(0.0, 0.0, radius + 0.1e-3);
    double start = 0.0;
    const int ticks = static_cast<int>((0.3 + seconds) * rate);
    for (int n = 0; n < ticks; ++n) {
        if (n == static_cast<int>(0.3 * rate)) start = milling.burr.at().z;
        const saw::BurrContact now = milling.step(at);
        at.z -= (force - now.wrench.force.z) / 300.0 / rate;
    }
    return start - milling.burr.at().z;
}

}  // namespace

TEST_CASE("a burr sinks faster the harder it is pressed and not at all below its threshold") {
    // The flute of a ball of 4 mm rubs up to 4 times the force at which one of 1 mm does.
    const double rubbing = 4.0 * saw::CuttingLaw{}.rub;
    const double soft = sink(rubbing + 1.0, 1000.0, 0.33e-3), firm = sink(rubbing + 4.0, 1000.0, 0.33e-3);
    CHECK(sink(0.5, 1000.0, 0.33e-3) < 0.05e-3);
    // Down to where the chord of the ball in bone is so wide that it rubs.
    CHECK(sink(0.9 * rubbing, 1000.0, 0.33e-3, 2.0) < radius * (1.0 - std::sqrt(1.0 - 0.81)) + 0.05e-3);
    CHECK(soft > 0.2e-3);
    CHECK(firm > 1.8 * soft);
}

TEST_CASE("a flute of a burr cuts by the same force per width as a tooth of a saw") {
    // 8 flutes of 4 mm, 1000 turns a second, each a depth by the force on a millimetre; the hand takes 300 N s/m. Under
    // less force the rim of the ball does not bear any more.
    for (const double force : {10.0, 14.0}) {
        const double speed = sink(force, 1000.0, 0.33e-3, 0.3) / 0.3;
        const double depth = saw::CuttingLaw{}.depth((force - 300.0 * speed) / 4.0).depth;
        CHECK(speed == Approx(8.0 * 1000.0 * depth).epsilon(0.03));
    }
}

TEST_CASE("a burr leaves a hole as wide as its ball, whatever its size and wherever it goes") {
    for (const double size : {1.5e-3, 4e-3, 7e-3})
        for (const Vec3& way : {Vec3(0.0, 0.0, -1.0), Vec3(1.0, 0.0, 0.0), Vec3(0.6, 0.0, -0.8), Vec3(0.0, 1.0, 0.0)}) {
            // Large enough for all of the ball on its way; the band must hold its radius.
            const auto bone =
                bone_block({{-0.008, -0.008, -0.013}, {0.008, 0.008, 0.0}, size > 5e-3 ? 0.6e-3 : 0.33e-3});
            carve::Carver carver;
            carve::CarveSettings settings;
            settings.kerf = size;
            settings.tooth_pitch = saw::tooth_pitch;
            settings.blade_length = (carve::CutFront::max_nodes - 1) * settings.tooth_pitch - settings.stroke;
            carver.prepare(*bone, settings);
            constexpr double length = 2e-3;
            const Vec3 start(0.0, 0.0, -0.5 * size - 0.5e-3);
            std::vector<carve::CutFront> path;
            double before = 0.0;
            for (int n = 0; n <= 200; ++n) {
                carve::CutFront& front = path.emplace_back();
                front.pose = {start + way * (length * n / 200.0), teeth_down};
                front.kerf = size;
                front.pitch = 0.5 * size;
                front.count = 2;
                front.running = 1;
                front.seated = 3;
                front.fresh = n == 0 ? 3 : 0;
                front.place(0, front.pose.position);
                front.place(1, front.pose.position);
                if (n % 20 != 0) continue;
                carver.update(*bone, path);
                bone->reclaim(bone->publish().version);
                path.clear();
                if (n == 0) before = carver.removed_m3();
            }
            const double radius = 0.5 * size, disc = 3.14159265 * radius * radius;
            CAPTURE(size, way.x, way.y, way.z, before * 1e9);
            CHECK(before == Approx(disc * radius * 4.0 / 3.0).epsilon(0.05));
            CHECK(carver.removed_m3() - before == Approx(disc * length).epsilon(0.05));
        }
}

TEST_CASE("how fast a burr sinks does not depend on the rate of the force nor on the voxel") {
    const double reference = sink(5.0, 1000.0, 0.33e-3);
    for (const double rate : {250.0, 2000.0}) CHECK(sink(5.0, rate, 0.33e-3) == Approx(reference).epsilon(0.02));
    for (const double voxel : {0.2e-3, 0.5e-3}) CHECK(sink(5.0, 1000.0, voxel) == Approx(reference).epsilon(0.02));
}

TEST_CASE("a burr gives no energy and does not pull on closed paths, running or not") {
    for (const bool running : {false, true})
        for (const Vec3& aside : {Vec3(0.0), Vec3(0.010, 0.0, 0.0), Vec3(0.003, 0.006, 0.0)}) {
            const auto bone = bone_block({.voxel = 0.33e-3});
            Milling milling(*bone);
            milling.running = running;
            double work = 0.0, bound = 0.0, pull = 0.0, most = 0.0;
            Vec3 last(0.0, 0.0, 0.005), last_force(0.0);
            const auto eased = [](double s, double a, double b) {
                const double u = std::clamp((s - a) / (b - a), 0.0, 1.0);
                return u * u * (3.0 - 2.0 * u);
            };
            for (int n = 0; n <= 2000; ++n) {
                const double s = n / 2000.0;
                const Vec3 at = Vec3(0.0, 0.0, 0.005 - 0.0045 * (eased(s, 0.0, 0.4) - eased(s, 0.8, 1.0))) +
                                aside * (eased(s, 0.4, 0.6) - eased(s, 0.6, 0.8));
                const Vec3 force = milling.step(at).wrench.force;
                work += glm::dot(last_force, at - last);
                bound += 0.5 * std::min(std::abs(glm::dot(force - last_force, at - last)),
                                        20e3 * glm::dot(at - last, at - last));
                pull = std::max(pull, -force.z);
                most = std::max(most, glm::length(force));
                last = at;
                last_force = force;
            }
            CAPTURE(running, aside.x, aside.y, work, bound, pull, most, milling.removed * 1e9);
            CHECK(work <= 1.02 * bound + 1e-9);
            CHECK(pull < 0.05 * most);
            CHECK(most > 1.0);
            CHECK((milling.removed > 0.0) == running);
            CHECK(glm::length(last_force) == 0.0);
        }
}
