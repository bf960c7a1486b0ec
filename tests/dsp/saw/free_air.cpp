// SPDX-License-Identifier: Apache-2.0
// A tool that bone does not hold has no force, however fast a hand moves it through the air.
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/saw/burr.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

const BoneBox middle_block{
    .low = {-0.03, -0.006, -0.012}, .high = {0.03, 0.006, 0.0}, .voxel = 0.5e-3, .margin = 0.003};

double distance_to_block(const Vec3& p) {
    const Vec3 q = glm::max(middle_block.low - p, p - middle_block.high);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

/// A tool and places on it that are no more than a millimetre apart.
struct Moved {
    std::string name;
    std::optional<saw::SawBlade> blade;
    std::optional<saw::Burr> burr;
    std::vector<Vec3> places;
    double radius = 0.0;

    static Moved of_blade(const std::string& name, const saw::SawShape& shape) {
        Moved tool{name, saw::SawBlade(shape, 20e3), {}, {}, 0.5 * shape.kerf + 0.2e-3};
        const double half = 0.5 * (shape.length + shape.stroke) + shape.pitch;
        for (double x = -half; x <= half; x += 1e-3)
            for (double y = 0.0; y <= shape.height; y += 1e-3) tool.places.emplace_back(x, -y, 0.0);
        return tool;
    }
    static Moved of_burr() {
        const saw::BurrShape shape{0.002, 8.0, 1.175e-3, 0.025};
        Moved tool{"burr", {}, saw::Burr(shape, 20e3), {}, shape.radius};
        for (double y = 0.0; y <= shape.radius + shape.shaft_length; y += 1e-3) tool.places.emplace_back(0.0, -y, 0.0);
        return tool;
    }

    bool is_clear(const Pose& from, const Pose& to, double gap) const {
        const double way = glm::length(to.position - from.position) +
                           0.1 * glm::length(rotation_between(from.orientation, to.orientation));
        const int steps = 1 + static_cast<int>(way / 1e-3);
        for (int n = 0; n <= steps; ++n) {
            const double share = static_cast<double>(n) / steps;
            const Pose here{glm::mix(from.position, to.position, share),
                            glm::slerp(from.orientation, to.orientation, share)};
            for (const Vec3& place : places)
                if (distance_to_block(here.apply(place)) < radius + gap) return false;
        }
        return true;
    }

    double magnitudes(const volume::BoneSnapshot& bone, const Pose& pose, const saw::Drive& drive) {
        return burr ? burr->step(bone, pose, drive, {}).magnitudes : blade->step(bone, pose, drive, {}).magnitudes;
    }
};

std::vector<Moved> tools() {
    saw::SawShape sagittal;
    sagittal.kind = saw::SawKind::sagittal;
    sagittal.length = 0.02;
    sagittal.height = 0.06;
    sagittal.thickness = 0.8e-3;
    std::vector<Moved> all;
    all.push_back(Moved::of_blade("reciprocating", {}));
    all.push_back(Moved::of_blade("sagittal", sagittal));
    all.push_back(Moved::of_burr());
    return all;
}

}  // namespace

// Costly: three tools at five speeds and three rates, past all kinds of edges.
TEST_CASE("a tool has no force in the air at up to 10 m per s, at any rate") {
    const Random random{11};
    const auto bone = bone_block(middle_block);
    constexpr double gap = 0.3e-3;  // m: no part of the tool comes nearer to bone
    std::uint64_t draw = 0;
    const auto next = [&] { return random.uniform(draw++); };
    const auto direction = [&] { return glm::normalize(Vec3(next() - 0.5, next() - 0.5, next() - 0.5)); };
    for (const double rate : {500.0, 1000.0, 4000.0})
        for (const double speed : {0.3, 1.5, 2.9, 3.2, 10.0})
            for (Moved& tool : tools()) {
                double most = 0.0;
                int clear = 0;
                for (int way = 0; way < 30; ++way) {
                    const saw::Drive drive{way % 2 == 0, 228.0, 1.0 / rate};
                    const Quat attitude = glm::normalize(rotation_by(0.5 * direction()) * teeth_down);
                    // From above down to the bone, then straight on in any direction, past its faces, edges and corners.
                    Pose pose{{0.05 * (next() - 0.5), 0.02 * (next() - 0.5), 0.05}, attitude};
                    while (tool.is_clear(pose, {pose.position - Vec3(0.0, 0.0, 0.2e-3), attitude}, gap) &&
                           pose.position.z > -0.01)
                        pose.position.z -= 0.2e-3;
                    const Vec3 velocity = speed * direction(), turn = 3.0 * direction();
                    Moved fresh = tool;
                    for (int n = 0; n < 20; ++n) {
                        most = std::max(most, fresh.magnitudes(bone->current(), pose, drive));
                        const Pose to{pose.position + velocity / rate,
                                      glm::normalize(rotation_by(turn / rate) * pose.orientation)};
                        if (glm::length(to.position) > 0.06 || !tool.is_clear(pose, to, gap)) break;
                        pose = to;
                        ++clear;
                    }
                }
                CAPTURE(tool.name, rate, speed, clear);
                CHECK(most == 0.0);
                CHECK(clear > 3);
            }
}

