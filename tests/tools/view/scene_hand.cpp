// SPDX-License-Identifier: Apache-2.0
// When the window begins to move the hand of a run.
#include "tools/view/scene/scene_hand.hpp"

#include "devices/haptic/window_hand.hpp"
#include "devices/hosted/clocks.hpp"
#include "tests/support/catch.hpp"

#include <chrono>
#include <thread>

using namespace tactus;

namespace {

constexpr std::int64_t run = 4711;

/// A device that ticks, or only waits, for as long as a picture takes.
void draw(view::SceneHand& hand, std::int64_t ticked_ns, std::chrono::milliseconds takes) {
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
    view::SceneHand hand;
    // Read anew in each picture, but without ticks.
    const std::int64_t opened = hosted::steady_ns();
    for (int n = 0; n < 8; ++n) draw(hand, opened, std::chrono::milliseconds(20));
    CHECK_FALSE(has_spoken());
    for (int n = 0; n < 5; ++n) draw(hand, hosted::steady_ns(), std::chrono::milliseconds(800));
    CHECK(has_spoken());
    haptic::window_hand().felt.write({});
}
