// SPDX-License-Identifier: Apache-2.0
// A vessel under the hand: what is felt is what is reported, it gives no energy, and it rests while nobody holds it.
#include "assets/plan/plan_history.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/rope/rope_shape.hpp"
#include "dsp/simulate/device_model.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/vessel_asset.hpp"
#include "tests/nodes/plan/flap_case.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::flap, test::rod, test::vessel_course;
using test::NodeHarness;

namespace {

const Quat vessel_upright{1.0, 0.0, 0.0, 0.0};

constexpr double site_z = 160.0;  // mm: 60 mm above the upper segment

struct VesselRig {
    test::FlapScene shown;
    NodeHarness node;
    explicit VesselRig(int rate = 1000, double held = 2.0) : node("vessel", {.period = flicks_per_second / rate}) {
        node.asset("plan", flap()).asset("course", vessel_course());
        node.disconnect_optional();
        node.set("pieces", "segment").set("pedicle", "60 mm").set("site_at", "0 mm, 0 mm, 160 mm");
        node.feed<double>("held", held);
        node.connect("held").connect("hand").connect("pose");
    }
    /// Both segments and the hand at the upper one, moved by `by`.
    void at(const Pose& by) {
        const coupling::Scene now = shown.moved(by);
        node.feed("scene", now).feed("pose", now.objects[2].pose).feed("hand", now.objects[2].pose);
    }
};

}  // namespace

TEST_CASE("what is felt over the gain is the tension that is reported, within 2 percent", "[slow]") {
    for (const char* gain : {"1", "3", "6"}) {
        VesselRig rig;
        rig.node.set("gain", gain).set("max_force", "30 N");
        rig.at({});
        rig.node.prepare();
        rig.node.run(1000);
        double worst = 0.0, greatest = 0.0;
        for (int n = 0; n <= 30; ++n) {
            // Aside and down, as a hand does: 1 mm in 50 ms.
            rig.at({Vec3(0.4 * n, -0.3 * n, -n) * mm, vessel_upright});
            rig.node.run(50);
            const double felt = glm::length(rig.node.last<Wrench>("wrench").force) / std::stod(gain);
            const auto reported = rig.node.last<double>("tension");
            greatest = std::max(greatest, reported);
            if (reported > 0.1) worst = std::max(worst, std::abs(felt - reported) / reported);
        }
        CAPTURE(gain, worst, greatest);
        CHECK(greatest > 1.0);
        CHECK(worst < 0.02);
        // And the tension is that of the law at the length that it has: site to root over the rest length.
        const Vec3 root(0.0, 0.0, 99.5 * mm), by(12.0 * mm, -9.0 * mm, -30.0 * mm);
        const double strain = glm::length(root + by - Vec3(0.0, 0.0, site_z * mm)) / (0.89 * 60.0 * mm) - 1.0;
        CHECK(rig.node.last<double>("tension") == Approx(1.86 * strain).epsilon(0.03));
        CHECK(rig.node.last<double>("strain") == Approx(strain).epsilon(0.03));
    }
}

TEST_CASE("the pull acts where the vessel leaves the bone, fades with the grip, and is limited") {
    VesselRig rig;
    rig.node.set("max_force", "0.9 N");
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.prepare();
    rig.node.run(1500);
    const auto felt = rig.node.last<Wrench>("wrench");
    CHECK(glm::length(felt.force) == Approx(0.9).epsilon(1e-6));
    CHECK(felt.force.z > 0.89);
    // 8 mm beside the middle of the rod: the torque turns the piece about -y.
    CHECK(felt.torque.y == Approx(-8.0 * mm * felt.force.z).epsilon(0.05));
    rig.node.feed<double>("strength", 0.25).connect("strength").set("max_force", "30 N");
    rig.node.run(1);
    const double quarter = glm::length(rig.node.last<Wrench>("wrench").force);
    rig.node.feed<double>("strength", 1.0);
    rig.node.run(1);
    CHECK(glm::length(rig.node.last<Wrench>("wrench").force) == Approx(4.0 * quarter).epsilon(1e-3));
    // The other segment of the group feels the same; a piece that has no vessel, and an open hand, nothing.
    for (const auto& [held, wanted] : {std::pair{1.0, true}, {0.0, false}, {-1.0, false}}) {
        rig.node.feed<double>("held", held).disconnect("pose");
        rig.node.run(10);
        CHECK((glm::length(rig.node.last<Wrench>("wrench").force) > 0.1) == wanted);
    }
}

