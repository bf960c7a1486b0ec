// SPDX-License-Identifier: Apache-2.0
// A gamepad beside a window: its events come through a pipe.
#include "assets/file/whole_file.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/on_display.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <map>
#include <sstream>

using namespace tactus::test;

TEST_CASE("the scene shows where the sticks of a gamepad want the tool, the spring and the force", "[display][slow]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const std::string pad = (folder.path / "pad").string();
    REQUIRE(::mkfifo(pad.c_str(), 0600) == 0);
    const int end = ::open(pad.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(end >= 0);
    // Down into the ball: the right trigger is away, the left stick pulled is down.
    input_event events[2]{};
    events[0].type = EV_ABS;
    events[0].code = ABS_Y;
    events[0].value = 12000;
    events[1].type = EV_SYN;
    REQUIRE(::write(end, events, sizeof events) == sizeof events);
    folder.write("ball.toml", tactus::file::read_whole_file(library_folder() / "patches/touch-sphere.toml") +
                                  "\n[devices.pad]\ndriver = \"gamepad\"\nspeed = \"20 mm/s\"\nfile = \"" + pad +
                                  "\"\n");
    folder.write("script",
                 "size 800 600\nuntil 3\nframes 12\nspots spots.txt\nscreenshot pad.png\nstop\nuntil over\nclose\n");
    const Outcome outcome = on(display, folder,
                               "run ball.toml --view --view-script script --set hand.device=pad --audio none --out out "
                               "--seconds 60 --json");
    ::close(end);
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.code == 0);
    check_picture(folder.path / "pad.png", 800, 600);
    const std::string spots = tactus::file::read_whole_file(folder.path / "spots.txt");
    INFO(spots);
    CHECK(spots.find("hand cursor") != std::string::npos);
    CHECK(spots.find("force bar") != std::string::npos);
}
