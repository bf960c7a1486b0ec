// SPDX-License-Identifier: Apache-2.0
// A blade in the slot of a cutting guide.
#include "dsp/saw/guide_slot.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/saw/hand_limits.hpp"
#include "dsp/simulate/script.hpp"
#include "dsp/training/removed.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double clearance = 0.25 * mm, depth = 15.0 * mm, kerf = 1.0 * mm;
const double play = std::atan(2.0 * clearance / depth);

saw::SawShape guided_blade() {
    saw::SawShape shape;
    shape.kind = saw::SawKind::sagittal;
    shape.length = 12.0 * mm;
    shape.height = 40.0 * mm;
    shape.kerf = kerf;
    return shape;
}

/// Above a bone whose top is z = 0, for a cut in the plane y = 0, from 0.5 mm above the bone on.
saw::GuideSlot slot_above() {
    saw::GuideSlot slot;
    slot.frame = {Vec3(0.0), teeth_down};
    slot.low = -10.0 * mm, slot.high = 10.0 * mm;
    slot.top = -0.5 * mm - depth, slot.bottom = -0.5 * mm;
    slot.wall = -0.5 * kerf;
    slot.other_wall = slot.wall + kerf + 2.0 * clearance;
    return slot;
}

double to_box(const Vec3& p, const Vec3& low, const Vec3& high) {
    const Vec3 q = glm::max(low - p, p - high);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

/// The guide of that slot: walls of 3 mm, closed at both ends.
std::unique_ptr<volume::BoneEditor> guide_above() {
    const Vec3 low(-13.0 * mm, -4.0 * mm, 0.5 * mm), high(13.0 * mm, 4.5 * mm, 15.5 * mm);
    // The normal of the cut is y: stroke x, feed -z.
    return bone_where({.low = low, .high = high, .voxel = 0.3 * mm}, [=](const Vec3& p) {
        const double hole = to_box(p, Vec3(-10.0 * mm, -0.5 * mm, -1.0), Vec3(10.0 * mm, 1.0 * mm, 1.0));
        return std::max(to_box(p, low, high), -hole);
    });
}

/// Greatest distance by which a blade as thick as its kerf passes the walls, m; negative: it is between them.
double beyond_walls(const saw::GuideSlot& slot, const saw::SawShape& shape, const Pose& pose) {
    double most = -1.0;
    const Pose local = slot.frame.inverse() * pose;
    for (int i = 0; i <= 60; ++i)
        for (int j = 0; j <= 200; ++j) {
            const Vec3 p = local.apply(Vec3(shape.length * (i / 60.0 - 0.5), -shape.height * j / 200.0, 0.0));
            if (p.x < slot.low || p.x > slot.high || p.y < slot.top || p.y > slot.bottom) continue;
            most = std::max({most, slot.wall + 0.5 * kerf - p.z, p.z + 0.5 * kerf - slot.other_wall});
        }
    return most;
}

struct Hand {
    const char* name;
    double tilt = 0.0, shake = 0.0;  // rad, m
};

struct Result {
    double offset = 0.0, angle = 0.0, max = 0.0, force = 0.0, work = 0.0, bound = 0.0, jump = 0.0;
};

/// Saws through a plate of 4 mm with or without the guide.
Result saw_with(const Hand& hand, bool guided) {
    const BoneBox plate{.low = {-6.0 * mm, -4.0 * mm, -4.0 * mm}, .high = {6.0 * mm, 4.0 * mm, 0.0}};
    const auto bone = bone_block(plate), guide = guide_above();
    const volume::Grid before = volume::to_grid(bone->current());
    const volume::BoneSnapshot solid = guide->current();
    Sawing sawing(*bone, 1000.0, 40e3, guided_blade());
    sawing.law = saw::CuttingLaw{}.sharpened(6.0);
    if (guided) sawing.guide = &solid;
    const std::vector<saw::GuideSlot> slots{slot_above()};
    saw::SlotHold hold(guided_blade(), {.stiffness = 10e3, .thickness = kerf});
    const Quat straight = teeth_down, tilted = rotation_by(Vec3(hand.tilt, 0.0, 0.0)) * teeth_down;
    // In over the mouth, straight; then the hand tilts.
    simulate::ScriptOperator moves({{0.0, {Vec3(0.0, 0.0, 18.0 * mm), straight}},
                                    {0.5, {Vec3(0.0, 0.0, 1.0 * mm), straight}},
                                    {0.8, {Vec3(0.0, 0.0, 1.0 * mm), tilted}},
                                    {4.3, {Vec3(0.0, 0.0, -8.0 * mm), tilted}},
                                    {4.6, {Vec3(0.0, 0.0, -8.0 * mm), straight}},
                                    {5.2, {Vec3(0.0, 0.0, 18.0 * mm), straight}}},
                                   {});
    simulate::Hand held;
    held.dynamics.stiffness = 2e3;
    held.dynamics.damping = 30.0;
    held.pose = moves.start();
    const auto intend = [&](double h, const Wrench& force, const Pose& at) {
        simulate::Intention wanted = moves(h, force, at);
        const double t = moves.time();
        // Slowly, so that the bone is met at an extreme.
        if (t > 0.6 && t < 4.6) wanted.pose.position.y += hand.shake * std::sin(2.0 * M_PI * 0.5 * (t - 0.6));
        // Strokes of 2 mm, to and fro.
        wanted.pose.position.x += 2.0 * mm * std::sin(2.0 * M_PI * t);
        return wanted;
    };
    Wrench felt;
    Vec3 last_of_slot(0.0);
    Result result;
    for (int n = 0; n < 5300; ++n) {
        const Pose last = held.pose;
        simulate::advance(held, intend, felt, 1e-3);
        const Pose at = guided ? hold.follow(slots, held.pose, 1e-3) : held.pose;
        const saw::SawContact contact = sawing.step(at);
        const Wrench now = guided ? hold.on_hand(contact.wrench) : contact.wrench;
        const Vec3 way = held.pose.position - last.position,
                   turn = rotation_between(last.orientation, held.pose.orientation);
        result.work += glm::dot(felt.force, way) + glm::dot(felt.torque, turn);
        result.bound += 0.5 * (std::abs(glm::dot(now.force - felt.force, way)) +
                               std::abs(glm::dot(now.torque - felt.torque, turn)));
        // The part of the slot alone: bone that breaks has jumps of its own.
        const Vec3 of_slot = now.force - contact.wrench.force;
        result.jump = std::max(result.jump, glm::length(of_slot - last_of_slot));
        last_of_slot = of_slot;
        result.force = std::max(result.force, glm::length(now.force));
        felt = now;
    }
    const volume::Grid after = volume::to_grid(bone->publish());
    training::PlannedCut cut;  // feed -z, stroke x, normal y
    cut.depth = 4.0 * mm;
    const auto plane = training::fit_cut_plane({before, after}, cut, kerf);
    REQUIRE(plane);
    REQUIRE(plane->angle);
    result.angle = *plane->angle;
    result.max = plane->max;
    for (const training::CutPoint& p : plane->points)
        result.offset += p.offset / static_cast<double>(plane->points.size());
    CHECK(result.work <= 1.02 * result.bound + 1e-6);
    return result;
}

}  // namespace