TEST_CASE("the pull comes and goes without a step where nothing states the strength") {
    VesselRig rig;
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.feed<double>("held", [](std::int64_t k) { return k >= 500 && k < 1500 ? 2.0 : -1.0; });
    rig.node.prepare();
    rig.node.run(1800);
    const auto felt = rig.node.values<Wrench>("wrench");
    const double most = glm::length(felt[1499].force);
    REQUIRE(most > 0.5);
    double step = 0.0;
    for (std::size_t k = 1; k < felt.size(); ++k) step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
    CHECK(step < 0.03 * most);
    CHECK(glm::length(felt[1601].force) == 0.0);
}

TEST_CASE("the pull goes from one piece to another without a step, and stays nowhere without a hand") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    VesselRig rig;
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.feed<double>("held", [](std::int64_t k) { return k < 500 ? 1.0 : k < 1000 ? 2.0 : -1.0; });
    const Pose hand = rig.shown.moved({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright}).objects[2].pose;
    rig.node.feed<Pose>("hand", [=](std::int64_t k) { return k < 1010 ? hand : Pose{{nan, 0.0, 0.0}, {1, 0, 0, 0}}; });
    rig.node.disconnect("pose");
    rig.node.prepare();
    rig.node.run(1100);
    const auto felt = rig.node.values<Wrench>("wrench");
    double step = 0.0;
    for (std::size_t k = 400; k < 1010; ++k) step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
    REQUIRE(glm::length(felt[999].force) > 0.5);
    CHECK(step < 0.05 * glm::length(felt[999].force));
    CHECK(glm::length(felt[1010].force) == 0.0);
}

TEST_CASE("a vein gives its reach and no newtons") {
    VesselRig rig;
    rig.node.set("kind", "vein");
    rig.at({Vec3(0.0, 0.0, -30.0 * mm), vessel_upright});
    rig.node.prepare();
    rig.node.run(1500);
    CHECK(rig.node.last<Wrench>("wrench").force == Vec3(0.0));
    CHECK(rig.node.last<double>("tension") == 0.0);
    CHECK(rig.node.last<double>("verdict") == 3.0);
    CHECK_FALSE(rig.node.last<bool>("reaches"));
    rig.at({Vec3(0.0, 0.0, 10.0 * mm), vessel_upright});
    rig.node.run(1000);
    CHECK(rig.node.last<double>("verdict") == 0.0);
    CHECK(rig.node.last<double>("slack") == Approx((0.89 * 60.0 - 50.5) * mm).margin(1.0 * mm));
    CHECK(rig.node.last<bool>("reaches"));
    // Reached is what is sewn.
    rig.node.feed<bool>("sewn", false).connect("sewn");
    rig.node.run(50);
    CHECK_FALSE(rig.node.last<bool>("reaches"));
}

TEST_CASE("a vessel of which the hand holds no piece is solved 200 times a second") {
    for (const double held : {-1.0, 2.0}) {
        VesselRig rig(1000, held);
        rig.at({});
        rig.node.prepare();
        rig.node.run(1);
        const auto before = rig.node.last<rope::RopeShape>("rope").version;
        rig.node.run(1000);
        CHECK(rig.node.last<rope::RopeShape>("rope").version - before == (held < 0.0 ? 200 : 1000));
    }
}

TEST_CASE("a vessel that has not been solved yet tells the way to its site, not to the origin") {
    VesselRig rig(1000, -1.0);
    rig.node.set("idle_rate", "1 Hz").connect("sewn").connect("site");
    rig.node.feed("sewn", false).feed("site", Pose{Vec3(0.0, 0.0, site_z * mm), vessel_upright});
    rig.at({});
    rig.node.prepare();
    rig.node.run(1);
    const double first = rig.node.last<double>("strain");
    rig.node.run(1500);
    CHECK(rig.node.last<double>("strain") == Approx(first).margin(0.02));
}

