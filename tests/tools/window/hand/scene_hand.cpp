// SPDX-License-Identifier: Apache-2.0
// When the window begins to move the hand of a run.
#include "tools/window/hand/scene_hand.hpp"

#include "devices/haptic/window_hand.hpp"
#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"

#include <imgui.h>

#include <chrono>
#include <thread>

using namespace tactus;

namespace {

constexpr std::int64_t run = 4711;

/// A device that ticks, or only waits, for as long as a picture takes.
void draw(window::SceneHand& hand, std::int64_t ticked_ns, std::chrono::milliseconds takes) {
    haptic::FeltHand felt;
    felt.run = run;
    felt.at_ns = ticked_ns;
    haptic::window_hand().felt.write(felt);
    hand.begin_picture();
    std::this_thread::sleep_for(takes);
    hand.end_picture();
}

bool has_spoken() {
    haptic::WantedHand wanted;
    std::uint64_t number = 0;
    return haptic::window_hand().wanted.read(wanted, number) && wanted.run == run;
}

}  // namespace

TEST_CASE("a window whose pictures take long moves the hand after the first of them, but not before the first tick",
          "[slow]") {
    window::SceneHand hand;
    // Read anew in each picture, but without ticks.
    const std::int64_t opened = steady_ns();
    for (int n = 0; n < 8; ++n) draw(hand, opened, std::chrono::milliseconds(20));
    CHECK_FALSE(has_spoken());
    for (int n = 0; n < 5; ++n) draw(hand, steady_ns(), std::chrono::milliseconds(800));
    CHECK(has_spoken());
    haptic::window_hand().felt.write({});
}

namespace {

/// A hand in a window without a screen.
struct Rig {
    ImGuiContext* before = ImGui::GetCurrentContext();
    ImGuiContext* own = ImGui::CreateContext();
    window::SceneHand hand;
    haptic::FeltHand felt;
    bool is_steered = true, has_menu = false;

    Rig() {
        ImGui::SetCurrentContext(own);
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = ImVec2(400.0f, 300.0f);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        felt.run = run + 1;
        for (int n = 0; n < 8; ++n) picture();
        REQUIRE(hand.is_there());
    }
    ~Rig() {
        ImGui::DestroyContext(own);
        ImGui::SetCurrentContext(before);
        haptic::window_hand().felt.write({});
    }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    void picture(std::int64_t silent_ns = 0) {
        felt.at_ns = steady_ns() - silent_ns;
        haptic::window_hand().felt.write(felt);
        hand.begin_picture();
        ImGui::NewFrame();
        ImGui::Begin("scene");
        if (has_menu && !ImGui::IsPopupOpen("menu")) ImGui::OpenPopup("menu");
        if (ImGui::BeginPopup("menu")) {
            if (!has_menu) ImGui::CloseCurrentPopup();
            ImGui::EndPopup();
        }
        ImGui::InvisibleButton("space", ImVec2(50.0f, 50.0f));
        if (is_steered) hand.steer({}, 50);
        ImGui::End();
        ImGui::EndFrame();
        hand.end_picture();
    }
    void key(bool down) const { ImGui::GetIO().KeysDown['T'] = down; }
    haptic::WantedHand wanted() const {
        haptic::WantedHand said;
        std::uint64_t number = 0;
        REQUIRE(haptic::window_hand().wanted.read(said, number));
        return said;
    }
};

constexpr std::int64_t one_second_ns = 1'000'000'000;

}  // namespace

TEST_CASE("a trigger that is let go of while the scene is not drawn does not stay pressed") {
    Rig rig;
    rig.key(true);
    rig.picture();
    REQUIRE((rig.wanted().buttons & button_trigger) != 0);
    rig.is_steered = false;
    rig.key(false);
    rig.picture();
    rig.picture();
    CHECK((rig.wanted().buttons & button_trigger) == 0);
    // Nor does one count that stayed down.
    rig.key(true);
    rig.picture();
    rig.is_steered = true;
    rig.picture();
    CHECK_FALSE(rig.hand.is_held(0));
    rig.key(false);
    rig.picture();
    rig.key(true);
    rig.picture();
    CHECK(rig.hand.is_held(0));
}

TEST_CASE("Ctrl and another key while the trigger is held do not let go of what it holds") {
    Rig rig;
    rig.key(true);
    rig.picture();
    REQUIRE(rig.hand.is_held(0));
    ImGui::GetIO().KeyCtrl = true;
    rig.picture();
    CHECK(rig.hand.is_held(0));
    rig.key(false);
    rig.picture();
    CHECK_FALSE(rig.hand.is_held(0));
    rig.key(true);
    rig.picture();
    CHECK_FALSE(rig.hand.is_held(0));
}

TEST_CASE("a key for an open menu does not press the trigger") {
    Rig rig;
    rig.has_menu = true;
    rig.picture();
    rig.picture();
    rig.key(true);
    rig.picture();
    CHECK_FALSE(rig.hand.is_held(0));
}

TEST_CASE("a hand holds what it holds through a pause of any length and goes on from where it is") {
    Rig rig;
    rig.hand.hold(0, true);
    rig.picture();
    rig.hand.stand(true);
    rig.picture();
    rig.picture(3 * one_second_ns);
    CHECK(rig.hand.is_there());
    rig.hand.go_to({0.1, 0.0, 0.0});
    rig.picture(3 * one_second_ns);
    CHECK((rig.wanted().buttons & button_trigger) != 0);
    CHECK(steady_ns() - rig.wanted().at_ns < one_second_ns);
    CHECK(rig.wanted().pose.position == rig.felt.pose.position);
    // Without a pause it is gone.
    rig.hand.stand(false);
    rig.picture(3 * one_second_ns);
    CHECK_FALSE(rig.hand.is_there());
}

TEST_CASE("a drag of the hand begins with the press and ends with the release") {
    Rig rig;
    ImGuiIO& io = ImGui::GetIO();
    const auto look = [&](float x, float y, bool is_down) {
        io.MousePos = ImVec2(x, y);
        io.MouseDown[0] = is_down;
        rig.picture();
        return rig.wanted().pose.position;
    };
    ImGui::NewFrame();
    ImGui::Begin("scene");
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::End();
    ImGui::EndFrame();
    const float x = corner.x + 5.0f, y = corner.y + 25.0f;
    const Vec3 before = look(x - 300.0f, y, false);
    look(x, y, false);
    look(x - 300.0f, y, false);
    // Pictures are slow: the pointer comes and presses within one.
    CHECK(look(x, y, true) == before);
    const Vec3 dragged = look(x + 20.0f, y, true);
    CHECK(dragged.x > before.x);
    const Vec3 end = look(x + 40.0f, y, false);
    CHECK(end.x - dragged.x == Approx(dragged.x - before.x));
    CHECK(look(x, y, false) == end);
}
