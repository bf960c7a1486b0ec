// SPDX-License-Identifier: Apache-2.0
// The margin of a tumour: it stops a hand that comes from a stump, lets others pass, and gives no energy.
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/simulate/device_model.hpp"
#include "graph/node/assets.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::NodeHarness;

namespace {

const Quat upright{1.0, 0.0, 0.0, 0.0};

bone::Bone ball(const Vec3& centre, double radius) {
    bone::Bone bone;
    volume::Grid& d = bone.distance;
    d.spacing = Vec3(0.5 * mm);
    d.origin = centre - Vec3(radius + 3.0 * mm);
    const int size = static_cast<int>(std::ceil(2.0 * (radius + 3.0 * mm) / d.spacing.x)) + 1;
    d.size = {size, size, size};
    for (int k = 0; k < size; ++k)
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i)
                d.values.push_back(static_cast<float>(glm::length(d.position(i, j, k) - centre) - radius));
    bone.density = d;
    bone.points = contact::sample_surface(d, {.spacing = 0.7 * mm});
    return bone;
}

/// Planes at x = -40 and 40 mm; a tumour of 6 mm about the origin. Walls at x = ±(6 + margin).
std::shared_ptr<const plan::CaseBones> jaw(reconstruction::Resection resection = reconstruction::Resection::between) {
    auto made = std::make_shared<plan::CaseBones>();
    made->bones = {ball(Vec3(0.0), 12.0 * mm), ball(Vec3(-60.0 * mm, 0.0, 0.0), 10.0 * mm)};
    for (const char* name : {"resected", "jaw-1"}) made->plan.fragments.push_back({name, name, 0, Vec3(1.0)});
    auto all = std::make_shared<reconstruction::Reconstruction>();
    all->inputs.planes = {{Vec3(-40.0 * mm, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}},
                          {Vec3(40.0 * mm, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}}};
    all->inputs.resection = resection;
    all->donor.file = "donor.stl";
    plan::PlanStep step;
    step.kind = plan::StepKind::reconstruct;
    step.by = "command";
    step.fragments = {0, 1};
    step.reconstruction = all;
    plan::add_step(made->plan, step);
    return made;
}

struct Rig {
    NodeHarness shown{"case_scene", {.period = flicks_per_second / 1000}};
    NodeHarness node{"tumour_margin", {.period = flicks_per_second / 1000}};
    coupling::Scene scene;

    explicit Rig(int rate = 1000) : node("tumour_margin", {.period = flicks_per_second / rate}) {
        shown.asset("plan", jaw()).disconnect_optional();
        shown.prepare();
        shown.run(1);
        scene = shown.last<coupling::Scene>("scene");
        node.asset("plan", jaw());
        node.asset("tumour", std::make_shared<const bone::Bone>(ball(Vec3(0.0), 6.0 * mm)));
        node.disconnect_optional();
        node.set("max_force", "50 N").feed("scene", scene);
        node.feed("pose", Pose{Vec3(0.0, -60.0, 0.0) * mm, upright});
    }
    Vec3 at(const Vec3& place) {
        node.feed("pose", Pose{place, upright});
        node.run(1);
        return node.last<Wrench>("wrench").force;
    }
    /// Straight, in steps of 0.1 mm.
    Vec3 go(const Vec3& from, const Vec3& to) {
        const int steps = static_cast<int>(std::ceil(glm::length(to - from) / (0.1 * mm)));
        Vec3 force(0.0);
        for (int n = 0; n <= steps; ++n) force = at(from + static_cast<double>(n) / steps * (to - from));
        return force;
    }
};

}  // namespace

TEST_CASE("the margin of a tumour stops a hand from either stump, as far before the tumour as the plan wants") {
    Rig rig;
    rig.node.prepare();
    rig.node.run(100);
    for (const double side : {-1.0, 1.0}) {
        // Tumour 6 mm, margin 10 mm.
        CHECK(rig.go(Vec3(side * 30.0, 3.0, 0.0) * mm, Vec3(side * 16.2, 3.0, 0.0) * mm) == Vec3(0.0));
        CHECK_FALSE(rig.node.last<bool>("holds"));
        const Vec3 felt = rig.go(Vec3(side * 16.2, 3.0, 0.0) * mm, Vec3(side * 11.0, 3.0, 0.0) * mm);
        CHECK(felt.x == Approx(side * 0.5 / mm * 5.0 * mm).epsilon(0.05));
        CHECK(rig.node.last<bool>("holds"));
        CHECK(rig.node.last<double>("distance") == Approx(-5.0 * mm).margin(0.2 * mm));
        // Along the wall, also beyond its width: it holds until the hand is in front of it.
        CHECK(rig.go(Vec3(side * 11.0, 3.0, 0.0) * mm, Vec3(side * 11.0, 60.0, 0.0) * mm).x ==
              Approx(side * 2.5).epsilon(0.05));
        CHECK(rig.go(Vec3(side * 11.0, 60.0, 0.0) * mm, Vec3(side * 20.0, 60.0, 0.0) * mm) == Vec3(0.0));
        CHECK_FALSE(rig.node.last<bool>("holds"));
    }
}