TEST_CASE("poses that are none give no force that is none") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    VesselRig rig;
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.prepare();
    rig.node.run(1000);
    const double before = glm::length(rig.node.last<Wrench>("wrench").force);
    const Pose none{Vec3(nan), vessel_upright};
    rig.node.feed("pose", none);
    rig.node.run(1);
    CHECK(glm::length(rig.node.last<Wrench>("wrench").force) == Approx(before).epsilon(0.01));
    rig.node.feed("hand", none);
    rig.node.run(1);
    CHECK(rig.node.last<Wrench>("wrench").force == Vec3(0.0));
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.run(100);
    CHECK(glm::length(rig.node.last<Wrench>("wrench").force) == Approx(before).epsilon(0.01));
    CHECK(rig.node.finite());
}

TEST_CASE("a vessel whose site was never there is not sewn, and pulls at nothing") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    VesselRig rig;
    rig.node.feed("site", Pose{Vec3(nan), vessel_upright}).connect("site");
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.prepare();
    rig.node.run(1500);
    CHECK(glm::length(rig.node.last<Wrench>("wrench").force) < 0.1);
    CHECK_FALSE(rig.node.last<bool>("reaches"));
    rig.node.feed("site", Pose{Vec3(0.0, 0.0, site_z * mm), vessel_upright});
    rig.node.run(1500);
    CHECK(glm::length(rig.node.last<Wrench>("wrench").force) > 0.5);
}

TEST_CASE("a course that runs along none of the pieces is refused with what to do") {
    NodeHarness node("vessel", {.period = flicks_per_second / 1000});
    node.asset("plan", flap()).asset("course", vessel_course());
    node.disconnect_optional();
    node.set("pieces", "jaw");
    CHECK_THROWS_WITH(node.prepare(), ContainsSubstring("runs along none of the pieces"));
    node.set("pieces", "implant");
    CHECK_THROWS_WITH(node.prepare(), ContainsSubstring("begins with 'implant'"));
}

namespace {

/// A hand that swings a vessel about; `pieces`: how often those that it is sewn to are seen, Hz; `model`: of `devices`.
struct Swing {
    int rate, pieces;
    bool is_seen;
    std::size_t model;
};

void check_energy(const Swing& swing) {
    simulate::DeviceModel ideal;
    ideal.name = "ideal";
    ideal.max_force = 20.0;
    std::vector<simulate::DeviceModel> devices{ideal, *simulate::find_device_model("touch"),
                                               *simulate::find_device_model("falcon")};
    // N/m: gain · EA / rest length.
    constexpr double stiffness = 3.0 * 1.86 / (0.89 * 60.0 * mm), seconds = 1.0, rest = 0.3;
    const auto& [rate, pieces, is_seen, number] = swing;
    const simulate::DeviceModel& model = devices[number];
    const double dt = 1.0 / rate;
    VesselRig rig(rate);
    rig.node.set("max_force", "30 N");
    simulate::ModelledDevice device(model, {});
    rig.at({});
    if (!is_seen) rig.node.disconnect("pose");
    rig.node.prepare();
    rig.node.run(rate);
    const Pose home = rig.shown.scene.objects[2].body.home;
    const auto intended = [=](double t) {
        const double u = std::clamp(t - rest, 0.0, seconds);
        const double w = 2.0 * pi, in = std::min(1.0, 2.0 * u);
        return in * Vec3(15.0 * std::sin(w * u), 10.0 * std::sin(2.0 * w * u), -15.0 * (1.0 - std::cos(w * u))) * mm;
    };
    double time = 0.0, work = 0.0, explained = 0.0, most = 0.0;
    Vec3 before(0.0), acting(0.0);
    const auto intend = [&](double h, const Wrench& felt, const Pose& pose) {
        // From rest to rest at one place.
        if (time >= rest) work += glm::dot(acting, pose.position - before);
        before = pose.position;
        acting = felt.force;
        const double t = time + 0.5 * h;
        time += h;
        return simulate::Intention{{intended(t), vessel_upright},
                                   {(intended(t + 1e-5) - intended(t - 1e-5)) / 2e-5, Vec3(0.0)}};
    };
    coupling::Scene seen = rig.shown.moved({});
    for (int tick = 0; tick < static_cast<int>((seconds + 2.0 * rest) * rate); ++tick) {
        const Pose here{device.pose().position, vessel_upright};
        if (tick % std::max(1, rate / pieces) == 0) seen = rig.shown.moved(here);
        rig.node.feed("scene", seen).feed("pose", here * home).feed("hand", here * home);
        rig.node.run(1);
        const auto command = rig.node.last<Wrench>("wrench");
        rig.node.forget();
        most = std::max(most, glm::length(command.force));
        const Vec3 from = device.truth().pose.position;
        device.advance(intend, Wrench{command.force, Vec3(0.0)}, dt);
        const double step = glm::length(device.truth().pose.position - from);
        // The force of a sample is held for a tick, and as late as device and pieces are.
        const double late = 1.0 + 2.0 * (model.delay + (is_seen ? 0.0 : 1.0 / pieces)) / dt;
        explained += 0.5 * late * stiffness * step * step + stiffness * 0.5 * model.resolution * step;
    }
    CAPTURE(rate, pieces, is_seen, model.name, work, explained, most);
    CHECK(most > 1.0);
    CHECK(work < explained);
}

}  // namespace

