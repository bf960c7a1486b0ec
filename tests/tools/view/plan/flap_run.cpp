// SPDX-License-Identifier: Apache-2.0
#include "tools/view/plan/flap_run.hpp"

#include "assets/cases/plan_file.hpp"
#include "tests/tools/view/plan/plan_rig.hpp"

#include <atomic>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::view;

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
        const cases::PlanState state = cases::state_of(cases::load_case_plan(made));
        CHECK(state.reconstruction->flap.margin == 7e-3);
        CHECK(state.arrangement.is_locked(segment));
    }
};

void widen(reconstruct::Reconstruction& all) { all.flap.margin = 7e-3; }

}  // namespace

TEST_CASE("a change of a reconstruction keeps the steps that the run made while it was computed", "[live]") {
    std::atomic<bool> has_begun = false, may_end = false;
    FlapRig rig;
    rig.flap.change([&](reconstruct::Reconstruction& all) {
        has_begun = true;
        for (int i = 0; i < 6000 && !may_end; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        widen(all);
    });
    REQUIRE(rig.comes([&] { return has_begun.load(); }));
    rig.run.press("lock", segment);
    const bool is_locked = rig.comes([&] { return rig.is_locked(segment); });
    may_end = true;
    REQUIRE(is_locked);
    REQUIRE(rig.is_made(6000));
    rig.check_made();
}

TEST_CASE("a change of a reconstruction keeps the step that was asked for just before", "[live]") {
    FlapRig rig;
    rig.run.press("lock", segment);
    rig.flap.change(widen);
    REQUIRE(rig.is_made(6000));
    rig.check_made();
}

TEST_CASE("a change of a reconstruction waits for the end of a pause with the steps that wait", "[live]") {
    FlapRig rig;
    REQUIRE(rig.pause(true));
    rig.run.press("lock", segment);
    rig.flap.change(widen);
    CHECK(rig.has_told("the run is paused: the change comes when it goes on"));
    CHECK_FALSE(rig.is_made(200));
    REQUIRE(rig.pause(false));
    REQUIRE(rig.is_made(6000));
    rig.check_made();
}
