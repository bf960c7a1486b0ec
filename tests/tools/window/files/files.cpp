// SPDX-License-Identifier: Apache-2.0
// Files to choose from, what the start page lists, and what the window remembers.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/start_list.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/files/file_chooser.hpp"
#include "tools/window/files/window_memory.hpp"

#include <algorithm>
#include <chrono>

using namespace tactus;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::slurp;

namespace {

std::vector<std::string> names(const std::vector<FileChooser::Entry>& entries) {
    std::vector<std::string> all;
    for (const auto& entry : entries) all.push_back(entry.name);
    return all;
}

}  // namespace

TEST_CASE("a folder is listed with its own folders first, and only files that suit") {
    const Folder folder;
    namespace fs = std::filesystem;
    fs::create_directories(folder.path / "b/inner");
    fs::create_directories(folder.path / "Take");
    folder.write("Take/take.json", "{}");
    for (const char* file : {"zeta.toml", "Alpha.TOML", ".hidden.toml", "sound.wav"}) folder.write(file, "x");
    FileChooser open(FileChooser::For::open, folder.path, {".toml"});
    CHECK(names(open.entries()) == std::vector<std::string>{"b", "Take", "Alpha.TOML", "zeta.toml"});
    CHECK(open.entries()[1].is_take);
    open.name = "alp";
    CHECK(names(open.entries()) == std::vector<std::string>{"Alpha.TOML"});
    // The only one that suits is meant.
    CHECK(open.accept() == open.folder() / "Alpha.TOML");
    open.name = "b";
    CHECK_FALSE(open.accept());
    CHECK(open.folder().filename() == "b");
    CHECK(open.name.empty());
    open.go_up();
    open.name = "Take";
    CHECK(open.accept() == open.folder() / "Take");
    open.name = "missing";
    CHECK_FALSE(open.accept());
    CHECK(open.problem.find("there is no file") != std::string::npos);
    open.name.clear();
    CHECK_FALSE(open.accept());
    open.step(1);
    open.step(1);
    CHECK(open.name == "Take");
    open.step(-5);
    CHECK(open.name == "b");
    open.step(50);
    CHECK(open.name == "zeta.toml");
    CHECK_FALSE(open.go_to(folder.path / "nowhere"));
    CHECK_FALSE(open.problem.empty());
    CHECK(open.entries().size() == 4);
}

TEST_CASE("a folder of slices is chosen as it is shown, by its name, or by a slice in it") {
    const Folder folder;
    std::filesystem::create_directories(folder.path / "dicom");
    folder.write("dicom/slice.dcm", "");
    FileChooser chooser(FileChooser::For::open, folder.path, {".dcm"});
    chooser.name = "dicom";
    CHECK(chooser.accept_folder() == folder.path / "dicom");
    chooser.go_to(folder.path / "dicom");
    chooser.name.clear();
    CHECK(chooser.accept_folder() == folder.path / "dicom");
    chooser.name = "slice.dcm";
    CHECK(chooser.accept_folder() == folder.path / "dicom");
    chooser.name = "gone.dcm";
    CHECK_FALSE(chooser.accept_folder());
    CHECK(chooser.problem == "that is no folder");
}

TEST_CASE("a file to save gets its ending, and replaces another only when a person is asked") {
    const Folder folder;
    folder.write("old.toml", "x");
    FileChooser save(FileChooser::For::save, folder.path, {".toml"});
    save.name = "new";
    CHECK(save.accept() == save.folder() / "new.toml");
    save.name = "old";
    CHECK_FALSE(save.accept());
    CHECK(save.replaced == save.folder() / "old.toml");
    CHECK(save.problem.empty());
    std::filesystem::create_directories(folder.path / "folder.toml");
    save.name = "folder";
    CHECK_FALSE(save.accept());
    CHECK_FALSE(save.replaced);
    CHECK(save.problem.find("is no file") != std::string::npos);
    save.name = "no/such/place";
    CHECK_FALSE(save.accept());
    CHECK(save.problem.find("there is no folder") != std::string::npos);
    save.name = (folder.path / "by path.toml").string();
    CHECK(save.accept() == folder.path / "by path.toml");
}

TEST_CASE("a list of files shows hidden ones when asked and the newest first and makes folders") {
    const Folder folder;
    namespace fs = std::filesystem;
    for (const char* file : {"a.toml", "b.toml", ".hidden.toml"}) folder.write(file, "text");
    const auto now = fs::last_write_time(folder.path / "a.toml");
    fs::last_write_time(folder.path / "b.toml", now + std::chrono::hours(1));
    fs::last_write_time(folder.path / ".hidden.toml", now - std::chrono::hours(1));
    FileChooser chooser(FileChooser::For::open, folder.path, {".toml"});
    CHECK(names(chooser.entries()) == std::vector<std::string>{"a.toml", "b.toml"});
    CHECK(chooser.entries()[0].size == 4);
    chooser.sort_by(FileChooser::Order::newest);
    chooser.show_hidden(true);
    CHECK(names(chooser.entries()) == std::vector<std::string>{"b.toml", "a.toml", ".hidden.toml"});
    CHECK_FALSE(chooser.make_folder("a.toml"));
    CHECK(chooser.problem.find("is there already") != std::string::npos);
    CHECK_FALSE(chooser.make_folder(""));
    CHECK_FALSE(chooser.make_folder("no/such/place"));
    REQUIRE(chooser.make_folder("new one"));
    CHECK(chooser.folder().filename() == "new one");
    chooser.go_up();
    CHECK(chooser.entries().front().name == "new one");
}