TEST_CASE("a blade that a slot holds never passes its walls, wherever the hand goes") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    const Random random{7};
    int touched = 0;
    for (std::uint64_t run = 0; run < 20; ++run) {
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        const auto wave = [&](std::uint64_t n, double t) {
            return random.normal(100 * run + n) * std::sin((1.0 + 3.0 * random.uniform(100 * run + n + 20)) * t);
        };
        for (int n = 0; n <= 3000; ++n) {
            const double t = n * 1e-3, in = std::min(1.0, t / 0.4);
            const Pose hand{Vec3(4.0 * mm * wave(1, t), 0.25 * mm + 2.0 * mm * in * wave(2, t),
                                 18.0 * mm - 18.0 * mm * in + 3.0 * mm * wave(3, t)),
                            rotation_by(in * 0.2 * Vec3(wave(4, t), wave(5, t), wave(6, t))) * teeth_down};
            const Pose at = hold.follow(slots, hand, 1e-3);
            REQUIRE(is_valid(at));
            if (hold.slot() < 0 || n % 20 != 0) continue;
            // 0.3 mm: room that a blade keeps which missed the slot by so much at its mouth.
            REQUIRE(beyond_walls(slots[0], shape, at) < 0.31 * mm);
            touched += hold.force() > 0.1;
            // In the plane of the slot the hand is free.
            REQUIRE(std::abs((at.position - hand.position).x) < 4.0 * mm);
        }
    }
    CHECK(touched > 50);
}

TEST_CASE("a blade that entered a slot with play feels nothing within the walls and the wall where it is") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    double first = 0.0;
    for (const double entered : {0.0, 0.1, 0.25, 0.4, 0.5}) {
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        const auto at = [&](double aside) {
            hold.follow(slots, {Vec3(0.0, aside, 5.0 * mm), teeth_down}, 1e-3);
            return glm::length(hold.on_hand({}).force);
        };
        CAPTURE(entered);
        CHECK(at(entered * mm) == 0.0);
        REQUIRE(hold.slot() == 0);
        for (double aside = 0.0; aside <= 0.5; aside += 0.05) CHECK(at(aside * mm) < 1e-6);
        // 0.1 mm beyond either wall, at which the spring of 10 N/mm turns the blade about its clamp.
        const double force = at(0.6 * mm);
        CHECK(force > 0.05);
        CHECK(force < 1.0);
        CHECK(at(-0.1 * mm) == Approx(force).epsilon(1e-3));
        if (entered == 0.0) first = force;
        CHECK(force == Approx(first).epsilon(1e-6));
    }
}

TEST_CASE("a ledge is reached from afar without a force, and lets the blade go on to the next slot") {
    const saw::SawShape shape = guided_blade();
    saw::GuideSlot ledge = slot_above(), slot = slot_above();
    ledge.other_wall = infinity;
    slot.frame.position.y = 20.0 * mm;
    // The list puts the ledge first: the slot is nearer all the same.
    const std::vector<saw::GuideSlot> slots{ledge, slot};
    saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
    const auto at = [&](double aside) {
        hold.follow(slots, {Vec3(0.0, aside, 5.0 * mm), teeth_down}, 1e-3);
        return glm::length(hold.on_hand({}).force);
    };
    for (double aside = 8.0; aside >= 0.0; aside -= 0.1) CHECK(at(aside * mm) < 1e-6);
    CHECK(hold.slot() == 0);
    CHECK(at(-0.1 * mm) > 0.05);
    for (double aside = 0.0; aside <= 20.2; aside += 0.1) CHECK(at(aside * mm) < 1e-6);
    CHECK(hold.slot() == 1);
    CHECK(at(20.6 * mm) > 0.05);
}

/// Two ledges of facing cuts on one bone, whose planes cross that far above it. Angles above 0: the other ledge leans away, and
/// above the crossing they face each other. Below 0: it leans over the first one, and above the crossing they stand back to
/// back, as those of a fibula's segments do.
std::vector<saw::GuideSlot> crossing_ledges(double angle, double height) {
    saw::GuideSlot one = slot_above(), other = slot_above();
    one.other_wall = other.other_wall = infinity;
    const Quat lean = rotation_by(Vec3(-angle, 0.0, 0.0));
    other.frame.orientation = lean * glm::angleAxis(M_PI, Vec3(0.0, 0.0, 1.0)) * teeth_down;
    other.frame.position = Vec3(0.0, 0.0, height) - lean * Vec3(0.0, 0.0, height);
    return {one, other};
}

