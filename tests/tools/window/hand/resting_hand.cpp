// SPDX-License-Identifier: Apache-2.0
// The hand of the window while no picture is shown.
#include "devices/haptic/window_hand.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/on_display.hpp"
#include "tools/window/desk/desk.hpp"

#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

TEST_CASE("a pause that begins while the window is minimised leaves the hand where it is", "[display][slow]") {
    const tactus::test::VirtualDisplay display;
    if (!display.is_there()) {
        tactus::test::skip("Xvfb is not installed (apt install xvfb)");
        return;
    }
    const Folder folder;
    ::setenv("DISPLAY", (":" + display.number()).c_str(), 1);
    Window window("Tactus", 600, 400, 1.0);
    RunChoice choice;
    choice.patch = (library_folder() / "patches/touch-sphere.toml").string();
    choice.out = folder.path / "out";
    choice.audio = "none";
    choice.json = true;
    choice.overrides.settings = {"hand.device=mouse"};
    Workbench bench(choice);
    WindowMemory memory(folder.path / "window.json");
    Desk desk(window, bench, nullptr, memory);
    SceneHand& hand = desk.scene().hand();
    // What the window does instead of a picture.
    const auto rest = [&] {
        desk.rest();
        hand.begin_picture();
        hand.end_picture();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    };
    const auto comes = [&](const std::function<bool()>& what) {
        for (int n = 0; n < 1500; ++n) {
            rest();
            if (what()) return true;
        }
        return false;
    };
    ++haptic::window_hand().windows;
    bench.run();
    REQUIRE(comes([&] { return hand.is_there(); }));
    bench.pause(true);
    REQUIRE(comes([&] { return bench.status()->state == RunStatus::State::stands; }));
    REQUIRE(hand.is_there());
    // A device that is not read for 2 s is forgotten, unless the run stands still.
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < std::chrono::seconds(3)) rest();
    CHECK(hand.is_there());
    bench.pause(false);
    REQUIRE(comes([&] { return bench.status()->state == RunStatus::State::runs; }));
    CHECK(hand.is_there());
    bench.stop();
    CHECK(comes([&] { return bench.running()->is_over(); }));
    --haptic::window_hand().windows;
}
