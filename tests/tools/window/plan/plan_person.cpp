// SPDX-License-Identifier: Apache-2.0
// A person with a mouse and a keyboard puts fragments of a jaw together.
#include "assets/plan/plan_file.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/plan/front_view.hpp"
#include "tests/tools/window/walk.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

using namespace tactus;
using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// Also how the held fragment lies.
struct PlannerEyes : Eyes {
    /// Of the held body: its middle, and its rotation since the scan.
    std::optional<Pose> held() const {
        const std::vector<double> row = last_row("out/fragment.csv");
        if (row.size() < 8) return std::nullopt;
        return Pose{{row[1], row[2], row[3]}, {row[4], row[5], row[6], row[7]}};
    }
    plan::CasePlan plan() const { return plan::load_case_plan(folder / "out/case.plan.json"); }
};

class Planner {
public:
    explicit Planner(Walk& walk)
        : walk_(walk), person_(walk.person), eyes_{walk.eyes}, scene_(eyes_.spot("scene picture")) {
        camera_ = front_view(width() / height());
        right_ = camera_.orientation * Vec3(1.0, 0.0, 0.0);
        up_ = camera_.orientation * Vec3(0.0, 1.0, 0.0);
        forward_ = camera_.orientation * Vec3(0.0, 0.0, -1.0);
    }