TEST_CASE("of two ledges whose planes cross, a hand saws in either, wherever it comes from") {
    const saw::SawShape shape = guided_blade();
    const Random random{29};
    std::uint64_t run = 0;
    for (const double angle : {-40.0, -28.0, -20.0, -10.0, -5.0, 5.0, 10.0, 20.0, 28.0, 40.0})
        for (const double height : {0.5, 1.0, 2.0, 3.5, 5.0})
            for (const std::size_t cut : {0u, 1u})
                for (int approach = 0; approach < 4; ++approach, ++run) {
                    const auto drawn = [&](std::uint64_t n) { return random.uniform(20 * run + n); };
                    std::vector<saw::GuideSlot> slots = crossing_ledges(angle * degree, height * mm);
                    // One of the blocks may be higher than the other: the blade meets the wrong mouth first.
                    if (angle > 0.0) slots[1 - cut].top -= 3.0 * mm * drawn(1);
                    const Pose plan = slots[cut].frame;
                    saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
                    // A hand that does not lie on plan: away from its ledge, turned in the cut and along it.
                    const Vec3 off(4.0 * mm * (drawn(2) - 0.5), 0.0, 0.1 * mm * drawn(3));
                    const double leans = 0.1 * std::abs(angle) * degree * drawn(4);
                    const Quat turn = rotation_by(Vec3(-leans, 0.0, drawn(5) - 0.5));
                    CAPTURE(angle, height, cut, approach);
                    double farthest = 0.0, turned = 0.0, force = 0.0;
                    const auto go = [&](const Pose& hand) {
                        const Pose at = hold.follow(slots, hand, 1e-3);
                        farthest = std::max(farthest, glm::length(at.position - hand.position));
                        turned = std::max(turned, glm::length(rotation_between(hand.orientation, at.orientation)));
                        force = std::max(force, glm::length(hold.on_hand({}).force));
                    };
                    // Over both blocks, from beside them, as straight as it was in another cut.
                    const Pose above = plan * Pose{off + Vec3(0.0, -24.0 * mm, 0.0), turn};
                    const Pose beside{above.position + Vec3(0.0, 60.0 * mm * (drawn(6) - 0.5), 5.0 * mm * drawn(7)),
                                      rotation_by(Vec3(2.0 * (drawn(8) - 0.5), 0.0, 0.0)) * above.orientation};
                    for (int n = 0; n <= 1000; ++n)
                        go({glm::mix(beside.position, above.position, n / 1000.0),
                            glm::slerp(beside.orientation, above.orientation, n / 1000.0)});
                    for (int n = 0; n <= 2000; ++n)
                        go(plan * Pose{off + Vec3(0.0, -24.0 * mm + 32.0 * mm * n / 2000.0, 0.0), turn});
                    CHECK(hold.slot() == static_cast<int>(cut));
                    CHECK(farthest < 1.0 * mm);
                    CHECK(turned < 0.1 * std::abs(angle) * degree + 0.01);
                    CHECK(force < 1.0);
                }
}

TEST_CASE("between two ledges a hand passes without a force, and one that presses in the other's plane changes over") {
    const saw::SawShape shape = guided_blade();
    for (const double angle : {-40.0, -28.0, -20.0, -10.0, 5.0, 10.0, 20.0, 28.0, 40.0})
        for (const double height : {0.5, 2.0, 5.0}) {
            const std::vector<saw::GuideSlot> slots = crossing_ledges(angle * degree, height * mm);
            CAPTURE(angle, height);
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            double force = 0.0, largest = 0.0;
            Wrench last;
            const auto go = [&](const Pose& hand) {
                hold.follow(slots, hand, 1e-3);
                const Wrench now = hold.on_hand({});
                force = std::max(force, glm::length(now.force));
                largest = std::max(largest, glm::length(now.force - last.force));
                last = now;
            };
            // Where they face each other, from one to the other and back.
            const auto between = [&](double share) {
                const Quat lean = rotation_by(Vec3(-share * angle * degree, 0.0, 0.0));
                return Pose{Vec3(0.0, 0.0, height * mm) +
                                lean * Vec3(0.0, 0.0, std::max(0.6 * mm / std::sin(angle * degree), 7.0 * mm)),
                            lean * teeth_down};
            };
            if (angle > 0.0) {
                for (int n = 0; n <= 2000; ++n) {
                    go(between(0.02 + 0.96 * (1.0 - std::abs(n / 1000.0 - 1.0))));
                    if (n == 200 || n == 1000) CHECK(hold.slot() == (n == 1000));
                }
                CHECK(hold.slot() == 0);
                CHECK(force < 1e-6);
                continue;
            }
            // Along the first ledge into the bone, and there, against it, into the plane of the second one.
            const auto on = [&](std::size_t n, double deep) {
                return slots[n].frame * Pose{Vec3(0.0, deep, 0.05 * mm), {1.0, 0.0, 0.0, 0.0}};
            };
            for (int n = 0; n <= 500; ++n) go(on(0, -20.0 * mm + 24.0 * mm * n / 500.0));
            CHECK(hold.slot() == 0);
            const Pose from = on(0, 4.0 * mm), to = on(1, 4.0 * mm);
            const Quat turned = to.orientation * glm::angleAxis(M_PI, Vec3(0.0, 1.0, 0.0));
            for (int n = 0; n <= 1500; ++n) {
                const double share = std::min(1.0, n / 1000.0);
                go({glm::mix(from.position, to.position, share), glm::slerp(from.orientation, turned, share)});
            }
            CHECK(hold.slot() == 1);
            CHECK(glm::length(last.force) < 0.5);
            CAPTURE(force);
            CHECK(largest < 0.05 * force);
        }
}

/// A tilted blade with its teeth at `aside` and `height`. Angles above 0: its clamp leans away from the wall at y = 0.
Pose tilted_by(double angle, double aside, double height) {
    return {Vec3(0.0, aside, height), rotation_by(Vec3(-angle * degree, 0.0, 0.0)) * teeth_down};
}

