// SPDX-License-Identifier: Apache-2.0
// Edits that are not saved when their window goes, without a window.
#include "tools/window/document/unsaved.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/document/workbench.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

using namespace tactus;
using namespace tactus::window;
namespace fs = std::filesystem;
using tactus::test::Folder;
using tactus::test::slurp;
using tactus::test::voice;

namespace {

/// A variable of the environment while a test runs.
class Variable {
public:
    Variable(const char* name, const std::string& value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

RunChoice choice_of(const fs::path& patch) {
    RunChoice choice;
    choice.patch = patch.string();
    choice.out = patch.parent_path() / "out";
    return choice;
}

/// A window that goes with an edit that was not saved, and its text.
std::string leave_edit(const RunChoice& choice, const std::string& frequency) {
    Workbench bench(choice);
    REQUIRE(bench.set("tone", "frequency", frequency));
    CHECK(bench.has_unsaved_edits());
    bench.keep_edits();
    return bench.editor().text();
}

/// What a window does between pictures, until something holds or it takes too long.
template <class Holds>
bool tended_until(Workbench& bench, Holds holds) {
    for (int i = 0; i < 1000 && !holds(); ++i) {
        bench.tend();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return holds();
}

}  // namespace

TEST_CASE("a window that is killed has kept its edits shortly before") {
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice), kept = folder.path / "voice.unsaved.toml";
    const pid_t process = ::fork();
    REQUIRE(process >= 0);
    if (process == 0) {
        Workbench bench(choice_of(patch));
        bench.set("tone", "frequency", "220 Hz");
        tended_until(bench, [&] { return fs::exists(kept) && fs::file_size(kept) > 0; });
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ::waitpid(process, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK(slurp(kept).find("220 Hz") != std::string::npos);
    Workbench next(choice_of(patch));
    next.find_kept_edits();
    CHECK(next.offer() == kept);
}

TEST_CASE("edits kept while a window works go when they are saved or undone and are no offer to a second window") {
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice), kept = folder.path / "voice.unsaved.toml";
    Workbench bench(choice_of(patch));
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    bench.tend();
    CHECK_FALSE(fs::exists(kept));
    const auto is_kept = [&] { return fs::exists(kept) && slurp(kept) == bench.editor().text(); };
    REQUIRE(tended_until(bench, is_kept));
    REQUIRE(bench.set("tone", "frequency", "330 Hz"));
    REQUIRE(tended_until(bench, is_kept));
    bench.tend();
    CHECK(find_unsaved(patch).size() == 1);
    Workbench second(choice_of(patch));
    second.find_kept_edits();
    CHECK_FALSE(second.offer());
    while (bench.undo()) {
    }
    CHECK(tended_until(bench, [&] { return !fs::exists(kept); }));
    REQUIRE(bench.redo());
    REQUIRE(tended_until(bench, is_kept));
    REQUIRE(bench.save());
    CHECK_FALSE(fs::exists(kept));
    bench.tend();
    CHECK(find_unsaved(patch).empty());
}

TEST_CASE("edits of a patch that never was saved are offered to the next new patch") {
    const Folder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path);
    {
        folder.write("untitled.toml", voice);
        const auto bench = Workbench::untitled({});
        CHECK(bench->editor().file().filename() == "untitled-2.toml");
        REQUIRE_FALSE(bench->add_node("sine", "48 kHz").empty());
        bench->keep_edits();
    }
    fs::remove("untitled.toml");
    const auto bench = Workbench::untitled({});
    CHECK(bench->editor().file().filename() == "untitled.toml");
    bench->find_kept_edits();
    CHECK(bench->offer() == folder.path / "untitled-2.unsaved.toml");
    // Later is not never.
    bench->postpone_offer();
    CHECK_FALSE(bench->offer());
    bench->find_kept_edits();
    REQUIRE(bench->restore_edits());
    CHECK(bench->editor().text().find("sine") != std::string::npos);
    REQUIRE(bench->save_as("mine"));
    CHECK_FALSE(fs::exists("untitled-2.unsaved.toml"));
    fs::current_path(before);
}

TEST_CASE("two windows with new patches in one folder do not take over each other's file") {
    const Folder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path);
    const auto first = Workbench::untitled({}), second = Workbench::untitled({});
    fs::current_path(before);
    REQUIRE_FALSE(first->add_node("sine", "48 kHz").empty());
    REQUIRE_FALSE(second->add_node("constant", "60 Hz").empty());
    second->tend();
    const std::string theirs = first->editor().text(), mine = second->editor().text();
    REQUIRE(first->save_as((folder.path / "untitled").string()));
    std::this_thread::sleep_for(std::chrono::milliseconds(600));  // a file is looked at twice a second
    second->tend();
    CHECK(second->editor().text() == mine);
    CHECK(second->is_untitled());
    CHECK_FALSE(second->save());
    CHECK(second->wants_name);
    CHECK(slurp(folder.path / "untitled.toml") == theirs);
    CHECK_FALSE(second->save_as((folder.path / "untitled").string()));
    REQUIRE(second->save_as((folder.path / "mine").string()));
    CHECK(slurp(folder.path / "mine.toml") == mine);
}

TEST_CASE("edits that are not saved are kept beside the patch, offered to the next window, and restored as an edit") {
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice), kept = folder.path / "voice.unsaved.toml";
    const std::string text = leave_edit(choice_of(patch), "220 Hz");
    CHECK(slurp(kept) == text);
    CHECK(slurp(patch) == voice);

