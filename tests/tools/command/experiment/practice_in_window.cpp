// SPDX-License-Identifier: Apache-2.0
// The tasks of the co-location study, practised with the mouse in a window.
#include "tests/support/catch.hpp"
#include "tests/tools/window/on_display.hpp"

#include <fmt/format.h>

#include <string>

using namespace tactus::test;

namespace {

/// Runs one task of the study as practice and trial, by a script of the window; returns the records of both.
std::string practised(const VirtualDisplay& display, const Folder& folder, const std::string& task,
                      const std::string& more, const std::string& script) {
    const std::string patches = (library_folder() / "experiments/patches").string();
    folder.write("task.toml", fmt::format(R"(format = 1
title = "Practice"
name = "practice"
consent = false
[practice]
needed = 1
[[task]]
name = "{0}"
patch = "{1}/{0}.toml"
{2}
[[task.measure]]
name = "moved"
kind = "rms"
port = "place.pose.px"
)",
                                          task, patches, more));
    folder.write("script", "size 1000 800\nfrom top\nuntil 0.5\nframes 3\n" + script);
    // A key for the instruction; a second one would begin another block.
    folder.write("keys", "g");
    const Outcome o = on(display, folder,
                         "experiment run task.toml --subject P01 --set hand.device=mouse --view --view-script script "
                         "--out data < keys",
                         280);
    INFO(o.out << o.err);
    REQUIRE(o.code == 0);
    return slurp(folder.path / "data/sub-P01/trials.jsonl");
}

int finished_in(const std::string& trials) {
    int count = 0;
    for (std::size_t at = 0; (at = trials.find("\"finished\":true", at)) != std::string::npos; ++at) ++count;
    return count;
}

}  // namespace

TEST_CASE("the practice of the cube and of the spiral is completed with mouse and keyboard", "[display][long]") {
    NEEDS_DISPLAY(display) {
        const Folder folder;
        std::string script;
        // Eight corners: the button of the hand, down and up.
        for (int corner = 0; corner < 8; ++corner)
            for (int turn = 0; turn < 2; ++turn) script += "press \"trigger (T)\"\nframes 3\n";
        const std::string trials =
            practised(display, folder, "cube", "length = \"120 s\"\ndone = \"done.out\"", script + "until over\n");
        CAPTURE(trials);
        CHECK(finished_in(trials) == 2);
        CHECK(trials.find("\"phase\":\"practice\"") != std::string::npos);
        CHECK(trials.find("\"rehearsal\":true") != std::string::npos);
    }
    const Folder folder;
    const std::string trials = practised(display, folder, "spiral", "length = \"4 s\"",
                                         "drag 820 290 880 290\nframes 3\ndrag 880 290 820 340\nuntil over\n");
    CAPTURE(trials);
    CHECK(finished_in(trials) == 2);
}

TEST_CASE("the cube is pushed through the labyrinth and back five times with the mouse", "[display][long]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    // The corners of the corridor in the picture from the top, a little beyond its ends.
    constexpr int corners[][2]{{667, 198}, {667, 376}, {768, 376}, {768, 208},
                               {868, 208}, {868, 376}, {969, 376}, {969, 198}};
    std::string script;
    int x = 824, y = 292;
    const auto drag_to = [&](const int(&corner)[2]) {
        script += fmt::format("drag {} {} {} {}\nframes 2\n", x, y, corner[0], corner[1]);
        x = corner[0];
        y = corner[1];
    };
    for (int round = 0; round < 5; ++round) {
        for (int corner = 0; corner < 8; ++corner) drag_to(corners[corner]);
        script += "frames 4\n";
        for (int corner = 7; corner >= 0; --corner) drag_to(corners[corner]);
        script += "frames 4\n";
    }
    const std::string trials =
        practised(display, folder, "labyrinth", "length = \"180 s\"\ndone = \"done.out\"", script + "until over\n");
    CAPTURE(trials);
    CHECK(finished_in(trials) == 2);
}
