// SPDX-License-Identifier: Apache-2.0
// Hands that devices pull, as the scene shows them.
#include "tools/window/hand/pulled_hands.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/window/document/hand_of_patch.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

#include <limits>
#include <memory>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

/// The ball patch with a hand on another device, which tells where it is wanted.
struct PulledRig {
    Workbench bench{choice()};
    std::shared_ptr<observe::Observer> observer = std::make_shared<observe::Observer>();
    std::shared_ptr<haptic::PullLink> link = std::make_shared<haptic::PullLink>();
    RunStatus status;
    PulledHands hands;

    static RunChoice choice() {
        RunChoice choice;
        choice.patch = (library_folder() / "patches/touch-sphere.toml").string();
        choice.overrides.settings = {"hand.device=gamepad"};
        return choice;
    }
    PulledRig() {
        REQUIRE(bench.plan());
        hands.follow(observer, render::outline_of(*bench.plan()), *bench.plan());
        status.state = RunStatus::State::runs;
        status.pulls = {{"gamepad", link}};
    }
    void tell(std::int64_t at_ns) {
        link->write({{Vec3(0.01, 0.0, 0.0), {}}, {Vec3(0.02, 0.0, 0.003), {}}, {Vec3(0.0, 3.0, 4.0), {}}, at_ns});
    }
    std::size_t shown(std::int64_t now_ns) {
        hands.look(status, now_ns);
        return hands.sights().size();
    }
};

}  // namespace

TEST_CASE("a hand that a device pulls is seen where it is and wanted, with its force and its limit") {
    PulledRig rig;
    CHECK(rig.shown(second_ns) == 0);  // it has told nothing yet
    rig.tell(second_ns);
    REQUIRE(rig.shown(second_ns) == 1);
    const HandSight sight = rig.hands.sights().front();
    CHECK(sight.hand == Vec3(0.01, 0.0, 0.0));
    CHECK(sight.wanted == Vec3(0.02, 0.0, 0.003));
    CHECK(sight.force_N == Approx(5.0));
    CHECK(sight.limit_N == largest_force(*rig.bench.plan()));
    CHECK(sight.name == "gamepad");
    // A device that the patch does not read as a hand is none of its scene.
    rig.status.pulls = {{"other", rig.link}};
    CHECK(rig.shown(second_ns) == 0);
}

TEST_CASE("a pulled hand that nobody reads any more is gone, but not in a pause") {
    PulledRig rig;
    rig.tell(second_ns);
    REQUIRE(rig.shown(second_ns) == 1);
    rig.status.state = RunStatus::State::stands;
    CHECK(rig.shown(9 * second_ns) == 1);
    rig.status.state = RunStatus::State::runs;
    CHECK(rig.shown(9 * second_ns) == 0);
    rig.tell(9 * second_ns);
    CHECK(rig.shown(9 * second_ns) == 1);
    // Times of a process that is broken.
    for (const std::int64_t at_ns : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1},
                                     std::numeric_limits<std::int64_t>::max(), 99 * second_ns}) {
        rig.tell(at_ns);
        CHECK(rig.shown(9 * second_ns) == 0);
    }
    rig.tell(9 * second_ns);
    CHECK(rig.shown(9 * second_ns) == 1);
    rig.status = {};
    CHECK(rig.shown(9 * second_ns) == 0);
}

TEST_CASE("springs and bars of several hands stand beside each other") {
    ImGuiContext* const before = ImGui::GetCurrentContext();
    ImGuiContext* const own = ImGui::CreateContext();
    ImGui::SetCurrentContext(own);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = ImVec2(400.0f, 300.0f);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    ImGui::NewFrame();
    ImFont* const font = ImGui::GetFont();
    const Fonts fonts{font, font, font, 1.0};
    const Painter paint(ImGui::GetForegroundDrawList(), fonts);
    const SeenAt seen = [](const Vec3& at) { return std::optional(Point{1e3 * at.x, 1e3 * at.z}); };
    const HandSight sight{Vec3(0.1, 0.0, 0.1), Vec3(0.2, 0.0, 0.1), 5.0, 20.0, {}};
    draw_spring(paint, seen, sight);
    forget_spots();  // from now on those are the last ones
    CHECK(spot("hand cursor")->middle().x == Approx(200.0));
    CHECK(spot("hand tool")->middle().x == Approx(100.0));
    const int with_turns = paint.list()->VtxBuffer.Size;
    CHECK(with_turns > 16 * 4);
    draw_spring(paint, [](const Vec3&) { return std::optional<Point>(); }, sight);
    CHECK(paint.list()->VtxBuffer.Size == with_turns);
    const double left = draw_force_bar(paint, {0.0, 0.0, 400.0, 300.0}, sight);
    forget_spots();
    const Box first = *spot("force bar");
    CHECK(left <= first.left);
    draw_force_bar(paint, {0.0, 0.0, left, 300.0}, sight);
    forget_spots();
    CHECK(spot("force bar")->right < first.left);
    ImGui::EndFrame();
    forget_spots();
    ImGui::DestroyContext(own);
    ImGui::SetCurrentContext(before);
}