    auto bench = std::make_unique<Workbench>(choice_of(patch));
    bench->find_kept_edits();
    REQUIRE(bench->offer() == kept);
    CHECK(bench->editor().text() == voice);
    REQUIRE(bench->restore_edits());
    CHECK_FALSE(bench->offer());
    CHECK(bench->editor().text() == text);
    // A window that dies now has lost nothing.
    CHECK(fs::exists(kept));
    CHECK(bench->undo());
    CHECK(bench->editor().text() == voice);
    CHECK(bench->redo());
    REQUIRE(bench->set("level", "number", "0.25"));
    bench->keep_edits();
    CHECK(slurp(kept) == bench->editor().text());
    CHECK(find_unsaved(patch).size() == 1);

    bench = std::make_unique<Workbench>(choice_of(patch));
    bench->find_kept_edits();
    REQUIRE(bench->restore_edits());
    REQUIRE(bench->save());
    CHECK(slurp(patch) == bench->editor().text());
    CHECK_FALSE(fs::exists(kept));
    bench->keep_edits();
    CHECK(find_unsaved(patch).empty());
}

TEST_CASE("kept edits are never overwritten: what was not answered is offered again, the newest first") {
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice);
    const std::string first = leave_edit(choice_of(patch), "220 Hz"), second = leave_edit(choice_of(patch), "330 Hz");
    CHECK(slurp(folder.path / "voice.unsaved.toml") == first);
    CHECK(slurp(folder.path / "voice.unsaved-2.toml") == second);
    Workbench bench(choice_of(patch));
    bench.find_kept_edits();
    REQUIRE(bench.offer() == folder.path / "voice.unsaved-2.toml");
    bench.discard_offer();
    CHECK_FALSE(fs::exists(folder.path / "voice.unsaved-2.toml"));
    REQUIRE(bench.offer() == folder.path / "voice.unsaved.toml");
    // Saved by another program meanwhile: nothing is left to restore.
    folder.write("voice.toml", first);
    Workbench other(choice_of(patch));
    other.find_kept_edits();
    CHECK_FALSE(other.offer());
    CHECK(find_unsaved(patch).empty());
}