TEST_CASE("a tilted blade that is drawn out of its slot feels nothing from 1 mm above the mouth and a fade on") {
    const saw::SawShape shape = guided_blade();
    constexpr double mouth = 15.5 * mm, speed = 20.0 * mm;
    for (const bool is_ledge : {false, true})
        for (const double angle : {-45.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 45.0}) {
            std::vector<saw::GuideSlot> slots{slot_above()};
            if (is_ledge) slots[0].other_wall = infinity;
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            // About the clamp. At 45 degrees the teeth are 4 mm within the slot.
            const auto turned = [&](double share, double up) {
                const Quat turn = rotation_by(Vec3(-share * angle * degree, 0.0, 0.0));
                return Pose{Vec3(0.0, 0.1 * mm, up + shape.height) - turn * Vec3(0.0, 0.0, shape.height),
                            turn * teeth_down};
            };
            double in_air = 0.0, above = 0.0, step = 0.0, inside = 0.0;
            Wrench last;
            const auto go = [&](const Pose& hand) {
                hold.follow(slots, hand, 1e-3);
                const Wrench now = hold.on_hand({});
                const double height = hand.position.z - mouth, size = glm::length(now.force);
                step = std::max(step, glm::length(now.force - last.force));
                (height > 0.0 ? in_air : inside) = std::max(height > 0.0 ? in_air : inside, size);
                if (height > 1.0 * mm + speed * saw::SlotHold::fade_time + 0.1 * mm) above = std::max(above, size);
                last = now;
            };
            for (int n = 0; n <= 1000; ++n) go(turned(0.0, 20.0 * mm * (1.0 - n / 1000.0)));
            REQUIRE(hold.slot() == 0);
            for (int n = 0; n <= 1000; ++n) go(turned(n / 1000.0, 0.0));
            for (int n = 0; n <= 1000; ++n) go(turned(1.0, speed * n * 1e-3));
            CAPTURE(is_ledge, angle, inside, in_air, step);
            // Away from a ledge a blade is free.
            const bool is_pressed = is_ledge ? angle > 0.0 : angle != 0.0;
            CHECK((inside > 1.0) == is_pressed);
            CHECK(above == 0.0);
            CHECK(in_air <= 1.2 * inside);
            CHECK(step <= 0.02 * inside);
            CHECK(hold.slot() == -1);
        }
}

TEST_CASE("a ledge takes no blade that is tilted by more than 11.5 degrees, and none of which a part is 3 mm away") {
    const saw::SawShape shape = guided_blade();
    std::vector<saw::GuideSlot> slots{slot_above()};
    slots[0].other_wall = infinity;
    for (const double angle : {-29.0, -20.0, -12.0, 12.0, 20.0, 29.0})
        for (const double aside : {0.1, 0.5, 1.5, 2.5, 2.9}) {
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            CAPTURE(angle, aside);
            double force = 0.0;
            bool is_held = false;
            for (int n = 0; n <= 2000; ++n) {
                hold.follow(slots, tilted_by(angle, aside * mm, 17.5 * mm - 20.0 * mm * n / 2000.0), 1e-3);
                force = std::max(force, glm::length(hold.on_hand({}).force));
                is_held = is_held || hold.slot() >= 0;
            }
            CHECK(!is_held);
            CHECK(force == 0.0);
        }
    // Its teeth are near the wall, and its part at the mouth is not; or the other way round.
    for (const double angle : {-10.0, 10.0})
        for (const double nearest : {0.3, 1.0}) {
            // From the teeth to the mouth of the slot.
            const double span = 14.0 * mm * std::tan(std::abs(angle) * degree);
            const Pose hand = tilted_by(angle, nearest * mm + (angle > 0.0 ? 0.0 : span), 1.5 * mm);
            CAPTURE(angle, nearest);
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            hold.follow(slots, hand, 1e-3);
            CHECK(hold.slot() == (nearest < 0.5 ? 0 : -1));
        }
}

TEST_CASE("a corner dipped into a ledge, taken across it and drawn up gives no force outside") {
    const saw::SawShape shape = guided_blade();
    std::vector<saw::GuideSlot> slots{slot_above()};
    slots[0].other_wall = infinity;
    constexpr double mouth = 15.5 * mm, speed = 20.0 * mm;
    for (const double angle : {-29.0, -25.0, -20.0, -11.0, -5.0, 0.0, 5.0, 11.0, 20.0, 25.0, 29.0})
        for (const double aside : {0.1, 1.5}) {
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            double outside = 0.0, inside = 0.0;
            const auto go = [&](double y, double z) {
                hold.follow(slots, tilted_by(angle, y, z), 1e-3);
                const double force = glm::length(hold.on_hand({}).force);
                inside = std::max(inside, force);
                if (z > mouth + 1.0 * mm + speed * saw::SlotHold::fade_time + 0.1 * mm)
                    outside = std::max(outside, force);
            };
            for (int n = 0; n <= 300; ++n) go(aside * mm, mouth + 4.0 * mm - speed * n * 1e-3);
            for (int n = 0; n <= 1000; ++n) go(aside * mm - 12.0 * mm * n / 1000.0, mouth - 2.0 * mm);
            for (int n = 0; n <= 500; ++n) go((aside - 12.0) * mm, mouth - 2.0 * mm + speed * n * 1e-3);
            CAPTURE(angle, aside, inside);
            CHECK(outside == 0.0);
            if (std::abs(angle) > 11.5) CHECK(inside == 0.0);
        }
}

/// A hand that goes into the slot, presses in all directions, and comes back to where it started.
struct SlotPath {
    Random random;
    std::uint64_t run = 0;

    Pose operator()(double s) const {
        const double in = std::clamp(std::min(s, 1.0 - s) / 0.2, 0.0, 1.0);
        return at(s, in * in * (3.0 - 2.0 * in));
    }
    /// In the slot all the time, from its middle.
    Pose loop(double s) const { return at(s, 1.0); }

private:
    Pose at(double s, double aside) const {
        double v[6] = {};
        for (std::uint64_t axis = 0; axis < 6; ++axis)
            for (std::uint64_t h = 1; h <= 3; ++h)
                v[axis] += random.normal(100 * run + 10 * axis + h) / static_cast<double>(h) *
                           std::sin(2.0 * M_PI * static_cast<double>(h) * s);
        const double loose = std::clamp((aside - 0.5) / 0.5, 0.0, 1.0);
        return {Vec3(3.0 * mm * v[0] * aside, 0.25 * mm + 1.0 * mm * v[1] * loose,
                     20.0 * mm - 18.0 * mm * aside + 3.0 * mm * v[2] * loose),
                rotation_by(0.1 * loose * Vec3(v[3], v[4], v[5])) * teeth_down};
    }
};

