// SPDX-License-Identifier: Apache-2.0
// What finds where a fragment fits, what paints it, and the coupling that is led there.
#include "assets/segmentation/seeds_file.hpp"
#include "dsp/coupling/scene.hpp"
#include "tests/nodes/plan/broken_case.hpp"
#include "tests/support/catch.hpp"

#include <any>
#include <cmath>
#include <memory>

using namespace tactus;
using namespace tactus::test;

namespace {

/// The same fracture, its right half scanned `far` from its place.
std::shared_ptr<const plan::CaseBones> scanned(const Vec3& far) {
    auto c = std::make_shared<plan::CaseBones>(*broken());
    c->bones[1].distance.origin += far;
    c->bones[1].density.origin += far;
    for (contact::SurfacePoint& p : c->bones[1].points) p.position += far;
    return c;
}

/// A scene and the node that holds its bodies.
struct ShownCase {
    NodeHarness node{"case_scene", servo};
    coupling::Scene now;

    explicit ShownCase(const std::shared_ptr<const plan::CaseBones>& plan) {
        node.asset("plan", plan);
        node.disconnect_optional();
        node.prepare();
        node.run(1);
        now = node.last<coupling::Scene>("scene");
    }
};

}  // namespace

TEST_CASE("the matcher finds where a fragment fits from beside it, and says that a copy of its partner does not") {
    const Vec3 far = Vec3(6.0, 2.0, -3.0) * mm;
    const auto displaced = scanned(far);
    const ShownCase shown(displaced);
    coupling::Scene now = shown.now;
    const Pose there{-far, {1.0, 0.0, 0.0, 0.0}};
    now.objects[1].pose = beside * there * now.objects[1].body.home;
    NodeHarness matcher("fragment_matcher", {.period = flicks_per_second / 4});
    matcher.asset("plan", displaced);
    matcher.feed("scene", now);
    matcher.feed<double>("held", 1.0);
    matcher.feed<bool>("engaged", true);
    matcher.prepare();
    matcher.run(2);
    REQUIRE(matcher.last<bool>("fits"));
    CHECK(matcher.last<double>("partner") == 0.0);
    // It says how the faces lie on each other there, for the step of the plan.
    CHECK(matcher.last<double>("overlap") > 200e-6);
    CHECK(std::abs(matcher.last<double>("gap")) < 0.05 * mm);
    CHECK(matcher.last<double>("penetration") < 0.1 * mm);
    CHECK(off(matcher.last<Pose>("target") * now.objects[1].body.home.inverse() * there.inverse()) < 0.3 * mm);
    // Its own partner's copy in the hand: the same face does not fit itself.
    now.objects[2].pose = beside * now.objects[2].body.home;
    NodeHarness wrong("fragment_matcher", {.period = flicks_per_second / 4});
    wrong.asset("plan", displaced);
    wrong.feed("scene", now);
    wrong.feed<double>("held", 2.0);
    wrong.disconnect("engaged");
    wrong.prepare();
    wrong.run(2);
    CHECK_FALSE(wrong.last<bool>("fits"));
    CHECK(off(wrong.last<Pose>("target"), now.objects[2].pose) == 0.0);
}

TEST_CASE("the matcher does not lead to a fit that only repeats the scan, wherever both were brought, near or anywhere",
          "[slow]") {
    for (const char* reach : {"near", "anywhere"}) {
        CAPTURE(reach);
        const ShownCase shown(broken());
        coupling::Scene now = shown.now;
        const Pose brought{Vec3(20.0, -30.0, 10.0) * mm, rotation_by({0.4, 0.2, -0.3})};
        now.objects[0].pose = brought * now.objects[0].body.home;
        now.objects[1].pose = brought * beside * now.objects[1].body.home;
        NodeHarness node("fragment_matcher", {.period = flicks_per_second / 4});
        node.asset("plan", broken()).set("reach", reach);
        node.feed("scene", now).feed<double>("held", 1.0).feed<bool>("engaged", true);
        node.prepare();
        node.run(4);
        CHECK(node.last<double>("score") > 0.5);
        CHECK(node.last<double>("verdict") == 2.0);
        CHECK_FALSE(node.last<bool>("fits"));
        CHECK(off(node.last<Pose>("target"), now.objects[1].pose) == 0.0);
    }
}

TEST_CASE("the matcher does not lead a fragment into a placed one, however well its face fits its partner") {
    const Vec3 far = Vec3(6.0, 2.0, -3.0) * mm;
    const auto displaced = scanned(far);
    const ShownCase shown(displaced);
    const Pose there{-far, {1.0, 0.0, 0.0, 0.0}};
    for (const bool in_the_way : {false, true}) {
        CAPTURE(in_the_way);
        coupling::Scene now = shown.now;
        now.objects[1].pose = beside * there * now.objects[1].body.home;
        // The third one is taken to stand where the right half belongs, turned so that no face of it looks there.
        now.objects[2].stands = true;
        const Pose place{Vec3(in_the_way ? 14.0 : 90.0, 0.0, 0.0) * mm, rotation_by({0.0, 0.0, 3.14159265})};
        now.objects[2].pose = place * now.objects[2].body.home;
        NodeHarness matcher("fragment_matcher", {.period = flicks_per_second / 4});
        matcher.asset("plan", displaced);
        matcher.feed("scene", now).feed<double>("held", 1.0).feed<bool>("engaged", true);
        matcher.prepare();
        matcher.run(2);
        CHECK(matcher.last<double>("partner") == 0.0);
        CHECK(matcher.last<bool>("fits") == !in_the_way);
        CHECK(matcher.last<double>("verdict") == (in_the_way ? 4.0 : 0.0));
    }
}