    const PlannerEyes& eyes() const { return eyes_; }
    void press(const std::string& control) { walk_.press(control, "panel plan steps"); }
    /// The hand goes to what is seen there.
    void reach(const Vec3& point) {
        const Vec3 at = place_in(scene_, camera_, point);
        const double x = at.x, y = at.y;
        reached_ = fmt::format("reached at {:.0f}, {:.0f} of a scene from {:.0f}, {:.0f} to {:.0f}, {:.0f}", x, y,
                               scene_.left, scene_.top, scene_.right, scene_.bottom);
        person_.move(x, y);
        Person::wait(0.3);
        for (int i = 0; i < 2; ++i) {
            person_.button(1, true);
            person_.button(1, false);
            Person::wait(0.05);
        }
        Person::wait(1.0);
    }
    /// Tries again until something is held, as a person does.
    void grasp(const Vec3& point) {
        for (int i = 0; i < 8; ++i) {
            reach(point);
            press("grasp");
            for (int n = 0; n < 30; ++n) {
                Person::wait(0.1);
                if (const auto held = eyes_.held(); held && glm::length(held->position - point) < 0.02) return;
            }
            press("grasp");
        }
        FAIL("nothing is held; " << reached_);
    }
    /// Carries the held fragment until its middle and its rotation are nearly these.
    void carry(const Vec3& to, const Quat& rotation, double within_m, double within_rad) {
        for (int i = 0; i < 30; ++i) {
            const auto now = eyes_.held();
            REQUIRE(now);
            // A busy machine's window lets go of what is held when it is silent for 1 s.
            if (!walk_.shows("grasp is held")) {
                reach(now->position);
                press("grasp");
                Person::wait(1.0);
            }
            const Vec3 turn = rotation_between(now->orientation, rotation), way = to - now->position;
            UNSCOPED_INFO("off by " << 1e3 * glm::length(way) << " mm, " << glm::length(turn) * 57.3 << " deg");
            if (glm::length(way) < within_m && glm::length(turn) < within_rad) return;
            constexpr double per_pixel_rad = 0.006;
            if (glm::length(turn) > 0.5 * within_rad) {
                drag(glm::dot(turn, forward_) / per_pixel_rad, 0.0, 3, true);
                drag(glm::dot(turn, up_) / per_pixel_rad, glm::dot(turn, right_) / per_pixel_rad, 3, false);
            }
            const double depth = glm::dot(now->position - camera_.eye(), forward_);
            const double per_pixel = 2.0 * depth * std::tan(0.5 * camera_.vertical_field_of_view_rad) / height();
            drag(0.0, -glm::dot(way, forward_) / per_pixel, 1, true);
            drag(glm::dot(way, right_) / per_pixel, -glm::dot(way, up_) / per_pixel, 1, false);
            Person::wait(0.6);
        }
        FAIL("the fragment does not get there");
    }
    void drag(double x, double y, int button, bool shifts) {
        if (std::abs(x) < 0.5 && std::abs(y) < 0.5) return;
        const double at_x = 0.5 * (scene_.left + scene_.right) - 0.5 * x,
                     at_y = 0.5 * (scene_.top + scene_.bottom) - 0.5 * y;
        if (shifts) person_.key("Shift_L", true);
        Person::wait(0.1);
        person_.drag(at_x, at_y, at_x + x, at_y + y, 0.5, button);
        Person::wait(0.1);
        if (shifts) person_.key("Shift_L", false);
        Person::wait(0.1);
    }
    /// Grasps a fragment, carries it past a place beside its own, asks for a fit, settles it and lets it go.
    void put(const std::string& name, const Vec3& aside) {
        const Belongs belongs = truth().at(name);
        const Vec3 place = belongs.pose.apply(belongs.middle);
        const std::size_t before = eyes_.plan().steps.size();
        grasp(belongs.middle);
        INFO(name << " " << reached_);
        carry(belongs.middle + Vec3(0.0, 0.025, 0.0), {1.0, 0.0, 0.0, 0.0}, 8e-3, 0.2);
        carry(place + aside, belongs.pose.orientation, 6e-3, 0.1);
        carry(place + 0.12 * aside, belongs.pose.orientation, 7e-3, 0.12);
        press("snap");
        Person::wait(3.0);
        press("settle");
        Person::wait(1.5);
        press("grasp");
        press("settle");
        press("snap");
        Person::wait(1.0);
        const plan::CasePlan plan = eyes_.plan();
        REQUIRE(plan.steps.size() > before);
        CHECK(plan.steps.back().by == "settle");
    }

private:
    double width() const { return scene_.right - scene_.left; }
    double height() const { return scene_.bottom - scene_.top; }
    Walk& walk_;
    Person& person_;
    PlannerEyes eyes_;
    Spot scene_;
    std::string reached_;
    display::OrbitCamera camera_;
    Vec3 right_, up_, forward_;
};

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a person with a mouse puts a fragment in its place, groups three, undoes two steps and exports",
          "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "plan");
        if (!walk.is_possible()) return;
        Person& person = walk.person;
        walk.start(
            "run planning-trauma --view --layout plan --set hand.device=mouse --audio none --out out --seconds 480 "
            "--json",
            480.0);
        // Not before a run that ticks and has written its plan: the hand is seen for a moment while all is loaded.
        REQUIRE(walk.waits_for("part fragment_02"));
        REQUIRE(sees([&] { return fs::exists(walk.folder.path / "out/case.plan.json"); }));
        REQUIRE(walk.waits_for("trigger (T)"));
        person.tap("1");
        Person::wait(1.5);
        walk.keep("begin");
        Planner planner(walk);
        const PlannerEyes& eyes = planner.eyes();
        planner.put("fragment_07", {0.04, -0.007, 0.0});
        walk.keep("placed");
        const std::size_t placed = eyes.plan().steps.size();

        // One group of three, by the list.
        walk.press("part fragment_01", "panel tree");
        person.key("Control_L", true);
        walk.press("part fragment_07", "panel tree");
        walk.press("part fragment_02", "panel tree");
        person.key("Control_L", false);
        walk.keep("chosen");
        planner.press("group");
        sees([&] { return eyes.plan().steps.size() > placed; });
        const plan::CasePlan grouped = eyes.plan();
        REQUIRE(grouped.steps.size() == placed + 1);
        const plan::PlanState together = plan::state_of(grouped);
        CHECK(together.arrangement.move_together(0, 6));
        CHECK(together.arrangement.move_together(0, 1));
        walk.keep("grouped");

        planner.press("undo step");
        planner.press("undo step");
        sees([&] { return eyes.plan().place().head == static_cast<int>(placed) - 2; });
        const plan::PlanState apart = plan::state_of(eyes.plan());
        CHECK_FALSE(apart.arrangement.move_together(0, 6));
        CHECK_FALSE(apart.arrangement.move_together(0, 1));
        CHECK(eyes.plan().steps.size() == placed + 1);
        walk.keep("undone");
        planner.press("export");
        sees([&] { return fs::exists(walk.folder.path / "out/export-1/fragment_12.plan.mrk.json"); });
        CHECK(fs::exists(walk.folder.path / "out/export-1/fragment_07.plan.mrk.json"));
        walk.keep("exported");
        walk.stop();
    }
}
