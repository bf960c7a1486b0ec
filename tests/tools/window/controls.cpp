// SPDX-License-Identifier: Apache-2.0
// The window by its own controls: buttons, sliders and wires under the mouse, and keys.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/window/on_display.hpp"

namespace fs = std::filesystem;
using namespace tactus::test;
using nlohmann::json;

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("every control of the window does what it says when it is pressed", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("script", R"(until 0.2
press tone
slide frequency 0.8
frames 3
screenshot turned.png
press "reset frequency"
press Undo
press "Add a node"
press "type constant"
key ctrl+z
press "type constant"
pull constant.value loud.factor
! connect tone.signal loud.factor
pull tone.signal loud.factor
double loud.out
frames 30
press "scope 0 plot"
press "scope 0 CSV"
press "scope 0 kind"
frames 20
press "scope 0 PNG"
press "scope 0 freeze"
press record
until recording
wait 0.4
press record
wait 0.2
press pause
until paused
press pause
wait 0.2
press Save
check
frames 3
screenshot driven.png
press stop
until over
frames 3
press "Look at the take"
frames 5
scene
slide time 0.5
frames 5
screenshot take.png
press play
frames 5
press "Back to the patch"
frames 5
close
)");
    const Outcome done =
        on(display, folder, "run voice.toml --view --view-script script --audio file --out out --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    const std::string saved = slurp(folder.path / "voice.toml");
    INFO(saved);
    // The slider's value came back with undo; the file says what the window showed.
    CHECK(saved.find("frequency = \"440 Hz\"   # a") == std::string::npos);
    CHECK(saved.find("# the way of the sound") != std::string::npos);
    CHECK(saved.find("\"constant.value -> loud.factor\"") != std::string::npos);
    CHECK(saved.find("level.value") == std::string::npos);
    CHECK(on(display, folder, "check voice.toml").code == 0);
    CHECK(slurp(folder.path / "out" / "loud.out-1.csv").starts_with("time s,"));
    CHECK(read_picture(folder.path / "out" / "loud.out-1.png").width > 600);
    const Outcome again = on(display, folder, "replay voice-take-1 --json");
    INFO(again.out << again.err);
    CHECK(again.code == 0);
    for (const char* picture : {"turned.png", "driven.png", "take.png"})
        check_picture(folder.path / picture, 1600, 1000);
}

TEST_CASE(
    "every patch of the library is edited, saved, recorded and scrubbed in the window, and compiles as it was shown",
    "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(tactus::test::library_folder() / "patches"))
        if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    REQUIRE(names.size() >= 9);
    // Copies beside the library's: assets are named from where the patch is.
    const fs::path library = tactus::test::library_folder();
    fs::create_directories(folder.path / "library/patches");
    for (const auto& entry : fs::directory_iterator(library)) {
        if (entry.path().filename() == "patches") continue;
        fs::create_symlink(fs::absolute(entry.path()), folder.path / "library" / entry.path().filename());
    }
    for (const auto& entry : fs::directory_iterator(library / "patches")) {
        if (entry.path().extension() == ".toml")
            fs::copy_file(entry.path(), folder.path / "library/patches" / entry.path().filename());
        else fs::create_symlink(fs::absolute(entry.path()), folder.path / "library/patches" / entry.path().filename());
    }
    std::string script;
    for (const std::string& name : names) {
        const Outcome listed = on(display, folder, "check library/patches/" + name + ".toml --json");
        INFO(listed.err);
        REQUIRE(listed.code == 0);
        const json groups = json::parse(listed.out)["groups"];
        script += fmt::format(R"(open library/patches/{0}.toml
frames 3
add constant "{1}"
select constant
frames 2
set constant.number 0.25
add range "{1}"
wire constant.value in
set range.out_high 2
reset range.out_high
run
until 0.05
record
until recording
wait 0.1
record off
undo
redo
save
check
frames 2
screenshot {0}.png
stop
until over
open {0}-take-1
frames 2
goto 0.1
frames 2
screenshot {0}-take.png
)",
                              name, groups.back()["name"].get<std::string>());
    }
    folder.write("script", script + "close\n");
    const Outcome done =
        on(display, folder,
           "run library/patches/touch-sphere.toml --view --view-script script --audio file --out out --json", 400);
    INFO(done.err);
    REQUIRE(done.code == 0);
    for (const std::string& name : names) {
        check_picture(folder.path / (name + ".png"), 1600, 1000);
        check_picture(folder.path / (name + "-take.png"), 1600, 1000);
        const std::string after = slurp(folder.path / "library/patches" / (name + ".toml"));
        CHECK(after.find("[nodes.range]") != std::string::npos);
        CHECK(after.find("number = 0.25") != std::string::npos);
        CHECK(on(display, folder, "check library/patches/" + name + ".toml").code == 0);
    }
}

TEST_CASE("a name that is typed belongs to its node when another one is pressed before Enter", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("p.toml", tactus::test::voice);
    folder.write("script",
                 "size 1280 800\nlayout patch\nframes 10\npress tone\nframes 5\npress name\ntype \"x\"\nframes 5\n"
                 "press loud\nframes 5\ntext after.toml\nundo all\ntext before.toml\nclose\n");
    const Outcome seen = on(display, folder, "view p.toml --view-scale 1 --view-script script");
    INFO(seen.err);
    REQUIRE(seen.code == 0);
    const std::string after = slurp(folder.path / "after.toml");
    INFO(after);
    CHECK(after.find("[nodes.tone]") == std::string::npos);
    CHECK(after.find("[nodes.loud]") != std::string::npos);
    CHECK(slurp(folder.path / "before.toml") == tactus::test::voice);
}

TEST_CASE("keys of the patch change it only where it is seen", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("script", R"(frames 3
select tone
frames 3
layout train
frames 3
key delete
key ctrl+a
key delete
key ctrl+v
key tab
text train.toml
layout patch
frames 3
text patch.toml
key ctrl+a
key delete
text empty.toml
close
)");
    const Outcome done = on(display, folder, "view voice.toml --view-script script");
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(slurp(folder.path / "train.toml") == voice);
    CHECK(slurp(folder.path / "patch.toml") == voice);
    CHECK(slurp(folder.path / "empty.toml").find("[nodes") == std::string::npos);
}
