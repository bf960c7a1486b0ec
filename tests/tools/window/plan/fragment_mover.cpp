// SPDX-License-Identifier: Apache-2.0
// What the mouse does to a fragment is one step of the plan, in a run and without one.
#include "tools/window/document/fragment_mover.hpp"

#include "assets/plan/case_bones.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/tools/held_lane.hpp"
#include "tests/tools/jaw_case.hpp"
#include "tests/tools/window/plan/plan_rig.hpp"
#include "tools/window/document/plan_preview.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

namespace {

using Parts = std::vector<std::shared_ptr<const nodes::BodyParts>>;

/// Of the library's jaw.
const Parts& jaw_parts() {
    static const Parts made = [] {
        plan::CasePlan plan = plan::load_case_plan(case_folder() / "case.plan.json");
        plan::make_files_absolute(plan, case_folder());
        Parts parts;
        for (const plan::PlanFragment& fragment : plan.fragments)
            parts.push_back(nodes::body_of_fragment(plan::fragment_bone(fragment, {}, plan::Paint::or_proposed).bone));
        return parts;
    }();
    return made;
}

/// To the bit, but for the last one of a quaternion that was normalised again.
bool is_same_place(const Pose& a, const Pose& b) {
    return a.position == b.position && glm::length(rotation_between(a.orientation, b.orientation)) < 1e-15;
}

constexpr int dragged = 3;

/// Drags a fragment out of the row of the others as the mouse does, and leaves it. Returns where it was left.
template <class Picture>
Pose drag_out(FragmentMover& mover, const Picture& picture) {
    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    const double before = mover.drag()->now().pose(dragged).position.y;
    picture();
    mover.move(Vec3(0.0, -80.0, 0.0) * mm);
    for (int n = 0; n < 400 && !mover.drag()->has_arrived(); ++n) picture();
    REQUIRE(mover.poses().size() == jaw_parts().size());
    const Pose left = *mover.poses()[dragged];
    CHECK(mover.drag()->now().pose(dragged).position.y - before < -60.0 * mm);
    mover.release();
    return left;
}

}  // namespace

TEST_CASE("a fragment that is dragged without a run is one step, and none where it is only taken", "[slow]") {
    const Folder folder;
    const auto file = folder.path / "jaw.plan.json";
    plan::CasePlan plan = plan::load_case_plan(case_folder() / "case.plan.json");
    plan::make_files_absolute(plan, case_folder());
    plan::save_case_plan(plan, file);
    RunChoice choice;
    choice.patch = (library_folder() / "patches/planning-trauma.toml").string();
    choice.out = folder.path / "out";
    choice.audio = "none";
    Workbench bench(choice);
    CaseRun run(bench);
    PlanDocument document(file);
    run.use(&document);
    FragmentMover mover(bench, run);
    const auto picture = [&] {
        bench.tend();
        mover.tend(jaw_parts());
        run.tend(bench.observer());
    };
    picture();
    const std::size_t steps = document.plan().steps.size();
    const Pose left = drag_out(mover, picture);
    REQUIRE(document.plan().steps.size() == steps + 1);
    CHECK(is_same_place(document.plan().steps.back().poses[0], left));
    // The scene shows it there until the plan has it.
    for (int n = 0; n < 3; ++n) picture();
    CHECK(mover.poses().empty());
    CHECK_FALSE(document.is_saved());

    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    picture();
    mover.release();
    // Put back before it was left.
    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    mover.move(Vec3(0.0, 0.0, 10.0) * mm);
    picture();
    mover.cancel();
    picture();
    CHECK(mover.poses().empty());
    CHECK(document.plan().steps.size() == steps + 1);
    // A place that is offered stays shown by a click, and no other fragment is moved meanwhile.
    const Pose offered{Vec3(0.0, 0.1, 0.2), {1.0, 0.0, 0.0, 0.0}};
    mover.offer(dragged, offered);
    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    picture();
    mover.release();
    picture();
    REQUIRE(mover.offers());
    CHECK(mover.poses()[dragged]->position == offered.position);
    std::string reason;
    CHECK(mover.take(dragged + 1, &reason) == FragmentMover::Taken::no);
    CHECK(reason.find("chosen first") != std::string::npos);
    // From there it is dragged on, which ends the offer.
    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    mover.move(Vec3(0.0, 0.0, 10.0) * mm);
    for (int n = 0; n < 100 && !mover.drag()->has_arrived(); ++n) picture();
    mover.release();
    CHECK_FALSE(mover.offers());
    picture();
    REQUIRE(document.plan().steps.size() == steps + 2);
    CHECK(glm::length(document.plan().steps.back().poses[0].position - (offered.position + Vec3(0.0, 0.0, 10.0) * mm)) <
          1e-4);
    for (int n = 0; n < 3; ++n) picture();

    // One that is locked, or whose bones are not there yet, is not taken, and it is said why.
    std::string why;
    CHECK(mover.take(0, &why) == FragmentMover::Taken::no);
    CHECK(why.find("locked") != std::string::npos);
    mover.tend({});
    CHECK(mover.take(dragged, &why) == FragmentMover::Taken::not_yet);
    CHECK(why.find("loaded") != std::string::npos);
}