TEST_CASE("a tool that leaves bone has no force once all of it is clear, at up to 2.9 m per s") {
    const Random random{12};
    const auto bone = bone_block(middle_block);
    constexpr double gap = 0.3e-3;
    std::uint64_t draw = 0;
    const auto next = [&] { return random.uniform(draw++); };
    for (const double rate : {500.0, 1000.0})
        for (const double speed : {0.3, 1.5, 2.9})
            for (Moved& tool : tools()) {
                double most = 0.0, held = 0.0;
                int clear = 0;
                for (int way = 0; way < 20; ++way) {
                    const saw::Drive drive{false, 228.0, 1.0 / rate};
                    Moved fresh = tool;
                    Pose pose{{0.03 * (next() - 0.5), 0.006 * (next() - 0.5), 0.0075}, teeth_down};
                    const double low = tool.burr ? 1.7e-3 : -0.3e-3;
                    for (; pose.position.z > low; pose.position.z -= 0.2e-3)
                        held = std::max(held, fresh.magnitudes(bone->current(), pose, drive));
                    const Vec3 away =
                        speed * glm::normalize(Vec3(2.0 * next() - 1.0, 2.0 * next() - 1.0, 0.3 + next()));
                    for (int n = 0; n < 6; ++n) {
                        pose.position += away / rate;
                        const double force = fresh.magnitudes(bone->current(), pose, drive);
                        if (!tool.is_clear(pose, pose, gap)) continue;
                        most = std::max(most, force);
                        ++clear;
                    }
                }
                CAPTURE(tool.name, rate, speed, clear, held);
                CHECK(held > 1.0);
                CHECK(most == 0.0);
                CHECK(clear > 3);
            }
}

TEST_CASE("a blade that was drawn through bone it had not cut has no force in the air, however the hand trembles") {
    const Random random{13};
    std::uint64_t draw = 0;
    const auto next = [&] { return random.uniform(draw++) - 0.5; };
    int passed = 0;
    for (int way = 0; way < 8; ++way) {
        const auto bone = bone_block({.voxel = 0.5e-3});
        Sawing sawing(*bone);
        Pushing hand;
        sawing.law = saw::CuttingLaw{}.with_edge(sawing.shape.kerf).sharpened(6.0);
        hand.push(sawing, 12.0, 0.8);
        // The hand twists the blade in its kerf and draws it out askew, by 12 mm; then it trembles in the air.
        const Vec3 away(0.02 * next(), 0.01 * next(), 0.012), turn(0.5 * next(), 0.5 * next(), 0.5 * next());
        double most = 0.0;
        for (int n = 0; n <= 800; ++n) {
            const double share = std::min(n / 80.0, 1.0);
            const Vec3 tremor = 0.5e-3 * Vec3(std::sin(0.05 * n), std::sin(0.063 * n), std::sin(0.041 * n));
            const double force = sawing
                                     .step({hand.position + share * away + tremor,
                                            glm::normalize(rotation_by(share * turn) * teeth_down)})
                                     .magnitudes;
            if (n == 80)
                for (const saw::Tooth& tooth : sawing.blade.teeth().teeth()) passed += !tooth.seated;
            if (n >= 600) most = std::max(most, force);
        }
        CAPTURE(way);
        CHECK(most == 0.0);
    }
    CHECK(passed > 10);  // teeth that left through bone
}
