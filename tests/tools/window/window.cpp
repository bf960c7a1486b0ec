// SPDX-License-Identifier: Apache-2.0
// The window as people use it, on a display without a screen: a script does what hands would.
#include "assets/file/whole_file.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/window/on_display.hpp"

namespace fs = std::filesystem;
using namespace tactus::test;
using nlohmann::json;

TEST_CASE("in the window a parameter is turned, a node added, wired, taken back and saved, while the patch runs",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("script", R"(until 0.2
scope tone.signal
scope tone.signal spectrum
select tone
set tone.frequency "220 Hz"
! set tone.frequency "3 kg"
! connect tone.signal loud.factor
add gain "48 kHz"
wire loud.out in
rename gain echo
add constant "60 Hz"
undo
frames 3
screenshot window.png
export 0 wave.csv
export 1 spectrum.png
pause
until paused
resume
size 900 700
frames 5
minimise
wait 0.2
restore
frames 3
save
stop
until over
close
)");
    const Outcome done =
        on(display, folder, "run voice.toml --view --view-script script --audio file --out out --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    const std::string saved = slurp(folder.path / "voice.toml");
    CHECK(saved.find("frequency = \"220 Hz\"   # a") != std::string::npos);
    CHECK(saved.find("# the way of the sound") != std::string::npos);
    CHECK(saved.find("\"loud.out    -> echo.in\"") != std::string::npos);
    CHECK(saved.find("[nodes.echo]\ntype = \"gain\"\nrate = \"48 kHz\"\n") != std::string::npos);
    CHECK(saved.find("[nodes.constant]") == std::string::npos);
    CHECK(on(display, folder, "check voice.toml").code == 0);
    const json summary = json::parse(done.out);
    CHECK(summary["seconds"].get<double>() > 0.2);
    check_picture(folder.path / "window.png", 1600, 1000);
    CHECK(read_picture(folder.path / "spectrum.png").width > 600);
    CHECK(slurp(folder.path / "wave.csv").starts_with("time s,"));
}

TEST_CASE("a run with a window on it is recorded, replays to the bit, and its take is looked at at any instant",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("record",
                 "until 0.4\nset hand_out.max_force \"8 N\"\npause\nuntil paused\nresume\nuntil 0.8\nstop\nuntil "
                 "over\nclose\n");
    const Outcome run =
        on(display, folder, "run touch-sphere --view --view-script record --audio file --out out --record take --json");
    INFO(run.err);
    REQUIRE(run.code == 0);
    const Outcome again = on(display, folder, "replay take --json");
    INFO(again.err);
    REQUIRE(again.code == 0);
    CHECK(json::parse(again.out)["identical"] == true);
    folder.write("scrub",
                 "scope hand.pose\ngoto 0.6\nscene\nframes 3\nscreenshot late.png\ngoto 0.05\nscene\nframes "
                 "3\nscreenshot early.png\nclose\n");
    const Outcome scrubbed = on(display, folder, "view take --view-script scrub");
    INFO(scrubbed.err);
    REQUIRE(scrubbed.code == 0);
    check_picture(folder.path / "late.png", 1600, 1000);
    CHECK(slurp(folder.path / "late.png") != slurp(folder.path / "early.png"));
    CHECK(slurp(folder.path / "take/patch-0.toml") ==
          tactus::file::read_whole_file(tactus::test::library_folder() / "patches/touch-sphere.toml"));
}

TEST_CASE("a window changes no bit of what a patch computes", "[display][live]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    const auto [seen, late] =
        hash_of(display, folder, "run voice.toml --view --seconds 1 --audio file --out out --json");
    const auto plain = hash_of(display, folder, "render voice.toml --seconds 1 --out plain --json").first;
    if (late > 0) tactus::test::skip("the machine was too busy for the live run to keep its schedule");
    else CHECK(seen == plain);
}

TEST_CASE("every patch of the library opens in the window", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    std::string script;
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(tactus::test::library_folder() / "patches"))
        if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    REQUIRE(names.size() >= 9);
    for (const std::string& name : names) script += fmt::format("open {0}\nframes 3\nscreenshot {0}.png\n", name);
    folder.write("script", script + "close\n");
    const Outcome done =
        on(display, folder, "run touch-sphere --view --view-script script --audio file --out out --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    for (const std::string& name : names) check_picture(folder.path / (name + ".png"), 1600, 1000);
}

TEST_CASE("a window that is closed can leave the run alive", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("script", "until 0.1\nclose\n");
    const Outcome done =
        on(display, folder,
           "run voice.toml --view --keep-running --view-script script --seconds 1.5 --audio file --out out --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(json::parse(done.out)["seconds"] == 1.5);
}

TEST_CASE("without a display, or without OpenGL, the command says so once and ends with code 2", "[display]") {
    const Folder folder;
    const std::string patch = folder.write("voice.toml", voice).string();
    const Outcome blind = folder.tactus("run " + patch + " --view --out " + (folder.path / "out").string());
    const char* display_name = std::getenv("DISPLAY");
    if (!display_name || !*display_name) {
        CHECK(blind.code == 2);
        CHECK(blind.err.find("no window can be opened") != std::string::npos);
        CHECK(std::count(blind.err.begin(), blind.err.end(), '\n') == 1);
    }
    NEEDS_DISPLAY(display)
    const std::string refused = "MESA_GL_VERSION_OVERRIDE=2.1 ";
    const std::string command = display.environment() + refused + tactus::test::command() + " run " + patch +
                                " --view --out " + (folder.path / "out").string() + " 2>" +
                                (folder.path / "err").string();
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 2);
    CHECK(slurp(folder.path / "err").find("OpenGL 3.3") != std::string::npos);
}

TEST_CASE("a script that asks for what is not there fails where it does", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("unknown", "frames 1\nscren shot\n");
    const Outcome unknown = on(display, folder, "run voice.toml --view --view-script unknown --audio file --out out");
    CHECK(unknown.code == 2);
    CHECK(unknown.err.find("unknown:2:1: no command 'scren'") != std::string::npos);
    folder.write("refused", "set tone.frequency \"3 kg\"\n");
    const Outcome refused = on(display, folder, "run voice.toml --view --view-script refused --audio file --out out");
    CHECK(refused.code == 2);
    CHECK(refused.err.find("refused:1:1") != std::string::npos);
}