// A third of the combinations: each rate with both other rates, sights and two devices.
TEST_CASE("a vessel gives a hand on a simulated device no energy, at 250 to 2000 Hz, with pieces at 60 and 200 Hz",
          "[slow]") {
    for (const Swing& swing : {Swing{250, 60, true, 0},
                               {250, 200, false, 1},
                               {500, 60, false, 2},
                               {500, 200, true, 1},
                               {1000, 60, true, 2},
                               {1000, 200, false, 0},
                               {2000, 60, false, 1},
                               {2000, 200, true, 0}})
        check_energy(swing);
}

TEST_CASE("a vessel gives a hand no energy on any simulated device, at any rates", "[long]") {
    for (const int rate : {250, 500, 1000, 2000})
        for (const int pieces : {60, 200})
            for (const bool is_seen : {true, false})
                for (const std::size_t model : {0u, 1u, 2u}) check_energy({rate, pieces, is_seen, model});
}

TEST_CASE("a vessel is sewn to a site of the plan by its name, and one of the other kind or none is refused") {
    auto with_sites = std::make_shared<plan::CaseBones>(*flap());
    auto all = std::make_shared<reconstruction::Reconstruction>();
    all->inputs.planes = {{Vec3(-0.04, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}},
                          {Vec3(0.04, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}}};
    all->donor.file = "donor.stl";
    all->flap.sites = {{"facial vein", reconstruction::VesselKind::vein, Vec3(0.0)},
                       {"facial artery", reconstruction::VesselKind::artery, Vec3(2.0, 0.0, site_z) * mm}};
    plan::PlanStep step;
    step.kind = plan::StepKind::reconstruct;
    step.by = "command";
    step.fragments = {0, 1, 2};
    step.reconstruction = all;
    plan::add_step(with_sites->plan, step);
    VesselRig rig;
    rig.node.asset("plan", with_sites).set("plan_site", "facial artery").set("site_at", "0 mm, 0 mm, 500 mm");
    rig.at({Vec3(0.0, 0.0, -20.0 * mm), vessel_upright});
    rig.node.prepare();
    rig.node.run(1500);
    const Vec3 root(0.0, 0.0, 79.5 * mm);
    const double strain = glm::length(root - Vec3(2.0, 0.0, site_z) * mm) / (0.89 * 60.0 * mm) - 1.0;
    CHECK(rig.node.last<double>("strain") == Approx(strain).margin(0.02));
    rig.node.set("plan_site", "facial vein");
    CHECK_THROWS_WITH(rig.node.prepare(), ContainsSubstring("is that of a vein"));
    rig.node.set("plan_site", "lingual artery");
    CHECK_THROWS_WITH(rig.node.prepare(), ContainsSubstring("it has: facial vein, facial artery"));
    rig.node.asset("plan", flap());
    CHECK_THROWS_WITH(rig.node.prepare(), ContainsSubstring("no reconstruction"));
}

