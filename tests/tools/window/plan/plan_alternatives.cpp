// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/plan_alternatives.hpp"

#include "assets/plan/plan_file.hpp"
#include "devices/haptic/window_hand.hpp"
#include "dsp/core/clock.hpp"
#include "tests/tools/window/plan/plan_rig.hpp"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

namespace {

constexpr int fragment = 3;

struct Rig : PlanRig {
    ScenePanel scene{bench};
    PlanAlternatives alternatives{bench, run, scene};
    std::filesystem::path made;

    explicit Rig(const std::vector<std::string>& settings = {"grasp.fixed=16"})
        : PlanRig("planning-trauma", 1.0, settings) {
        also = [this] { alternatives.tend(); };
        REQUIRE_FALSE(is_locked(fragment));
    }
    bool is_made(int pictures) {
        return comes([&] { return !(made = alternatives.take_changed()).empty(); }, pictures);
    }
};

}  // namespace

TEST_CASE("another name for an alternative keeps the step that was asked for just before", "[virtual][slow]") {
    Rig rig;
    rig.run.toggle_lock({fragment});
    rig.alternatives.rename("main", "before");
    REQUIRE(rig.is_made(6000));
    const plan::CasePlan plan = plan::load_case_plan(rig.made);
    CHECK(plan.alternatives[0].name == "before");
    CHECK(plan::state_of(plan).arrangement.is_locked(fragment));
    CHECK(rig.alternatives.take_changed().empty());
}

TEST_CASE("another name that is given in a pause waits for the steps that were asked for before", "[virtual][slow]") {
    Rig rig;
    REQUIRE(rig.pause(true));
    rig.run.toggle_lock({fragment});
    rig.alternatives.rename("main", "before");
    CHECK(rig.has_told("the run is paused: the change comes when it goes on"));
    CHECK_FALSE(rig.is_made(200));
    REQUIRE(rig.pause(false));
    REQUIRE(rig.is_made(1000));
    CHECK(plan::state_of(plan::load_case_plan(rig.made)).arrangement.is_locked(fragment));
}

TEST_CASE("a run that is ended after another name was given does not begin again with it", "[virtual][slow]") {
    Rig rig;
    rig.run.toggle_lock({fragment});
    rig.alternatives.rename("main", "before");
    rig.bench.stop();
    REQUIRE(rig.comes([&] { return rig.bench.status()->state == RunStatus::State::over; }, 1000));
    CHECK_FALSE(rig.is_made(150));
    CHECK(rig.has_told("'main' keeps its name"));
}

TEST_CASE("who holds a fragment gives no other name before it is let go and where it is has become a step",
          "[virtual][slow]") {
    ++haptic::window_hand().windows;
    Rig rig({"hand.device=mouse", "grasp.reach=1 m"});
    std::int64_t buttons = button_trigger;
    Pose at;
    rig.also = [&] {
        haptic::FeltHand felt;
        std::uint64_t number = 0;
        haptic::window_hand().felt.read(felt, number);
        haptic::window_hand().wanted.write({at, buttons, steady_ns(), 16'000'000, felt.run});
    };
    REQUIRE(rig.comes([&] { return rig.run.is_holding(); }, 1000));
    at.position.x = 5e-3;
    const std::size_t before = rig.run.steps().size();
    rig.alternatives.rename("main", "before");
    CHECK(rig.has_told("let the fragment go first"));
    CHECK_FALSE(rig.is_made(200));
    buttons = 0;
    REQUIRE(rig.comes([&] { return !rig.run.is_holding(); }, 1000));
    rig.alternatives.rename("main", "before");
    REQUIRE(rig.is_made(1000));
    CHECK(step_lines(plan::load_case_plan(rig.made)).size() == before + 1);
    --haptic::window_hand().windows;
}