TEST_CASE("edits that are dropped are not kept, unless they are wanted after all") {
    const Folder folder;
    const fs::path patch = folder.write("voice.toml", voice);
    Workbench bench(choice_of(patch));
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    bench.drop_edits();
    CHECK_FALSE(bench.has_unsaved_edits());
    bench.keep_edits();
    CHECK(find_unsaved(patch).empty());
    REQUIRE(bench.set("tone", "frequency", "330 Hz"));
    CHECK(bench.has_unsaved_edits());
    bench.drop_edits();
    bench.want_edits();
    bench.keep_edits();
    CHECK(find_unsaved(patch).size() == 1);
}

TEST_CASE("where a patch's folder takes no file its edits are kept in the state folder, by its whole path") {
    const Folder folder;
    const Variable state("XDG_STATE_HOME", (folder.path / "state").string());
    // A folder in the way of each name: also for who may write everywhere.
    const fs::path patch = folder.write("voice.toml", voice);
    for (int i = 1; i < 100; ++i)
        fs::create_directory(folder.path /
                             (i == 1 ? "voice.unsaved.toml" : "voice.unsaved-" + std::to_string(i) + ".toml"));
    const std::string text = leave_edit(choice_of(patch), "220 Hz");
    const std::vector<fs::path> kept = find_unsaved(patch);
    REQUIRE(kept.size() == 1);
    CHECK(kept.front().parent_path() == folder.path / "state/tactus/unsaved");
    CHECK(slurp(kept.front()) == text);
    CHECK(find_unsaved(folder.write("other.toml", voice)).empty());
}

TEST_CASE("a patch of the library is never written: it is saved under another name, from where it finds its files") {
    const Folder folder;
    const fs::path library = folder.path / "library";
    fs::create_directories(library / "patches");
    folder.write("library/patches/voice.toml", voice + "[assets]\nhand = \"../hand.csv\"\n");
    folder.write("library/hand.csv", "t\n");
    const Variable given("TACTUS_LIBRARY", library.string());
    const Variable state("XDG_STATE_HOME", (folder.path / "state").string());
    const std::string before = slurp(library / "patches/voice.toml");
    RunChoice choice = choice_of(library / "patches/voice.toml");
    CHECK(run::is_of_library(library / "patches/new.toml"));
    CHECK_FALSE(run::is_of_library(folder.path / "library-2/voice.toml"));

    leave_edit(choice, "330 Hz");
    REQUIRE(find_unsaved(choice.patch).size() == 1);
    CHECK(find_unsaved(choice.patch).front().string().starts_with((folder.path / "state").string()));

    Workbench bench(choice);
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    CHECK_FALSE(bench.save());
    CHECK(bench.wants_name);
    CHECK_FALSE(bench.save_as((library / "patches/new.toml").string()));
    CHECK_FALSE(bench.save_as(""));
    folder.write("taken.toml", "mine");
    CHECK_FALSE(bench.save_as((folder.path / "taken.toml").string()));
    CHECK(slurp(folder.path / "taken.toml") == "mine");
    CHECK(bench.free_file().parent_path() == fs::current_path());
    REQUIRE(bench.save_as((folder.path / "mine").string()));
    CHECK_FALSE(bench.wants_name);
    CHECK_FALSE(bench.has_unsaved_edits());
    const fs::path mine = folder.path / "mine.toml";
    CHECK(bench.editor().file() == mine);
    CHECK(slurp(mine).find("\"" + (library / "hand.csv").string() + "\"") != std::string::npos);
    CHECK(slurp(mine).find("220 Hz") != std::string::npos);
    // From now on it is saved there.
    REQUIRE(bench.set("tone", "frequency", "110 Hz"));
    REQUIRE(bench.save());
    CHECK(slurp(mine).find("110 Hz") != std::string::npos);
    CHECK(slurp(library / "patches/voice.toml") == before);
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(library / "patches")) names.push_back(entry.path().filename());
    CHECK(names == std::vector<std::string>{"voice.toml"});
}