TEST_CASE("a brush paints what it meets, erases it again, and nothing else") {
    const auto bone = std::make_shared<const bone::Bone>(broken()->bones[0]);
    NodeHarness node("brush", servo);
    node.asset("bone", bone).set("start_clean", "true").set("radius", "2 mm");
    const Vec3 at = bone->points[100].position;
    node.feed<Pose>("tool", Pose{at + Vec3(0.1, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}});
    node.feed<Pose>("body", Pose{Vec3(0.1, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}});
    node.feed<bool>("paint", [](std::int64_t k) { return k >= 10; });
    node.feed<bool>("erase", [](std::int64_t k) { return k >= 30; });
    node.prepare();
    node.run(20);
    std::size_t within = 0;
    for (const contact::SurfacePoint& p : bone->points) within += glm::length(p.position - at) <= 2.0 * mm;
    REQUIRE(within > 5);
    CHECK(node.values<double>("painted")[5] == 0.0);
    CHECK(node.last<double>("painted") == static_cast<double>(within));
    CHECK(node.last<double>("area") > 5e-6);
    CHECK(node.last<double>("distance") < 1e-9);
    const auto painted = *std::any_cast<std::shared_ptr<const bone::Bone>>(node.report().results.begin()->second);
    CHECK(painted.points[100].label == contact::surface_label::fracture);
    node.run(20);
    CHECK(node.last<double>("painted") == 0.0);
}

TEST_CASE("the strokes of a brush are seeds of a fragment") {
    const auto bone = std::make_shared<const bone::Bone>(broken()->bones[0]);
    NodeHarness node("brush", servo);
    node.asset("bone", bone).set("radius", "2 mm").set("label", "left half");
    // Along the surface, lifted in the middle, and back over a part of it with the eraser.
    const Vec3 at = bone->points[100].position;
    const auto place = [&](std::int64_t k) {
        const std::int64_t along = k < 400 ? k : 800 - k;
        return at + Vec3(0.0, 0.01 * mm * static_cast<double>(along % 200), k >= 190 && k < 210 ? 0.1 : 0.0);
    };
    node.feed<Pose>("tool", [&](std::int64_t k) { return Pose{place(k), {1.0, 0.0, 0.0, 0.0}}; });
    node.feed<bool>("paint", [](std::int64_t k) { return k >= 10 && k < 400; });
    node.feed<bool>("erase", [](std::int64_t k) { return k == 450; });
    node.disconnect("body");
    node.prepare();
    node.run(400);
    const auto seeds_of = [&] {
        for (const auto& [name, result] : node.report().results)
            if (const auto* seeds = std::any_cast<segmentation::SeedLabel>(&result)) return *seeds;
        return segmentation::SeedLabel{};
    };
    const segmentation::SeedLabel painted = seeds_of();
    CHECK(painted.name == "left half");
    REQUIRE(painted.strokes.size() == 2);
    CHECK(painted.strokes[0].radius == 2.0 * mm);
    for (std::size_t n = 1; n < painted.strokes[0].points.size(); ++n) {
        const double apart = glm::length(painted.strokes[0].points[n] - painted.strokes[0].points[n - 1]);
        CHECK(apart > 0.49 * mm);
        CHECK(apart < 0.53 * mm);
    }
    node.run(100);
    CHECK(seeds_of().strokes.empty());
}

TEST_CASE(
    "a held fragment is led to its target with a force that has a limit, and follows the hand that pulls harder") {
    NodeHarness scene("case_scene", servo);
    scene.asset("plan", broken());
    scene.disconnect_optional();
    scene.prepare();
    scene.run(1);
    coupling::Scene now = scene.last<coupling::Scene>("scene");
    // The right half alone in free space, 6 mm from its target.
    now.count = 2;
    now.objects[0].pose.position += Vec3(0.0, 0.0, 0.3);
    const Pose home = now.objects[1].pose;
    NodeHarness node("quasi_static_coupling", servo);
    node.set("held", "1");
    for (const char* open : {"grip", "holding", "strength", "has_target", "target_of"}) node.disconnect(open);
    node.feed("scene", now);
    node.feed<Pose>("device", [home](std::int64_t k) {
        // From one second on the hand pulls away at 100 mm/s.
        const double away = 6.0 * mm + (k > 1000 ? 0.1 * mm * static_cast<double>(k - 1000) : 0.0);
        return Pose{home.position + Vec3(away, 0.0, 0.0), home.orientation};
    });
    node.feed<Pose>("target", home).feed<bool>("guided", [](std::int64_t k) { return k >= 100 && k < 2000; });
    node.feed<bool>("settle", [](std::int64_t k) { return k >= 500 && k < 900; });
    node.prepare();
    node.run(1400);
    const auto poses = node.values<Pose>("pose");
    const auto felt = node.values<Wrench>("wrench");
    CHECK(glm::length(poses[90].position - home.position) == Approx(6.0 * mm).margin(0.01 * mm));
    // Both springs are alike: half way, 3 N.
    CHECK(glm::length(poses[450].position - home.position) == Approx(3.0 * mm).margin(0.05 * mm));
    CHECK(glm::length(felt[450].force) == Approx(3.0).margin(0.05));
    CHECK(glm::length(poses[850].position - home.position) < 0.01 * mm);
    CHECK(glm::length(felt[850].force) < 0.01);
    double step = 0.0, most = 0.0;
    for (std::size_t k = 1; k < felt.size(); ++k) {
        step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
        most = std::max(most, glm::length(felt[k].force));
    }
    CHECK(step < 0.5);
    // The target pulls 8 N at most and the hand ten: within 50 ms of being pulled harder than that it goes along.
    CHECK(most < 8.01);
    CHECK(glm::length(poses.back().position - home.position) > 30.0 * mm);
}