/// The largest changes of force and torque between two of 256 steps of a tick that goes from `from` to `to`.
std::array<double, 2> largest_steps(saw::SlotHold hold, const Wrench& on_blade,
                                    const std::vector<saw::GuideSlot>& slots, const SlotPath& path, double from,
                                    double to) {
    std::array<double, 2> largest{};
    Wrench last = hold.on_hand(on_blade);
    for (int n = 1; n <= 256; ++n) {
        hold.follow(slots, path(from + (to - from) * n / 256.0), 1e-3);
        const Wrench now = hold.on_hand(on_blade);
        largest[0] = std::max(largest[0], glm::length(now.force - last.force));
        largest[1] = std::max(largest[1], glm::length(now.torque - last.torque));
        last = now;
    }
    return largest;
}

TEST_CASE("the force of a slot is passive and continuous, wherever a corner of a wedged blade passes one of the slot") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    int refined = 0;
    for (std::uint64_t run = 0; run < 30; ++run) {
        const SlotPath path{Random{11}, run};
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        double work = 0.0, bound = 0.0, most = 0.0, jump = 0.0, jump_of_torque = 0.0;
        Pose last;
        Wrench felt;
        constexpr int ticks = 4000;
        for (int n = 0; n <= ticks; ++n) {
            const double s = static_cast<double>(n) / ticks;
            const Pose hand = path(s);
            const saw::SlotHold before = hold;
            hold.follow(slots, hand, 1e-3);
            const Wrench now = hold.on_hand({});
            if (n > 0) {
                const Vec3 way = hand.position - last.position,
                           turn = rotation_between(last.orientation, hand.orientation);
                work += glm::dot(felt.force, way) + glm::dot(felt.torque, turn);
                bound += 0.5 * (std::abs(glm::dot(now.force - felt.force, way)) +
                                std::abs(glm::dot(now.torque - felt.torque, turn)));
                if (glm::length(now.force - felt.force) > 0.5 || glm::length(now.torque - felt.torque) > 0.02) {
                    ++refined;
                    const auto [of_force, of_torque] = largest_steps(before, {}, slots, path, s - 1.0 / ticks, s);
                    jump = std::max(jump, of_force);
                    jump_of_torque = std::max(jump_of_torque, of_torque);
                }
            }
            most = std::max(most, glm::length(now.force));
            felt = now;
            last = hand;
        }
        CAPTURE(run, work * 1e3, bound * 1e3, most);
        CHECK(work <= 1.02 * bound + 1e-6);
        CHECK(glm::length(felt.force) == 0.0);
        CHECK(most > 1.0);
        CHECK(jump < 0.1);
        CHECK(jump_of_torque < 5e-3);  // an edge of the blade that came to lie along a wall gave 0.16 N·m
    }
    CHECK(refined > 50);
}

TEST_CASE("what the walls carry of a force on the blade changes without a step") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    const Wrench on_blade{{1.0, 2.0, 5.0}, {0.05, -0.04, 0.03}};
    int refined = 0;
    for (std::uint64_t run = 0; run < 8; ++run) {
        const SlotPath path{Random{11}, run};
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        double jump = 0.0, jump_of_torque = 0.0;
        Wrench felt;
        constexpr int ticks = 1000;
        for (int n = 0; n <= ticks; ++n) {
            const double s = static_cast<double>(n) / ticks;
            const saw::SlotHold before = hold;
            hold.follow(slots, path(s), 1e-3);
            const Wrench now = hold.on_hand(on_blade);
            if (n > 0 && (glm::length(now.force - felt.force) > 1.0 || glm::length(now.torque - felt.torque) > 0.04)) {
                ++refined;
                const auto [of_force, of_torque] = largest_steps(before, on_blade, slots, path, s - 1.0 / ticks, s);
                jump = std::max(jump, of_force);
                jump_of_torque = std::max(jump_of_torque, of_torque);
            }
            felt = now;
        }
        CAPTURE(run);
        CHECK(jump < 0.1);
        CHECK(jump_of_torque < 5e-3);
    }
    CHECK(refined > 20);
}

TEST_CASE("a hand does not feel what a wall carries") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    for (const double side : {-1.0, 1.0})
        for (const double pressed : {0.1, 0.2, 0.5}) {
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            const auto hand = [&](double share) {
                return Pose{Vec3(0.0, 0.25 * mm + side * share * (0.25 + pressed) * mm, 0.0), teeth_down};
            };
            for (int n = 0; n <= 300; ++n) hold.follow(slots, hand(n / 300.0), 1e-3);
            REQUIRE(hold.slot() == 0);
            // It presses the blade against the wall at the mouth of the slot, where the clamp is nearest.
            const Vec3 load(0.0, side * 5.0, 0.0);
            const Wrench on_blade{load, glm::cross(Vec3(0.0, 0.0, 15.5 * mm) - hold.pose().position, load)};
            const Wrench with = hold.on_hand(on_blade), without = hold.on_hand({});
            CAPTURE(side, pressed);
            CHECK(glm::length(without.force) > 0.05);
            // At 0.1 mm the wall has not taken over all of it.
            CHECK(glm::length(with.force - without.force) < (pressed > 0.1 ? 0.1 : 1.0));
            CHECK(glm::length(with.torque - without.torque) < (pressed > 0.1 ? 0.002 : 0.02));
            // Away from it, it is felt where the hand is free.
            saw::SlotHold middle(shape, {.stiffness = 10e3, .thickness = kerf});
            for (int n = 0; n <= 300; ++n) middle.follow(slots, hand(0.0), 1e-3);
            CHECK(glm::length(middle.on_hand(on_blade).force - load) < 1e-9);
        }
}

