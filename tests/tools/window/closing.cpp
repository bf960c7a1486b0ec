// SPDX-License-Identifier: Apache-2.0
// A window that goes with edits that are not saved, on a display without a screen.
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/window/on_display.hpp"

#include <csignal>
#include <functional>

namespace fs = std::filesystem;
using namespace tactus;
using namespace tactus::test;

namespace {

constexpr const char* run_voice = "run voice.toml --view --audio file --overwrite --out out --view-script script";

/// What the window did with a script that edits the patch first.
Outcome edit_and(const VirtualDisplay& display, const Folder& folder, const std::string& script,
                 const std::string& options = {}) {
    folder.write("script", "set tone.frequency \"220 Hz\"\n" + script);
    Outcome done = on(display, folder, run_voice + (" " + options));
    INFO(done.err);
    REQUIRE(done.code == 0);
    return done;
}

/// Starts the window beside the test.
pid_t start(const VirtualDisplay& display, const Folder& folder) {
    const std::string line =
        fmt::format("cd {0} && {1} XDG_STATE_HOME={0}/state exec {2} {3} >out.txt 2>err.txt", folder.path.string(),
                    display.environment(), tactus::test::command(), run_voice);
    const pid_t process = ::fork();
    if (process == 0) {
        ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
        ::_exit(127);
    }
    return process;
}

bool is_edited(const fs::path& file) { return slurp(file).find("\"220 Hz\"") != std::string::npos; }

}  // namespace

TEST_CASE("a window closed by hand asks about edits that are not saved: save, do not save, or stay open", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice), kept = folder.path / "voice.unsaved.toml";
    edit_and(display, folder, "stop\nuntil over\nshut\nframes 3\npress \"drop edits\"\nwait 30\n");
    CHECK(slurp(patch) == voice);
    CHECK_FALSE(fs::exists(kept));

    edit_and(display, folder,
             "stop\nuntil over\nshut\nframes 3\npress \"cancel closing\"\nframes 3\nscreenshot open.png\nshut\nframes "
             "3\npress \"save edits\"\nwait 30\n");
    CHECK(fs::exists(folder.path / "open.png"));
    CHECK(is_edited(patch));
    CHECK_FALSE(fs::exists(kept));
}

TEST_CASE("a window that a script closes keeps the edits, and the next window restores or discards them", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice), kept = folder.path / "voice.unsaved.toml";
    const Outcome left = edit_and(display, folder, "close\n");
    CHECK(left.err.find("unsaved edits of voice.toml are kept in " + kept.string()) != std::string::npos);
    CHECK(is_edited(kept));
    CHECK(slurp(patch) == voice);

    folder.write("script", "frames 3\npress \"restore edits\"\nframes 3\nsave\nclose\n");
    CHECK(on(display, folder, run_voice).code == 0);
    CHECK(is_edited(patch));
    CHECK_FALSE(fs::exists(kept));

    folder.write("voice.toml", voice);
    edit_and(display, folder, "close\n");
    folder.write("script", "frames 3\npress \"discard edits\"\nframes 3\nclose\n");
    CHECK(on(display, folder, run_voice).code == 0);
    CHECK(slurp(patch) == voice);
    CHECK_FALSE(fs::exists(kept));
}

TEST_CASE("a window closed in a pause asks about the steps that wait, and saves them", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const fs::path bundled = library_folder() / "cases/mandible-twelve/case.plan.json", file = folder.path / "a.plan.json";
    plan::CasePlan plan = plan::load_case_plan(bundled);
    plan::make_files_absolute(plan, bundled.parent_path());
    plan::save_case_plan(plan, file);
    const auto is_locked = [&] { return plan::state_of(plan::load_case_plan(file)).arrangement.is_locked(2); };
    REQUIRE_FALSE(is_locked());
    // The part is chosen first: beside a run that begins, its bone may not be drawn yet. Bones appear as they are read.
    folder.write("script", "wait 4\nframes 3\npress \"part fragment_03\"\nframes 3\nrun\nuntil 0.3\npause\nuntil paused\n"
                           "press \"lock\"\nframes 3\nshut\nframes 400\npress \"save steps\"\nwait 30\n");
    const Outcome done = on(display, folder, "view a.plan.json --layout plan --view-script script");
    INFO(done.err);
    CHECK(done.code == 0);
    CHECK(is_locked());
}