TEST_CASE("a hand that comes from the front, or passes beside the limb, is free") {
    Rig rig;
    rig.node.prepare();
    rig.node.run(100);
    // From the front to the tumour, and out to the stump.
    CHECK(rig.go(Vec3(0.0, -60.0, 0.0) * mm, Vec3(0.0)) == Vec3(0.0));
    CHECK(rig.go(Vec3(0.0), Vec3(-15.0, 0.0, 0.0) * mm) == Vec3(0.0));
    CHECK(rig.go(Vec3(-15.0, 0.0, 0.0) * mm, Vec3(-30.0, 0.0, 0.0) * mm) == Vec3(0.0));
    // Now it comes from the stump.
    CHECK(rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm).x < -1.0);
    rig.go(Vec3(-12.0, 0.0, 0.0) * mm, Vec3(-30.0, 0.0, 0.0) * mm);
    CHECK(rig.go(Vec3(-30.0, 26.0, 0.0) * mm, Vec3(0.0, 26.0, 0.0) * mm) == Vec3(0.0));
}

TEST_CASE("in another alternative of a plan the margin goes with the piece of that reconstruction") {
    plan::CaseBones two = *jaw();
    for (const char* name : {"resected-2", "jaw-1-2"}) two.plan.fragments.push_back({name, name, 0, Vec3(1.0)});
    two.bones.insert(two.bones.end(), {two.bones[0], two.bones[1]});
    plan::PlanStep again = two.plan.steps.front();
    again.fragments = {2, 3};
    two.plan.alternatives.push_back({"2", {}});
    two.plan.current = 1;
    plan::add_step(two.plan, again);
    const auto plan = std::make_shared<const plan::CaseBones>(std::move(two));
    Rig rig;
    NodeHarness shown("case_scene", {.period = flicks_per_second / 1000});
    shown.asset("plan", plan).disconnect_optional();
    shown.prepare();
    shown.run(1);
    coupling::Scene scene = shown.last<coupling::Scene>("scene");
    REQUIRE(scene.objects[0].body.map == nullptr);
    rig.node.asset("plan", plan).feed("scene", scene);
    rig.node.prepare();
    rig.node.run(100);
    CHECK(rig.node.last<bool>("is_there"));
    CHECK(rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm).x < -1.0);
}

TEST_CASE("the margin goes with the piece: held or moved it is no more, and what is felt fades") {
    for (const bool is_held : {true, false}) {
        Rig rig;
        rig.node.feed<double>("held", -1.0).connect("held");
        rig.node.prepare();
        rig.node.run(100);
        const double before = glm::length(rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm));
        CHECK(before > 1.5);
        coupling::Scene out = rig.scene;
        if (is_held) rig.node.feed<double>("held", 0.0);
        else out.objects[0].pose.position.y -= 5.0 * mm;
        rig.node.feed("scene", out);
        double greatest_step = 0.0, last = before;
        for (int n = 0; n < 60; ++n) {
            const double now = glm::length(rig.at(Vec3(-12.0, 0.0, 0.0) * mm));
            greatest_step = std::max(greatest_step, std::abs(now - last));
            last = now;
        }
        CHECK(last == 0.0);
        CHECK(greatest_step < 0.05 * before);
        CHECK_FALSE(rig.node.last<bool>("is_there"));
        CHECK(rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm) == Vec3(0.0));
        // Put back, it stops the next hand; the one that is behind it is not pushed.
        rig.node.feed<double>("held", -1.0).feed("scene", rig.scene);
        for (int n = 0; n < 100; ++n) CHECK(rig.at(Vec3(-12.0, 0.0, 0.0) * mm) == Vec3(0.0));
        CHECK(rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm).x < -1.0);
    }
}