TEST_CASE("a constant load on a held blade does no work on a hand that returns to where it was") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    for (int axis = 0; axis < 6; ++axis)
        for (std::uint64_t run = 0; run < 6; ++run) {
            const SlotPath path{Random{23}, run};
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            Wrench load;
            (axis < 3 ? load.force : load.torque)[axis % 3] = axis < 3 ? 5.0 : 0.1;
            // In the slot, and from its middle once round.
            for (int n = 0; n < 200; ++n) hold.follow(slots, path.loop(0.0), 1e-3);
            double work = 0.0, exchanged = 0.0;
            Pose last = path.loop(0.0), blade = hold.pose();
            Wrench felt = hold.on_hand(load) + hold.on_hand({}) * -1.0;
            constexpr int ticks = 8000;
            for (int n = 1; n <= ticks; ++n) {
                const Pose hand = path.loop(static_cast<double>(n) / ticks);
                hold.follow(slots, hand, 1e-3);
                REQUIRE(hold.slot() == 0);
                const Wrench now = hold.on_hand(load) + hold.on_hand({}) * -1.0, mean = (felt + now) * 0.5;
                const double part = glm::dot(mean.force, hand.position - last.position) +
                                    glm::dot(mean.torque, rotation_between(last.orientation, hand.orientation));
                // A constant torque does work on a blade that turns about several axes.
                const double on_blade =
                    glm::dot(load.torque, rotation_between(blade.orientation, hold.pose().orientation));
                work += part - (axis < 3 ? 0.0 : on_blade);
                exchanged += std::abs(part);
                felt = now;
                last = hand;
                blade = hold.pose();
            }
            CAPTURE(axis, run, work * 1e3, exchanged * 1e3);
            CHECK(std::abs(work) < 0.02 * exchanged + 1e-6);
        }
}

TEST_CASE("what acts on the blade in the plane of its slot does the same work on a hand, however it is tilted") {
    const saw::SawShape shape = guided_blade();
    saw::GuideSlot slot = slot_above();
    slot.other_wall = slot.wall + kerf;  // no play: the blade is in the plane of the slot
    const std::vector<saw::GuideSlot> slots{slot};
    const Random random{17};
    constexpr double h = 1e-6;
    for (std::uint64_t run = 0; run < 20; ++run) {
        const auto drawn = [&](std::uint64_t n) { return random.normal(20 * run + n); };
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        Pose hand{Vec3(0.0, 0.0, 14.0 * mm), teeth_down};
        hold.follow(slots, hand, 1e-3);
        const Vec3 tilt = 0.35 * glm::normalize(Vec3(drawn(1), drawn(2), drawn(3)));
        hand = {Vec3(0.0, 0.2 * mm, 6.0 * mm), rotation_by(tilt) * teeth_down};
        const Pose blade = hold.follow(slots, hand, 1e-3);
        REQUIRE(hold.slot() == 0);
        const Vec3 normal = blade.rotate(Vec3(0.0, 0.0, 1.0));
        REQUIRE(std::abs(normal.y) > 1.0 - 1e-9);
        const Wrench on_blade{Vec3(2.0 * drawn(4), 0.0, 2.0 * drawn(5)), 0.1 * normal};
        const Wrench with = hold.on_hand(on_blade), without = hold.on_hand({});
        for (int axis = 0; axis < 6; ++axis) {
            Vec3 way(0.0), turn(0.0);
            (axis < 3 ? way : turn)[axis % 3] = h;
            saw::SlotHold moved = hold;
            const Pose to = moved.follow(slots, {hand.position + way, rotation_by(turn) * hand.orientation}, 1e-3);
            const double on_guided = glm::dot(on_blade.force, to.position - blade.position) +
                                     glm::dot(on_blade.torque, rotation_between(blade.orientation, to.orientation));
            const double on_hand =
                glm::dot(with.force - without.force, way) + glm::dot(with.torque - without.torque, turn);
            CAPTURE(run, axis, on_guided / h, on_hand / h);
            CHECK(std::abs(on_guided - on_hand) < 1e-3 * 0.1 * h);
        }
    }
}

TEST_CASE("the force of a slot stops growing where a hand is far beyond its walls, and the blade stays in it") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    constexpr double stiffness = 10e3;
    for (const double along : {1.0, 3.0, 8.0, 14.0})
        for (const double turn : {-0.9, 0.0, 0.9}) {
            saw::SlotHold hold(shape, {.stiffness = stiffness, .thickness = kerf});
            double largest = 0.0, springs = 0.0, held = 0.0;
            for (int n = 0; n <= 1000; ++n) {
                const double far = n / 1000.0;
                const Pose hand{Vec3(0.0, 0.25 * mm + 60.0 * mm * far, 15.5 * mm - along * mm),
                                rotation_by(Vec3(turn * far, 0.0, 0.0)) * teeth_down};
                const Pose at = hold.follow(slots, hand, 1e-3);
                if (hold.slot() < 0) break;
                springs = std::max(springs, hold.force());
                largest = std::max(largest, glm::length(hold.on_hand({}).force));
                held = std::max(held, beyond_walls(slots[0], shape, at));
            }
            CAPTURE(along, turn, largest);
            CHECK(springs <= stiffness * saw::max_lag);
            CHECK(largest > 0.3 * stiffness * saw::max_lag);
            // Walls that hold a blade by its last millimetre wedge it out with more than the springs have.
            CHECK(largest <= (along > 1.0 ? 2.0 : 6.0) * stiffness * saw::max_lag);
            CHECK(held < 0.01 * mm);
        }
}

