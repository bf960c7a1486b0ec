// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_paths.hpp"
#include "graph/edit/patch_editor.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace tactus;

TEST_CASE("a patch that moves still names the files it named, and keeps all other bytes") {
    const std::string text = R"(title = "a"  # bones/a.vdb
[assets]
still = "../bones/a.vdb#left"   # kept
far = "/data/b.vdb"
near = 'c.csv'
[nodes.voice]
type = "patch:parts/voice.toml"
rate = "48 kHz"
[nodes.tone]
type = "sine"
)";
    CHECK(edit::with_absolute_paths(text, "/lib/patches") == R"(title = "a"  # bones/a.vdb
[assets]
still = "/lib/bones/a.vdb#left"   # kept
far = "/data/b.vdb"
near = "/lib/patches/c.csv"
[nodes.voice]
type = "patch:/lib/patches/parts/voice.toml"
rate = "48 kHz"
[nodes.tone]
type = "sine"
)");
    CHECK(edit::with_absolute_paths("assets = { a = \"x\", b = \"y\" }\n", "/l") ==
          "assets = { a = \"/l/x\", b = \"/l/y\" }\n");
}

TEST_CASE("a patch that moves names what lies below its new folder from there and changes nothing in its old one") {
    const std::string text = "[assets]\na = \"../bones/a.vdb#left\"\nb = \"c.csv\"\nfar = \"/home/me/far.csv\"\n";
    CHECK(edit::with_paths_moved(text, "/home/me/patches", "/home/me/patches/") == text);
    CHECK(edit::with_paths_moved(text, "/home/me/patches", "/home/me") ==
          "[assets]\na = \"bones/a.vdb#left\"\nb = \"patches/c.csv\"\nfar = \"/home/me/far.csv\"\n");
    CHECK(edit::with_paths_moved(text, "/home/me/patches", "/srv") ==
          "[assets]\na = \"/home/me/bones/a.vdb#left\"\nb = \"/home/me/patches/c.csv\"\nfar = \"/home/me/far.csv\"\n");
    CHECK(edit::path_from("/home/me", "/home/me/../me/x.wav") == "x.wav");
    CHECK(edit::path_from("/home/me", "/home/meadow/x.wav") == "/home/meadow/x.wav");
}

TEST_CASE("a patch saved as another file keeps its history there, and the first file its bytes") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("tactus_save_as_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const auto slurp = [&](const char* name) {
        std::ostringstream text;
        text << std::ifstream(folder / name).rdbuf();
        return text.str();
    };
    std::ofstream(folder / "a.toml") << "one";
    edit::PatchEditor editor("one", folder / "a.toml", [](std::string_view) { return std::nullopt; });
    for (const char* next : {"one two", "one two three", "one two three four"})
        editor.apply([&](std::string_view) { return std::string(next); });
    editor.undo();
    const std::int64_t version = editor.version();
    editor.save_as(folder / "b.toml", [](std::string_view text) { return "moved " + std::string(text); });
    CHECK(editor.version() > version);
    CHECK(editor.file() == folder / "b.toml");
    CHECK(editor.is_saved());
    CHECK(slurp("a.toml") == "one");
    CHECK(slurp("b.toml") == "moved one two three");
    editor.redo();
    CHECK(editor.text() == "moved one two three four");
    editor.undo();
    editor.undo();
    CHECK(editor.text() == "moved one two");
    CHECK_FALSE(editor.is_saved());
    CHECK_THROWS(editor.save_as(folder / "none/c.toml", [](std::string_view text) { return std::string(text); }));
    CHECK(editor.file() == folder / "b.toml");
    std::filesystem::remove_all(folder);
}