TEST_CASE("a piece between two others keeps the one that it is put beside: its target does not jump to and fro") {
    // In the plan all lie as scanned; in the scene the two neighbours have gone apart, so that each wants it elsewhere.
    auto plan = std::make_shared<plan::CaseBones>();
    plan->bones = {rod(0.0, 0.0, 30.0 * mm), rod(0.0, 34.0 * mm, 64.0 * mm), rod(0.0, 68.0 * mm, 98.0 * mm)};
    for (const char* name : {"jaw-1", "segment-1", "jaw-2"}) plan->plan.fragments.push_back({name, name, 0, Vec3(1.0)});
    NodeHarness shown("case_scene", {.period = flicks_per_second / 1000});
    shown.asset("plan", std::shared_ptr<const plan::CaseBones>(plan)).disconnect_optional();
    shown.prepare();
    shown.run(1);
    auto scene = shown.last<coupling::Scene>("scene");
    scene.objects[0].pose.position.x -= 4.0 * mm;
    scene.objects[2].pose.position.x += 4.0 * mm;
    NodeHarness node("planned_place", {.period = flicks_per_second / 1000});
    node.asset("plan", std::shared_ptr<const plan::CaseBones>(plan)).disconnect_optional();
    node.set("meets", "6 mm").feed("scene", scene).feed<double>("held", 1.0).connect("pose");
    node.prepare();
    const Pose home = scene.objects[1].body.home;
    int jumps = 0;
    double before = -1.0;
    const auto at = [&](double x) {
        node.feed("pose", Pose{Vec3(x, 0.0, 0.0), vessel_upright} * home);
        node.run(1);
        const auto partner = node.last<double>("partner");
        jumps += before >= 0.0 && partner != before;
        before = partner;
        return partner;
    };
    CHECK(at(-1.0 * mm) == 0.0);
    // The hand trembles where both are equally near.
    for (int n = 0; n < 200; ++n) at(0.3 * mm * std::sin(0.4 * n));
    CHECK(jumps == 0);
    CHECK(at(1.0 * mm) == 2.0);
    CHECK(at(-0.2 * mm) == 2.0);
    CHECK(at(-1.0 * mm) == 0.0);
    CHECK(jumps == 2);
    // Let go and taken again, it is the nearest one.
    node.feed<double>("held", -1.0);
    node.run(1);
    node.feed<double>("held", 1.0);
    CHECK(at(0.2 * mm) == 2.0);

    // Led to its place it keeps its neighbour, however the hand moves, as long as it fits there.
    jumps = 0;
    node.connect("led").feed("led", true);
    for (int n = 0; n < 200; ++n) CHECK(at(3.0 * mm * std::sin(0.1 * n)) == 2.0);
    CHECK(jumps == 0);
    const Pose target = node.last<Pose>("target");
    CHECK(glm::length(target.position - (home.position + Vec3(4.0, 0.0, 0.0) * mm)) < 1e-12);
    // 15 mm from that place it no longer fits there.
    CHECK(at(-11.2 * mm) == 0.0);
    node.feed("led", false);
    CHECK(at(1.0 * mm) == 2.0);
}

TEST_CASE("a piece near its planned place is pulled to it, with the piece that it meets there") {
    // The plan moves segment-2 by 20 mm; the current alternative has it where it was scanned.
    auto planned = std::make_shared<plan::CaseBones>(*flap());
    plan::PlanStep lock;
    lock.kind = plan::StepKind::lock;
    lock.fragments = {1};
    plan::add_step(planned->plan, lock);
    const Pose goal{Vec3(0.0, 0.0, -3.0 * mm), rotation_by(Vec3(0.0, 0.0, 0.2))};
    REQUIRE(plan::change(planned->plan, plan::PlaceFragment{2, goal}, {}) == plan::PlanHistory::Outcome::done);
    planned->plan.place().head = 0;
    NodeHarness shown("case_scene", {.period = flicks_per_second / 1000});
    shown.asset("plan", planned).disconnect_optional();
    shown.prepare();
    shown.run(1);
    const auto scene = shown.last<coupling::Scene>("scene");
    NodeHarness node("planned_place", {.period = flicks_per_second / 1000});
    node.asset("plan", planned).disconnect_optional();
    node.feed("scene", scene).feed<double>("held", 2.0);
    node.prepare();
    node.run(1);
    CHECK(node.last<bool>("fits"));
    CHECK(node.last<double>("partner") == 1.0);
    CHECK(node.last<double>("fragment") == 2.0);
    CHECK(node.last<double>("angle") == Approx(0.2));
    const Pose target = node.last<Pose>("target"), wanted = goal * scene.objects[2].body.home;
    CHECK(glm::length(target.position - wanted.position) < 1e-12);
    node.set("reach", "1 mm");
    node.run(1);
    CHECK_FALSE(node.last<bool>("fits"));
    node.feed<double>("held", -1.0);
    node.run(1);
    CHECK(node.last<double>("fragment") == -1.0);
    node.set("alternative", "other");
    CHECK_THROWS_WITH(node.prepare(), ContainsSubstring("has no alternative 'other'; it has: main"));
}
