// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/flap_run.hpp"

#include "assets/plan/plan_file.hpp"
#include "tests/tools/window/plan/plan_rig.hpp"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

namespace {

constexpr int segment = 3;

struct FlapRig : PlanRig {
    FlapRun flap{bench, run};
    std::filesystem::path made;

    FlapRig() : PlanRig("planning-reconstruction") {
        also = [this] { flap.tend(); };
        REQUIRE(comes([&] { return flap.reconstruction() != nullptr; }));
        REQUIRE_FALSE(is_locked(segment));
    }
    bool is_made(int pictures) {
        return comes([&] { return !(made = flap.take_changed()).empty(); }, pictures);
    }
    void check_made() const {
        const plan::PlanState state = plan::state_of(plan::load_case_plan(made));
        CHECK(state.reconstruction->flap.margin == 7e-3);
        CHECK(state.arrangement.is_locked(segment));
    }
};

void widen(reconstruction::Reconstruction& all) { all.flap.margin = 7e-3; }

}  // namespace

TEST_CASE("a change of a reconstruction keeps the steps that the run made while it was computed", "[virtual][slow]") {
    std::atomic<bool> has_begun = false, may_end = false;
    FlapRig rig;
    rig.flap.change([&](reconstruction::Reconstruction& all) {
        has_begun = true;
        for (int i = 0; i < 6000 && !may_end; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        widen(all);
    });
    REQUIRE(rig.comes([&] { return has_begun.load(); }));
    rig.run.toggle_lock({segment});
    const bool is_locked = rig.comes([&] { return rig.is_locked(segment); });
    may_end = true;
    REQUIRE(is_locked);
    REQUIRE(rig.is_made(6000));
    rig.check_made();
}

TEST_CASE("a change of a reconstruction keeps the step that was asked for just before", "[virtual][slow]") {
    FlapRig rig;
    rig.run.toggle_lock({segment});
    rig.flap.change(widen);
    REQUIRE(rig.is_made(6000));
    rig.check_made();
}

TEST_CASE("a change of a reconstruction waits for the end of a pause with the steps that wait", "[virtual][slow]") {
    FlapRig rig;
    REQUIRE(rig.pause(true));
    rig.run.toggle_lock({segment});
    rig.flap.change(widen);
    CHECK(rig.has_told("the run is paused: the change comes when it goes on"));
    CHECK_FALSE(rig.is_made(200));
    REQUIRE(rig.pause(false));
    REQUIRE(rig.is_made(6000));
    rig.check_made();
}

TEST_CASE("undo of a change of the reconstruction reaches the nodes that have read it", "[virtual][slow]") {
    FlapRig rig;
    const double before = rig.flap.reconstruction()->flap.margin;
    REQUIRE(before != 7e-3);
    rig.flap.change(widen);
    REQUIRE(rig.is_made(6000));
    rig.bench.run_with(rig.run.asset(), rig.made, rig.run.file());
    REQUIRE(rig.comes([&] { return rig.flap.reconstruction() && rig.flap.reconstruction()->flap.margin == 7e-3; }));
    // The run that has it is not begun again.
    CHECK_FALSE(rig.is_made(200));
    const std::size_t steps = rig.run.plan()->steps.size();
    rig.run.give(plan::UndoStep{});
    REQUIRE(rig.is_made(6000));
    const plan::CasePlan undone = plan::load_case_plan(rig.made);
    CHECK(plan::state_of(undone).reconstruction->flap.margin == before);
    CHECK(undone.steps.size() == steps);
    rig.bench.run_with(rig.run.asset(), rig.made, rig.run.file());
    REQUIRE(rig.comes([&] { return rig.flap.reconstruction() && rig.flap.reconstruction()->flap.margin == before; }));
    rig.run.give(plan::RedoStep{});
    REQUIRE(rig.is_made(6000));
    CHECK(plan::state_of(plan::load_case_plan(rig.made)).reconstruction->flap.margin == 7e-3);
}

TEST_CASE("a change with which the patch cannot run is told and the run goes on without it", "[virtual][slow]") {
    FlapRig rig;
    const std::size_t sites = rig.flap.reconstruction()->flap.sites.size();
    rig.run.toggle_lock({segment});
    REQUIRE(rig.comes([&] { return rig.is_locked(segment); }));
    rig.flap.change([](reconstruction::Reconstruction& all) { all.flap.sites.clear(); });
    REQUIRE(rig.is_made(6000));
    rig.bench.run_with(rig.run.asset(), rig.made, std::filesystem::absolute(rig.run.file()));
    REQUIRE(rig.comes([&] { return rig.has_told("the run could not begin with the change"); }));
    REQUIRE(rig.comes([&] { return rig.run.is_live() && rig.flap.reconstruction() != nullptr; }));
    CHECK(rig.flap.reconstruction()->flap.sites.size() == sites);
    CHECK(rig.is_locked(segment));
}

TEST_CASE("a part of a reconstruction is changed and renamed in place and takes no name of another one") {
    struct Part {
        std::string name;
        int value = 0;
    };
    std::vector<Part> all{{"a", 1}, {"b", 2}};
    put_named(all, "a", Part{"c", 3});
    REQUIRE(all.size() == 2);
    CHECK(all[0].name == "c");
    put_named(all, "c", Part{"c", 4});
    CHECK(all[0].value == 4);
    put_named(all, "", Part{"d", 5});
    CHECK(all.size() == 3);
    CHECK_THROWS_WITH(put_named(all, "", Part{"b", 6}), Catch::Matchers::ContainsSubstring("'b' is there already"));
    CHECK_THROWS_AS(put_named(all, "d", Part{"b", 6}), Error);
    CHECK(all[1].value == 2);
    CHECK(all.size() == 3);
}

TEST_CASE("the skin paddle is a step of the plan, and so is its removal", "[virtual][slow]") {
    FlapRig rig;
    rig.flap.lay_paddle({std::nullopt, 70e-3, 30e-3});
    REQUIRE(rig.is_made(6000));
    const plan::CasePlan laid = plan::load_case_plan(rig.made);
    const auto paddle = plan::state_of(laid).reconstruction->flap.paddle;
    REQUIRE(paddle);
    CHECK(paddle->length == 70e-3);
    CHECK(paddle->width == 30e-3);
    // One step more, and undo goes back before it.
    REQUIRE(laid.place().head >= 0);
    const int before = laid.steps[static_cast<std::size_t>(laid.place().head)].before;
    const auto was = plan::state_of(laid, before).reconstruction->flap.paddle;
    CHECK((!was || was->length != 70e-3));
}

// Costly: a guide is made, and another one is refused.
TEST_CASE("a guide is a step of the plan with its settings, and one that must not be printed changes nothing",
          "[virtual][slow]") {
    FlapRig rig;
    reconstruction::KeptGuide guide;
    guide.name = "g/1";
    rig.flap.make_guide(guide);
    REQUIRE(rig.comes([&] { return rig.flap.take_refusal(); }, 6000));
    CHECK(rig.has_told("'g/1' is no name of a guide: letters, digits, '-' and '_'"));
    guide.name = "g1", guide.is_of_jaw = true, guide.cut = 1;
    rig.flap.make_guide(guide);
    REQUIRE(rig.is_made(60000));
    const plan::CasePlan made = plan::load_case_plan(rig.made);
    const auto guides = plan::state_of(made).reconstruction->guides;
    REQUIRE(guides.size() == 1);
    CHECK(guides[0].name == "g1");
    CHECK(guides[0].is_of_jaw);
    CHECK(guides[0].cut == 1);
    const auto file = plan::file_of(guides[0].mesh.file, rig.made.parent_path());
    CHECK(std::filesystem::exists(file));
    // Undo takes it away.
    const int before = made.steps[static_cast<std::size_t>(made.place().head)].before;
    CHECK(plan::state_of(made, before).reconstruction->guides.empty());
}