TEST_CASE("a fragment that is dragged in a run is one step of the run, where it was left", "[virtual][slow]") {
    PlanRig rig("planning-trauma");
    FragmentMover mover(rig.bench, rig.run);
    rig.also = [&] { mover.tend(jaw_parts()); };
    rig.picture();
    const std::size_t steps = rig.run.plan()->steps.size();
    const Pose left = drag_out(mover, [&] { rig.picture(); });
    REQUIRE(rig.comes([&] { return rig.run.plan()->steps.size() > steps; }, 600));
    CHECK(rig.run.plan()->steps.size() == steps + 1);
    CHECK(is_same_place(rig.run.plan()->steps.back().poses[0], left));
    CHECK(rig.comes([&] { return mover.poses().empty(); }, 600));

    // A second drag begins where the first has left it, and not before the plan has that.
    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    mover.move(Vec3(0.0, -20.0, 0.0) * mm);
    for (int n = 0; n < 400 && !mover.drag()->has_arrived(); ++n) rig.picture();
    const Pose second = *mover.poses()[dragged];
    mover.release();
    std::string why;
    FragmentMover::Taken taken = mover.take(dragged, &why);
    CHECK(taken == FragmentMover::Taken::not_yet);
    CHECK(why.find("not in the plan yet") != std::string::npos);
    REQUIRE(rig.comes(
        [&] {
            taken = mover.take(dragged);
            return taken != FragmentMover::Taken::not_yet;
        },
        600));
    REQUIRE(taken == FragmentMover::Taken::yes);
    CHECK(is_same_place(mover.drag()->now().pose(dragged), second));
    mover.cancel();

    // In a pause a step is on its way for as long as the pause.
    REQUIRE(rig.pause(true));
    REQUIRE(mover.take(dragged) == FragmentMover::Taken::yes);
    mover.move(Vec3(0.0, -20.0, 0.0) * mm);
    for (int n = 0; n < 400 && !mover.drag()->has_arrived(); ++n) rig.picture();
    const Pose third = *mover.poses()[dragged];
    mover.release();
    rig.pictures(300);
    REQUIRE(mover.poses().size() == jaw_parts().size());
    CHECK(is_same_place(*mover.poses()[dragged], third));
    REQUIRE(rig.pause(false));
    CHECK(rig.comes([&] { return rig.run.plan()->steps.size() == steps + 3 && mover.poses().empty(); }, 600));
}

TEST_CASE("a fit is found and the bones of a plan are loaded while a long study of it goes on", "[slow]") {
    plan::CasePlan plan = plan::load_case_plan(case_folder() / "case.plan.json");
    plan::make_files_absolute(plan, case_folder());
    const auto shared = std::make_shared<const plan::CasePlan>(std::move(plan));
    const HeldLane held(analysis::Lane::studies);
    PlanPreview preview;
    FragmentFits fits;
    fit::Arrangement near = plan::state_of(*shared).arrangement;
    near.move(6, truth().at("fragment_07").pose);
    fits.look_near(shared, near, 6);
    const auto comes = [](const auto& what) {
        for (int n = 0; n < 6000; ++n) {
            if (what()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    REQUIRE(comes([&] { return fits.near(6) != nullptr; }));
    CHECK(fits.near(6)->fits());
    CHECK(comes([&] {
        preview.tend(shared, "case.scene");
        return preview.parts().size() == shared->fragments.size();
    }));
}
