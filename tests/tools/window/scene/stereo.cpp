// SPDX-License-Identifier: Apache-2.0
// Stereo, heads and display files in the window, as people use them.
#include "tests/support/catch.hpp"
#include "tests/tools/window/on_display.hpp"

#include <string>

using namespace tactus::test;

namespace {

const char* const projectors = R"([[screens]]
name = "left projector"
low_left  = "-260 mm, 0 mm, -150 mm"
low_right = "260 mm, 0 mm, -150 mm"
high_left = "-260 mm, 0 mm, 150 mm"
eyes = "left"
window = [0, 0, 400, 300]
[[screens]]
name = "right projector"
low_left  = "-260 mm, 0 mm, -150 mm"
low_right = "260 mm, 0 mm, -150 mm"
high_left = "-260 mm, 0 mm, 150 mm"
eyes = "right"
window = [400, 0, 400, 300]
)";

/// A head that sways before a ball.
const char* const look_around = R"(title = "Look around"
wires = ["hand.pose -> ball.pose"]
[devices.still]
driver = "scripted"
targets = "0 s: 40 -25 15 mm"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "still"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
radius = "20 mm"
[nodes.head]
type = "simulated_head"
rate = "60 Hz"
frequency = "1 Hz"
)";

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("in the window the scene is seen in stereo, with a head, through a display and in separate windows",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("patch.toml", look_around);
    folder.write("display.toml", projectors);
    folder.write("script", R"(until 0.1
frames 3
screenshot mono.png
stereo side-by-side
frames 3
screenshot side.png
stereo anaglyph
frames 3
screenshot anaglyph.png
head head.pose
frames 4
screenshot head.png
stereo mono
display display.toml
frames 4
screenshot through.png
offset study
frames 4
screenshot offset.png
! set head.frequency "1 mm"
screens off
frames 2
rig                 # the word before: display
screens on
frames 4
screens off
frames 2
stop
until over
close
)");
    const Outcome done =
        on(display, folder, "run patch.toml --view --view-script script --audio file --out out --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    std::string before;
    for (const char* name : {"mono", "side", "anaglyph", "head", "through", "offset"}) {
        const std::string now = slurp(folder.path / (std::string(name) + ".png"));
        CHECK(now.size() > 10000);
        CHECK(now != before);
        before = now;
    }
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("the command line opens the windows of a display, and a driver without two buffers is told from one with",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("patch.toml", look_around);
    folder.write("display.toml", projectors);
    folder.write("script", "until 0.3\nframes 5\nscreenshot through.png\nstop\nuntil over\nclose\n");
    const std::string run = "run patch.toml --view --view-script script --audio file --overwrite --out out --json ";
    const Outcome through = on(display, folder, run + "--display display.toml --head head.pose --offset study");
    INFO(through.err);
    CHECK(through.code == 0);
    // Without buffers for two eyes it says so in the window and shows them side by side.
    CHECK(on(display, folder, run + "--stereo quad-buffer").code == 0);
    CHECK(on(display, folder, run + "--display nowhere.toml").code == 2);
    CHECK(on(display, folder, run + "--stereo cross-eyed").err.find("side-by-side") != std::string::npos);
    // A monitor that is not there is told, and the run goes on.
    folder.write("far.toml", std::string(projectors) + "monitor = 9\n");
    CHECK(on(display, folder, run + "--display far.toml").code == 0);
}

TEST_CASE("an edit that leaves nothing in space closes the scene, and one that undoes it shows it again", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("patch.toml", std::string(look_around) + "[nodes.tone]\ntype = \"sine\"\nrate = \"48 kHz\"\n");
    folder.write("display.toml", projectors);
    folder.write("script", R"(until 0.1
display display.toml
screens on
frames 4
screenshot before.png
remove ball
remove head
remove hand
frames 4
screenshot empty.png
undo
undo
undo
frames 6
screenshot again.png
stop
until over
close
)");
    const Outcome done =
        on(display, folder, "run patch.toml --view --view-script script --audio file --out out --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(beside_screen(folder.path / "before.png") > 1000);
    CHECK(beside_screen(folder.path / "empty.png") == 0);
    CHECK(beside_screen(folder.path / "again.png") > 1000);
}

TEST_CASE("a window that draws a display changes no bit of what a patch computes", "[display][live]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("patch.toml", look_around);
    folder.write("display.toml", projectors);
    const auto [seen, late] = hash_of(
        display, folder,
        "run patch.toml --view --display display.toml --head head.pose --seconds 1 --audio file --out out --json");
    const auto plain = hash_of(display, folder, "render patch.toml --seconds 1 --out plain --json").first;
    if (late > 0) tactus::test::skip("the machine was too busy for the live run to keep its schedule");
    else CHECK(seen == plain);
}