TEST_CASE("the start page lists examples with titles, files that still are there, takes and plans") {
    const Folder folder;
    namespace fs = std::filesystem;
    fs::create_directories(folder.path / "library/patches");
    fs::create_directories(folder.path / "library/pictures");
    folder.write("library/patches/ball.toml", "title = \"A ball\"\n[nodes.a]\ntype = \"constant\"\nrate = \"60 Hz\"\n");
    folder.write("library/patches/broken.toml", "title = ");
    folder.write("library/pictures/ball.png", "");
    fs::create_directories(folder.path / "work/monday");
    folder.write("work/monday/take.json", "{}");
    fs::create_directories(folder.path / "work/deep/er");
    folder.write("work/deep/case.plan.json", "{}");
    folder.write("work/deep/er/far.plan.json", "{}");
    const StartList list =
        start_list(folder.path / "library", folder.path / "work",
                   {(folder.path / "gone.toml").string(), (folder.path / "library/patches/ball.toml").string()});
    REQUIRE(list.examples.size() == 2);
    CHECK(list.examples[0].title == "A ball");
    CHECK(list.examples[0].picture.filename() == "ball.png");
    CHECK(list.examples[1].title == "broken");
    CHECK(list.examples[1].picture.empty());
    REQUIRE(list.recent.size() == 1);
    CHECK(list.recent[0].title == "ball.toml");
    REQUIRE(list.takes.size() == 1);
    CHECK(list.takes[0].title == "monday");
    REQUIRE(list.plans.size() == 1);
    CHECK(start_list(folder.path / "nothing", folder.path / "nothing", {}).examples.empty());
    CHECK(kind_of_file(folder.path / "work/monday") == FileKind::take);
    CHECK(kind_of_file("x.plan.json") == FileKind::plan);
    CHECK(kind_of_file("x.TOML") == FileKind::patch);
    CHECK(kind_of_file("scan.nii.gz") == FileKind::scan);
    CHECK(kind_of_file("SCAN.HDR") == FileKind::scan);
    CHECK(kind_of_file("scan.mha") == FileKind::unknown);  // no reader has it
    CHECK(kind_of_file("x.wav") == FileKind::sound);
    CHECK(kind_of_file("x.xyz") == FileKind::unknown);
}

TEST_CASE("the window remembers files and layouts, and survives a damaged memory") {
    const Folder folder;
    const auto file = folder.path / "state/window.json";
    {
        WindowMemory memory(file);
        for (int i = 0; i < 25; ++i) memory.opened(folder.path / ("p" + std::to_string(i)));
        memory.opened(folder.path / "p20");
        memory.keep_layout(folder.path / "p20", Layout::train);
    }
    const WindowMemory again(file);
    CHECK(again.recent().size() == 20);
    CHECK(again.recent().front().ends_with("p20"));
    CHECK(std::ranges::count(again.recent(), again.recent().front()) == 1);
    CHECK(again.layout_of(folder.path / "p20") == Layout::train);
    CHECK_FALSE(again.layout_of(folder.path / "p1"));
    for (const char* damage : {"{", "[]", "{\"recent\": 3}", "{\"recent\": [1], \"layouts\": {\"a\": 2}}", ""}) {
        folder.write("state/window.json", damage);
        CHECK(WindowMemory(file).recent().empty());
    }
    // A home that cannot be written.
    WindowMemory lost("/proc/nowhere/window.json");
    lost.opened("/tmp/x");
    CHECK(lost.recent().size() == 1);
}

TEST_CASE("two windows with one memory forget nothing of each other") {
    const Folder folder;
    const auto file = folder.path / "window.json";
    WindowMemory one(file), other(file);
    one.opened(folder.path / "a");
    one.keep_layout(folder.path / "a", Layout::plan);
    other.opened(folder.path / "b");
    other.keep_borders(folder.path / "b", "0.5 patch 1 | 0.5 scene 1\n");
    const WindowMemory next(file);
    CHECK(next.recent().size() == 2);
    CHECK(next.layout_of(folder.path / "a") == Layout::plan);
    CHECK(next.borders_of(folder.path / "b") == "0.5 patch 1 | 0.5 scene 1\n");
    CHECK(next.borders_of(folder.path / "a").empty());
}

