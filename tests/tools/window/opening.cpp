// SPDX-License-Identifier: Apache-2.0
// A window in which one thing is left and another opened, on a display without a screen.
#include "tests/tools/patches.hpp"
#include "tests/tools/window/on_display.hpp"

namespace fs = std::filesystem;
using namespace tactus::test;

namespace {

const std::string other_voice = std::string(voice) + "# other\n";

/// Opens a file by the dialog, as a person does.
std::string open_file(const std::string& name) {
    return "key ctrl+o\nframes 4\ntype \"" + name + "\"\nframes 2\npress \"accept file\"\nframes 6\n";
}

Outcome window(const VirtualDisplay& display, const Folder& folder, const std::string& arguments,
               const std::string& script) {
    folder.write("script", script);
    Outcome done = on(display, folder, arguments + " --view-script script");
    INFO(done.err);
    CHECK(done.code == 0);
    return done;
}

bool holds_other(const fs::path& text) { return slurp(text).find("# other") != std::string::npos; }

}  // namespace

TEST_CASE("who opens another file and saves a patch of the library first gets a name for it and then the other file",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("other.toml", other_voice);
    window(display, folder, "view touch-sphere",
           "frames 5\nset hand_out.max_force \"8 N\"\n" + open_file("other.toml") +
               "press \"save edits\"\nframes 6\npress \"accept file\"\nframes 8\ntext after.toml\nclose\n");
    CHECK(slurp(folder.path / "touch-sphere.toml").find("\"8 N\"") != std::string::npos);
    CHECK(holds_other(folder.path / "after.toml"));
}

TEST_CASE("a new patch that is saved while another is asked for opens the other and who cancels the name stays",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("other.toml", other_voice);
    const std::string leave = "frames 5\nkey ctrl+n\nframes 6\nadd sine \"48 kHz\"\n" + open_file("other.toml") +
                              "press \"save edits\"\nframes 6\n";
    window(display, folder, "view other.toml",
           leave + "press \"cancel file\"\nframes 6\ntext stays.toml\n" + open_file("other.toml") +
               "press \"save edits\"\nframes 6\ntype mine\nframes 2\npress \"accept file\"\nframes 8\n"
               "text after.toml\nclose\n");
    CHECK(slurp(folder.path / "stays.toml").find("sine") != std::string::npos);
    CHECK(slurp(folder.path / "mine.toml").find("sine") != std::string::npos);
    CHECK(holds_other(folder.path / "after.toml"));
}

TEST_CASE("a file that cannot be opened leaves the patch with its run and its undo and the start page says why",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    fs::create_directories(folder.path / "damaged");
    folder.write("damaged/take.json", "{");
    window(display, folder, "view voice.toml",
           "frames 5\nset tone.frequency \"220 Hz\"\nsave\n" + open_file("damaged") + "undo\ntext after.toml\nclose\n");
    CHECK(slurp(folder.path / "after.toml") == voice);
    window(display, folder, "view", "frames 5\n" + open_file("damaged") + "frames 3\nspots start.txt\nclose\n");
    CHECK(slurp(folder.path / "start.txt").find("problem") != std::string::npos);
}

TEST_CASE("a run that would end is asked about before another patch opens", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("other.toml", other_voice);
    const std::string run = "run voice.toml --view --audio file --overwrite --out out";
    window(display, folder, run,
           "until 0.1\n" + open_file("other.toml") +
               "key escape\nframes 4\ntext stays.toml\nuntil 0.2\nstop\nuntil over\n" + open_file("other.toml") +
               "text after.toml\nclose\n");
    CHECK(slurp(folder.path / "stays.toml") == voice);
    CHECK(holds_other(folder.path / "after.toml"));
}

TEST_CASE("a take leads back to the patch that was recorded under the name that it has by then", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    window(display, folder, "run voice.toml --view --audio file --overwrite --out out --record monday",
           "until 0.3\nstop\nuntil over\nsave renamed.toml\nframes 3\npress \"Look at the take\"\nframes 10\n"
           "press \"Back to the patch\"\nframes 10\nset tone.frequency \"220 Hz\"\nsave\nrun\nuntil 0.1\n"
           "stop\nuntil over\nclose\n");
    CHECK(slurp(folder.path / "renamed.toml").find("220 Hz") != std::string::npos);
    CHECK(slurp(folder.path / "voice.toml") == voice);
}

TEST_CASE("a plan that was opened is remembered as itself and the start page leaves what it lies over", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    window(display, folder, "view voice.toml",
           "frames 5\nset tone.frequency \"220 Hz\"\npress File\nframes 4\npress \"menu Start page\"\nframes 6\n"
           "spots page.txt\nkey escape\nframes 4\nundo\ntext after.toml\nclose\n");
    CHECK(slurp(folder.path / "page.txt").find("New patch") != std::string::npos);
    CHECK(slurp(folder.path / "after.toml") == voice);
    const fs::path file = library_folder() / "cases/mandible-twelve/case.plan.json";
    folder.write("script", "frames 3\nclose\n");
    CHECK(on(display, folder, "view " + file.string() + " --view-script script").code == 0);
    const std::string memory = slurp(folder.path / "state/tactus/window.json");
    INFO(memory);
    CHECK(memory.find(".plan.json") != std::string::npos);
    CHECK(memory.find("planning-trauma.toml") == std::string::npos);
}