TEST_CASE("a slot that is taken away lets its force fade, and gives no more energy than was stored") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    const Random random{5};
    for (std::uint64_t run = 0; run < 50; ++run) {
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        const auto drawn = [&](std::uint64_t n) { return random.normal(20 * run + n); };
        const Quat tilt = rotation_by(0.1 * Vec3(drawn(1), drawn(2), drawn(3))) * teeth_down;
        Pose hand{Vec3(0.0, 0.25 * mm, 14.0 * mm), teeth_down};
        hold.follow(slots, hand, 1e-3);
        REQUIRE(hold.slot() == 0);
        for (int n = 1; n <= 100; ++n) {
            hand = {Vec3(0.0, 0.25 * mm + 2.0 * mm * drawn(4) * n / 100.0, 14.0 * mm - 8.0 * mm * n / 100.0),
                    glm::slerp(teeth_down, tilt, n / 100.0)};
            hold.follow(slots, hand, 1e-3);
        }
        const double stored = 0.5 * hold.force() * hold.force() / 10e3;
        Wrench felt = hold.on_hand({});
        const double all = glm::length(felt.force), all_torque = glm::length(felt.torque);

        // A hand that stays where it is feels a hundredth less in each tick.
        saw::SlotHold still = hold;
        double step = 0.0, torque_step = 0.0;
        for (Wrench last = felt; glm::length(last.force) > 0.0;) {
            still.follow({}, hand, 1e-3);
            const Wrench now = still.on_hand({});
            step = std::max(step, glm::length(now.force - last.force));
            torque_step = std::max(torque_step, glm::length(now.torque - last.torque));
            last = now;
        }
        CAPTURE(run, all, stored, step, torque_step);
        CHECK(step <= 0.0101 * all);
        CHECK(torque_step <= 0.0101 * all_torque);

        // One that gives way at 50 mm/s feels in addition what the springs of the slot would have taken from it.
        constexpr double yielded = 0.05 * mm;
        saw::SlotHold gone = hold;
        const Vec3 aside = all > 0.0 ? felt.force * (yielded / all) : Vec3(0.0);
        gone.follow({}, {hand.position + aside, hand.orientation}, 1e-3);
        CHECK(glm::length(gone.on_hand({}).force - felt.force) <= 0.0101 * all + 1.2 * 10e3 * yielded);

        // The hand is let go: it moves as the force wants, slowly enough to take all that is there. The ticks are so short
        // that the force that stands for one does not add to the work.
        double work = 0.0;
        for (int n = 0; n < 12000; ++n) {
            const Vec3 way = felt.force * 2e-8, turn = felt.torque * 0.0002;
            hand.position += way;
            hand.orientation = glm::normalize(rotation_by(turn) * hand.orientation);
            work += glm::dot(felt.force, way) + glm::dot(felt.torque, turn);
            hold.follow({}, hand, 1e-5);
            felt = hold.on_hand({});
        }
        CAPTURE(work);
        CHECK(work <= 1.02 * stored + 1e-9);
        CHECK(glm::length(felt.force) == 0.0);
    }
}

TEST_CASE("a wall takes over the load on a blade slowly, where a blade enters at it and where it is released") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    const Random random{31};
    int carried = 0;
    for (std::uint64_t run = 0; run < 60; ++run) {
        const auto drawn = [&](std::uint64_t n) { return random.uniform(20 * run + n); };
        saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
        // At a wall or up to 0.3 mm beyond it, in the slot from the first tick on or in through its mouth.
        const double side = drawn(1) < 0.5 ? -1.0 : 1.0, beside = 0.25 * mm + side * (0.25 + 0.3 * drawn(2)) * mm;
        const double mouth = drawn(3) < 0.5 ? 16.0 * mm : 10.0 * mm;
        const Vec3 load(0.0, side * 5.0, 0.0);
        const Wrench on_blade{load, glm::cross(Vec3(0.0, 0.0, -4.0 * mm), load)};
        double jump = 0.0, least = 5.0;
        Wrench last = on_blade;
        // Beyond the walls it is pressed by less than 0.1 mm, and the springs give less than 1 N.
        for (int n = 0; n < 700; ++n) {
            const double down = std::min(1.0, n / 400.0);
            const Pose hand{Vec3(0.0, beside - side * 0.2 * mm * down, mouth - 6.0 * mm * down), teeth_down};
            hold.follow(n < 500 ? std::span<const saw::GuideSlot>(slots) : std::span<const saw::GuideSlot>(), hand,
                        1e-3);
            const Wrench now = hold.on_hand(on_blade);
            jump = std::max(jump, glm::length(now.force - last.force));
            least = std::min(least, glm::length(now.force));
            last = now;
        }
        CAPTURE(run, side, beside * 1e3, least);
        CHECK(jump < 0.4);
        CHECK(glm::length(last.force - load) == 0.0);
        carried += least < 3.0;
    }
    CHECK(carried > 10);
}

TEST_CASE("a hand that is released late feels the torque on the blade as it is") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    for (const double tilt : {0.0, 0.3, 0.6, 0.9, 1.3})
        for (const int axis : {0, 1, 2}) {
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            const auto hand = [&](double share) {
                return Pose{Vec3(0.0, 0.25 * mm, 5.0 * mm), rotation_by(Vec3(share * tilt, 0.0, 0.0)) * teeth_down};
            };
            for (int n = 0; n <= 300; ++n) hold.follow(slots, hand(std::min(1.0, n / 200.0)), 1e-3);
            Wrench load;
            load.torque[axis] = 0.1;
            Wrench felt;
            double jump = 0.0;
            for (int n = 0; n < 110; ++n) {
                hold.follow({}, hand(1.0), 1e-3);
                const Wrench now = hold.on_hand(load);
                if (n > 0) jump = std::max(jump, glm::length(now.torque - felt.torque));
                felt = now;
                if (n != 97) continue;
                const Vec3 of_load = now.torque - hold.on_hand({}).torque;
                CAPTURE(tilt, axis, of_load.x, of_load.y, of_load.z);
                CHECK(glm::length(of_load - load.torque) < 0.01);
            }
            CAPTURE(tilt, axis, jump);
            CHECK(glm::length(felt.torque - load.torque) < 1e-12);
        }
}