TEST_CASE("a piece that is taken and let go at once pushes no hand that came deeper meanwhile") {
    Rig rig;
    rig.node.feed<double>("held", -1.0).connect("held");
    rig.node.prepare();
    rig.node.run(100);
    rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm);
    rig.node.feed<double>("held", 0.0);
    for (int n = 0; n < 40; ++n) rig.at(Vec3(-12.0, 0.0, 0.0) * mm);
    double last = glm::length(rig.at(Vec3(-4.0, 0.0, 0.0) * mm));
    CHECK(last > 0.1);
    rig.node.feed<double>("held", -1.0);
    for (int n = 0; n < 100; ++n) {
        const double now = glm::length(rig.at(Vec3(-4.0, 0.0, 0.0) * mm));
        CHECK(now <= last);
        last = now;
    }
    CHECK(last == 0.0);
    CHECK(rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm).x < -1.0);
}

TEST_CASE("a margin that cannot be is refused with the reason, and poses that are none give no force") {
    Rig rig;
    rig.node.set("piece", "tumour");
    CHECK_THROWS_WITH(rig.node.prepare(), ContainsSubstring("no piece 'tumour'"));
    rig.node.set("piece", "resected").asset("plan", jaw(reconstruction::Resection::none));
    CHECK_THROWS_WITH(rig.node.prepare(), ContainsSubstring("cuts nothing of the jaw"));
    rig.node.asset("plan", jaw(reconstruction::Resection::after_first));
    rig.node.prepare();
    rig.node.run(100);
    // Of a hemimandibulectomy there is one wall.
    CHECK(rig.go(Vec3(30.0, 0.0, 0.0) * mm, Vec3(10.0, 0.0, 0.0) * mm) == Vec3(0.0));
    rig.go(Vec3(-30.0, 0.0, 0.0) * mm, Vec3(-12.0, 0.0, 0.0) * mm);
    CHECK(rig.at(Vec3(std::numeric_limits<double>::quiet_NaN())) == Vec3(0.0));
    CHECK(rig.node.finite());
}

TEST_CASE("the margin of a tumour gives a hand on a simulated device no energy", "[slow]") {
    simulate::DeviceModel ideal;
    ideal.name = "ideal";
    ideal.max_force = 20.0;
    constexpr double stiffness = 2000.0, seconds = 2.0;
    for (const int rate : {500, 1000, 2000})
        for (const simulate::DeviceModel& model : {ideal, *simulate::find_device_model("touch")}) {
            const double dt = 1.0 / rate;
            Rig rig(rate);
            rig.node.set("stiffness", "2 N/mm").set("max_force", "8 N");
            rig.node.prepare();
            rig.node.feed("pose", Pose{Vec3(-20.0, 0.0, 0.0) * mm, upright});
            rig.node.run(rate);
            simulate::ModelledDevice device(model, {});
            const Vec3 start(-20.0 * mm, 0.0, 0.0);
            // From there to and fro through the wall, and along it.
            const auto intended = [=](double t) {
                const double u = std::clamp(t, 0.0, seconds), w = 4.0 * pi / seconds;
                return Vec3(4.0 * (1.0 - std::cos(w * u)), 8.0 * std::sin(2.0 * w * u), 3.0 * std::sin(w * u)) * mm;
            };
            double time = 0.0, work = 0.0, explained = 0.0, most = 0.0;
            Vec3 before = intended(0.0), acting(0.0);
            const auto intend = [&](double h, const Wrench& felt, const Pose& pose) {
                work += glm::dot(acting, pose.position - before);
                before = pose.position;
                acting = felt.force;
                const double t = time + 0.5 * h;
                time += h;
                return simulate::Intention{{intended(t), upright},
                                           {(intended(t + 1e-5) - intended(t - 1e-5)) / 2e-5, Vec3(0.0)}};
            };
            for (int tick = 0; tick < static_cast<int>((seconds + 0.3) * rate); ++tick) {
                rig.node.feed("pose", Pose{start + device.pose().position, upright});
                rig.node.run(1);
                const auto command = rig.node.last<Wrench>("wrench");
                rig.node.forget();
                most = std::max(most, glm::length(command.force));
                const Vec3 from = device.truth().pose.position;
                device.advance(intend, Wrench{command.force, Vec3(0.0)}, dt);
                const double step = glm::length(device.truth().pose.position - from);
                const double late = 1.0 + 2.0 * model.delay / dt;
                explained += 0.5 * late * stiffness * step * step + stiffness * 0.5 * model.resolution * step;
            }
            CAPTURE(rate, model.name, work, explained, most);
            CHECK(most > 2.0);
            CHECK(work < explained);
        }
}