TEST_CASE("a file in the patch's folder is named from there and one elsewhere by its whole path") {
    const Folder folder, elsewhere;
    run::RunChoice choice;
    choice.patch = folder
                       .write("p.toml",
                              "wires = [\"go.out -> drum.trigger\"]\n[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n"
                              "[nodes.drum]\ntype = \"player\"\nrate = \"48 kHz\"\n")
                       .string();
    Workbench bench(choice);
    std::filesystem::create_directories(folder.path / "sounds");
    REQUIRE(bench.take_file(folder.write("sounds/knock.wav", "x"), "") == "drum");
    CHECK(bench.editor().text().find("knock = \"sounds/knock.wav\"") != std::string::npos);
    const auto far = elsewhere.write("far.wav", "x");
    REQUIRE(bench.take_file(far, "drum") == "drum");
    CHECK(bench.editor().text().find("\"" + far.string() + "\"") != std::string::npos);
    REQUIRE(bench.undo());
    // In the same folder all paths stay as they are.
    const std::string text = bench.editor().text();
    REQUIRE(bench.save_as((folder.path / "q.toml").string()));
    CHECK(slurp(folder.path / "q.toml") == text);
    // A file that is there is replaced only when that is wanted.
    CHECK_FALSE(bench.save_as((folder.path / "p.toml").string()));
    REQUIRE(bench.save_as((folder.path / "p.toml").string(), Workbench::Existing::replace));
    CHECK(slurp(folder.path / "p.toml") == text);
    CHECK(bench.choice().patch == (folder.path / "p.toml").string());
}

TEST_CASE("messages are counted beyond those that are kept") {
    const Folder folder;
    run::RunChoice choice;
    choice.patch = folder.write("voice.toml", tactus::test::voice).string();
    Workbench bench(choice);
    const auto before = bench.told();
    for (int i = 0; i < 300; ++i) bench.tell("more");
    CHECK(bench.messages().size() == 200);
    CHECK(bench.told() == before + 300);
}

TEST_CASE("a file that is dropped goes to the node that takes it, as one edit") {
    const Folder folder;
    run::RunChoice choice;
    choice.patch = folder
                       .write("p.toml",
                              "wires = [\"go.out -> drum.trigger\"]\n[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n"
                              "[nodes.drum]\ntype = \"player\"\nrate = \"48 kHz\"\n")
                       .string();
    Workbench bench(choice);
    const std::string before = bench.editor().text();
    REQUIRE(bench.unfinished().find("drum"));
    const auto sound = folder.write("knock one.wav", "x");
    CHECK(bench.take_file(folder.write("words.txt", "x"), "").empty());
    CHECK(bench.messages().back().text.find("no node of this patch takes such a file") != std::string::npos);
    REQUIRE(bench.take_file(sound, "") == "drum");
    CHECK(bench.editor().text().find("knock_one = ") != std::string::npos);
    CHECK(bench.editor().text().find("sound = \"knock_one\"") != std::string::npos);
    // Another one takes its place; the name stays.
    const auto other = folder.write("other.wav", "x");
    REQUIRE(bench.take_file(other, "drum") == "drum");
    CHECK(bench.editor().text().find("other.wav") != std::string::npos);
    while (bench.undo()) {
    }
    CHECK(bench.editor().text() == before);
}

TEST_CASE("a sound that is dropped never takes the place of another one by chance") {
    const Folder folder;
    run::RunChoice choice;
    folder.write("a.wav", "x");
    folder.write("b.wav", "x");
    choice.patch =
        folder
            .write("p.toml",
                   "wires = [\"go.out -> drum.trigger\", \"go.out -> bell.trigger\"]\n[assets]\na = \"a.wav\"\n"
                   "b = \"b.wav\"\n[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n"
                   "[nodes.drum]\ntype = \"player\"\nrate = \"48 kHz\"\nsound = \"a\"\n"
                   "[nodes.bell]\ntype = \"player\"\nrate = \"48 kHz\"\nsound = \"b\"\n")
            .string();
    Workbench bench(choice);
    const std::string before = bench.editor().text();
    const auto sound = folder.write("LOUD.WAV", "x");
    CHECK(bench.take_file(sound, "").empty());
    CHECK(bench.messages().back().text.find("bell, drum") != std::string::npos);
    CHECK(bench.editor().text() == before);
    // Where it is dropped, only that node changes.
    CHECK(bench.take_file(sound, "bell") == "bell");
    CHECK(bench.editor().text().find("sound = \"a\"") != std::string::npos);
    CHECK(bench.editor().text().find("sound = \"LOUD\"") != std::string::npos);
}

TEST_CASE("a sound and a bone that no node takes bring a node along as one edit") {
    const Folder folder;
    run::RunChoice choice;
    choice.patch = folder.write("p.toml", "[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n").string();
    Workbench bench(choice);
    const std::string before = bench.editor().text();
    CHECK(bench.take_file(folder.write("knock.wav", "x"), "", Point{50.0, 60.0}) == "player");
    CHECK(bench.editor().text().find("sound = \"knock\"") != std::string::npos);
    REQUIRE(bench.undo());
    CHECK(bench.editor().text() == before);
    CHECK(bench.take_file(folder.write("femur.vdb", "x"), "") == "body");
    CHECK(bench.editor().text().find("bone = \"femur\"") != std::string::npos);
    REQUIRE(bench.undo());
    CHECK(bench.editor().text() == before);
}