TEST_CASE("a wedged blade that is released while the hand moves loses its force without a step, and gives none away") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    int wedged = 0;
    for (std::uint64_t run = 0; run < 30; ++run)
        for (const double at : {0.3, 0.45, 0.6, 0.75}) {
            const SlotPath path{Random{37}, run};
            saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
            constexpr int ticks = 2000;
            double work = 0.0, bound = 0.0, jump = 0.0, most = 0.0, dropped = 0.0;
            saw::SlotHold still;  // as if it were not released
            int since = 0;
            Wrench felt, released_at;
            Pose last = path(0.0);
            for (int n = 0; n <= ticks; ++n) {
                const double s = static_cast<double>(n) / ticks;
                const Pose hand = path(s);
                const bool is_released = s >= at;
                const std::vector<saw::GuideSlot> given = is_released ? std::vector<saw::GuideSlot>{} : slots;
                const saw::SlotHold before = hold;
                hold.follow(given, hand, 1e-3);
                const Wrench now = hold.on_hand({});
                const Vec3 way = hand.position - last.position,
                           turn = rotation_between(last.orientation, hand.orientation);
                work += glm::dot(felt.force, way) + glm::dot(felt.torque, turn);
                bound += 0.5 * (std::abs(glm::dot(now.force - felt.force, way)) +
                                std::abs(glm::dot(now.torque - felt.torque, turn)));
                if (is_released) most = std::max(most, glm::length(now.force));
                if (is_released && since == 0) still = before, released_at = felt;
                if (is_released && ++since <= 3) {
                    still.follow(slots, hand, 1e-3);
                    const double least = std::min(glm::length(still.on_hand({}).force), glm::length(released_at.force));
                    if (still.slot() == 0) dropped = std::max(dropped, 0.9 * least - glm::length(now.force));
                }
                // The same motion in 16 ticks of a 16th: what is no step becomes small, but for the fade.
                if (is_released && glm::length(now.force - felt.force) > 0.02 * glm::length(felt.force) + 0.2) {
                    saw::SlotHold fine = before;
                    Wrench was = felt;
                    for (int k = 1; k <= 16; ++k) {
                        fine.follow(given, path(s + (k / 16.0 - 1.0) / ticks), 1e-3 / 16.0);
                        const Wrench step = fine.on_hand({});
                        jump = std::max(jump, glm::length(step.force - was.force));
                        was = step;
                    }
                    ++wedged;
                }
                felt = now;
                last = hand;
            }
            CAPTURE(run, at, most, work * 1e3, bound * 1e3);
            CHECK(jump < 0.02 * most + 0.1);
            CHECK(dropped < 0.1);
            CHECK(work <= 1.02 * bound + 1e-6);
            CHECK(glm::length(felt.force) == 0.0);
        }
    CHECK(wedged > 20);
}

TEST_CASE("a released blade that the hand turns across its slot loses force and torque without a step") {
    const saw::SawShape shape = guided_blade();
    const std::vector<saw::GuideSlot> slots{slot_above()};
    saw::SlotHold hold(shape, {.stiffness = 10e3, .thickness = kerf});
    const auto hand_at = [&](double degrees) {
        const double half = 0.5 * degrees * std::numbers::pi / 180.0;
        Pose hand{Vec3(0.0), teeth_down};
        hand.orientation = glm::normalize(hand.orientation * Quat(std::cos(half), std::sin(half), 0.0, 0.0));
        return hand;
    };
    // 300 degrees/s, through the tilt at which the slot releases it and on across its plane.
    Wrench felt;
    double most = 0.0, jump = 0.0;
    for (int n = 0; n <= 400; ++n) {
        const saw::SlotHold before = hold;
        hold.follow(slots, hand_at(std::min(0.3 * n, 95.0)), 1e-3);
        const Wrench now = hold.on_hand({});
        REQUIRE(is_finite(now));
        most = std::max(most, glm::length(now.torque));
        if (glm::length(now.torque - felt.torque) > 0.02 * most) {
            saw::SlotHold fine = before;
            Wrench was = felt;
            for (int k = 1; k <= 16; ++k) {
                fine.follow(slots, hand_at(std::min(0.3 * (n - 1 + k / 16.0), 95.0)), 1e-3 / 16.0);
                const Wrench step = fine.on_hand({});
                jump = std::max(jump, glm::length(step.torque - was.torque));
                was = step;
            }
        }
        felt = now;
    }
    CHECK(most > 0.5);
    CHECK(jump < 0.02 * most);
    CHECK(glm::length(felt.force) + glm::length(felt.torque) == 0.0);
}

TEST_CASE("a running blade that misses the slot stops at the guide, and is free above it") {
    const auto bone = bone_block({.low = {-6.0 * mm, -4.0 * mm, -4.0 * mm}, .high = {6.0 * mm, 4.0 * mm, 0.0}});
    const auto guide = guide_above();
    const volume::BoneSnapshot solid = guide->current();
    for (const bool running : {false, true})
        for (const double aside : {-2.5 * mm, 2.8 * mm}) {
            Sawing sawing(*bone, 1000.0, 40e3, guided_blade());
            sawing.guide = &solid;
            sawing.drive.running = running;
            double z = 17.0 * mm, deepest = 1.0;
            // 20 N against a damper.
            for (int n = 0; n < 1500; ++n) {
                const Wrench now = sawing.step({Vec3(0.0, aside, z), teeth_down}).wrench;
                z -= (20.0 - now.force.z) / 300.0 * 1e-3;
                deepest = std::min(deepest, z);
            }
            CAPTURE(running, aside, deepest * 1e3);
            CHECK(deepest > 14.0 * mm);  // its top is at 15.5 mm; 20 N at 40 N/mm, and balls 1 mm apart
            CHECK(sawing.removed == 0.0);
        }
}

// Costly: six runs of 5 s; the blade has 600 balls.
TEST_CASE("a slot bounds what a tilted or shaking hand does, and leaves a straight one as it is", "[slow]") {
    const Hand hands[]{
        {"straight"}, {"tilted by 3 x play", 3.0 * play, 0.0}, {"shaking by 3 x clearance", 0.0, 3.0 * clearance}};
    const double reach = 4.5 * mm;  // from the slot to the far side of the bone
    std::vector<Result> with, without;
    for (const Hand& hand : hands) {
        with.push_back(saw_with(hand, true));
        without.push_back(saw_with(hand, false));
    }
    for (std::size_t n = 0; n < 3; ++n) {
        const Result &a = with[n], &b = without[n];
        INFO(hands[n].name << ": with the guide " << a.offset / mm << " mm, " << a.angle / degree << " deg, "
                           << a.max / mm << " mm at most; without " << b.offset / mm << ", " << b.angle / degree << ", "
                           << b.max / mm << "; jump " << a.jump << " N; most " << a.force << " N; play "
                           << play / degree);
        // From the middle of the slot, which is the clearance off the plan.
        CHECK(a.angle <= play + 0.2 * degree);
        CHECK(a.max <= clearance + clearance + reach * std::tan(play));
        CHECK(a.force < 25.0);
        CHECK(a.jump < 1.0);
        if (n == 0) {
            CHECK(std::abs(a.offset - b.offset) < 0.05 * mm);
            CHECK(std::abs(a.max - b.max) < 0.05 * mm);
        }
        if (n == 1) CHECK(b.angle > a.angle);
        if (n == 2) CHECK(b.max > a.max);
        if (n == 1) CHECK(b.angle > play + 0.2 * degree);
    }
}