TEST_CASE("a window that SIGTERM or the end of --seconds takes away keeps the edits", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    edit_and(display, folder, "", "--seconds 1");
    CHECK(is_edited(folder.path / "voice.unsaved.toml"));

    folder.write("script", "set tone.frequency \"330 Hz\"\nuntil 0.1\nscreenshot ready.png\n");
    const pid_t process = start(display, folder);
    CHECK(wait_for([&] { return fs::exists(folder.path / "ready.png"); }));
    ::kill(process, SIGTERM);
    int status = 0;
    ::waitpid(process, &status, 0);
    CHECK(WEXITSTATUS(status) == 0);
    CHECK(slurp(folder.path / "voice.unsaved-2.toml").find("\"330 Hz\"") != std::string::npos);
    CHECK(slurp(folder.path / "err.txt").find("are kept in") != std::string::npos);
}

TEST_CASE("a window that is killed has kept its edits and the next window restores them", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice), kept = folder.path / "voice.unsaved.toml";
    folder.write("script", "set tone.frequency \"220 Hz\"\nwait 60\n");
    const pid_t process = start(display, folder);
    CHECK(wait_for([&] { return fs::exists(kept) && is_edited(kept); }));
    ::kill(process, SIGKILL);
    int status = 0;
    ::waitpid(process, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK(slurp(patch) == voice);

    folder.write("script", "frames 3\npress \"restore edits\"\nframes 3\nsave\nclose\n");
    const Outcome next = on(display, folder, run_voice);
    INFO(next.err);
    CHECK(next.code == 0);
    CHECK(is_edited(patch));
    CHECK_FALSE(fs::exists(kept));
}

TEST_CASE("a patch of the library that is saved in the window gets a name, and the library stays as it is",
          "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const fs::path patches = library_folder() / "patches";
    const std::string before = slurp(patches / "touch-sphere.toml");
    folder.write("script",
                 "set hand_out.max_force \"8 N\"\n! save\nframes 3\nscreenshot name.png\npress \"accept file\"\nframes "
                 "3\nset hand_out.max_force \"7 N\"\nsave\ncheck\nclose\n");
    const Outcome done =
        on(display, folder, "run touch-sphere --view --audio file --overwrite --out out --view-script script");
    INFO(done.err);
    CHECK(done.code == 0);
    CHECK(slurp(folder.path / "touch-sphere.toml").find("\"7 N\"") != std::string::npos);
    CHECK(on(display, folder, "render ./touch-sphere.toml --seconds 0.1 --out rendered").code == 0);
    CHECK(slurp(patches / "touch-sphere.toml") == before);
    CHECK_FALSE(fs::exists(patches / "touch-sphere.unsaved.toml"));
}

TEST_CASE("what is being typed is in the file that is saved and is asked about when the window closes", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const std::string type_name = "stop\nuntil over\nframes 3\npress tone\npress name\nkey ctrl+a\ntype lead\n";
    const fs::path patch = folder.write("voice.toml", voice);

    // The field is never left.
    folder.write("script", type_name + "key ctrl+s\nframes 3\ntext seen.toml\nclose\n");
    Outcome done = on(display, folder, run_voice);
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(slurp(patch).find("[nodes.lead]") != std::string::npos);
    CHECK(slurp(patch) == slurp(folder.path / "seen.toml"));

    folder.write("voice.toml", voice);
    folder.write("script", type_name + "shut\nframes 3\npress \"save edits\"\nwait 30\n");
    done = on(display, folder, run_voice);
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(slurp(patch).find("[nodes.lead]") != std::string::npos);

    folder.write("voice.toml", voice);
    folder.write("script", type_name + "close\n");
    done = on(display, folder, run_voice);
    INFO(done.err);
    CHECK(done.code == 0);
    CHECK(slurp(folder.path / "voice.unsaved.toml").find("[nodes.lead]") != std::string::npos);
}

TEST_CASE("the words of a comment that is being written are kept when the window closes", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    folder.write("voice.toml", voice);
    folder.write("script",
                 "stop\nuntil over\nframes 3\nkey ctrl+p\ntype comment\nkey enter\nframes 3\nkey ctrl+a\n"
                 "type louder\nscreenshot writing.png\nclose\n");
    const Outcome done = on(display, folder, run_voice);
    INFO(done.err);
    CHECK(done.code == 0);
    CHECK(slurp(folder.path / "voice.unsaved.toml").find("louder") != std::string::npos);
}
