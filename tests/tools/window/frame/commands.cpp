// SPDX-License-Identifier: Apache-2.0
// Finding commands and node types by words.
#include "tools/window/frame/commands.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/window/frame/key_letters.hpp"
#include "tools/window/frame/layout_text.hpp"
#include "tools/window/frame/search.hpp"
#include "tools/window/patch/type_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace tactus;
using namespace tactus::window;

TEST_CASE("entries are found by beginnings, words and synonyms, and the best come first") {
    CHECK(suits("", "gain", "") == 1.0);
    CHECK(suits("gain", "gain", "") > suits("gain", "gain_control", ""));
    CHECK(suits("GAI", "gain", "") > suits("ain", "gain", ""));
    CHECK(suits("volume", "gain", "Multiplies a signal.") > 0.0);
    CHECK(suits("ball", "sphere_contact", "") > 0.0);
    CHECK(suits("xyzzy", "gain", "Multiplies a signal.") == 0.0);
    CHECK(suits("gain xyzzy", "gain", "") == 0.0);
    CHECK(suits("signal multiplies", "gain", "Multiplies a signal.") > 0.0);
}

TEST_CASE("a node type is found by its name before others, and only where its input takes the value") {
    ::setenv("TACTUS_LIBRARY", test::library_folder().c_str(), 1);  // whose patches tell what is used most
    for (const char* name : {"gain", "sphere_contact", "device_input", "audio_output", "filter"}) {
        const auto found = types_for(name, nullptr);
        REQUIRE_FALSE(found.empty());
        CHECK(found.front()->name == name);
    }
    const auto has = [](const std::vector<const NodeType*>& all, const char* name) {
        return std::ranges::any_of(all, [&](const NodeType* type) { return type->name == name; });
    };
    CHECK(has(types_for("speaker", nullptr), "audio_output"));
    CHECK(types_for("ball", nullptr).front()->name == "sphere_contact");
    CHECK(has(types_for("", &value::pose), "sphere_contact"));
    CHECK_FALSE(has(types_for("", &value::pose), "audio_output"));
    // By parameter, port and unit.
    CHECK(has(types_for("friction", nullptr), "sphere_proxy"));
    CHECK(has(types_for("n/mm", nullptr), "sphere_contact"));
    CHECK(has(types_for("penetration", nullptr), "sphere_contact"));
    // What was named stands above what only has such a port.
    CHECK(types_for("gain", nullptr).front()->name == "gain");
    // Without words those that patches use most.
    CHECK(has({types_for("", nullptr).front(), types_for("", nullptr)[1]}, "record"));
    CHECK(types_for("no such thing at all", nullptr).empty());
}

TEST_CASE("keys are read from their text, and what is not possible comes last") {
    CHECK(chord_of("Ctrl+Shift+S") == Chord{true, true, false, "S"});
    CHECK(chord_of("F1") == Chord{false, false, false, "F1"});
    CHECK(chord_of("Ctrl++") == Chord{true, false, false, "+"});
    const std::vector<Command> all{{"File", "Save", "", "", [] {}, [] { return false; }},
                                   {"File", "Save as...", "", "", [] {}},
                                   {"Edit", "Undo", "", "back", [] {}}};
    const auto found = find_commands(all, "save");
    REQUIRE(found.size() == 2);
    CHECK(found[0]->name == "Save as...");
    CHECK(find_commands(all, "back").front()->name == "Undo");
}

TEST_CASE("a text field leaves chords to the window that mean nothing in it") {
    for (const char* keys : {"Ctrl+S", "Ctrl+Shift+S", "Ctrl+O", "Ctrl+N", "Ctrl+P", "Ctrl+Q", "F1", "F10"})
        CHECK(passes_text_field(chord_of(keys)));
    for (const char* keys : {"Ctrl+A", "Ctrl+Z", "Ctrl+V", "F", "S", "Del", "Space", "Alt+S", "Ctrl+Left"})
        CHECK_FALSE(passes_text_field(chord_of(keys)));
}

TEST_CASE("keys are those of the letters on them and a released key is the one that was pressed") {
    KeyLetters keys;
    const auto once = [&](int key, const char* name) {
        const int code = keys.code(key, 7, name, true);
        CHECK(keys.code(key, 7, "?", false) == code);
        return code;
    };
    // German: Z and Y change places.
    CHECK(once('Y', "z") == 'Z');
    CHECK(once('Z', "y") == 'Y');
    // French: A stands where Q is on others; a comma where M is.
    CHECK(once('Q', "a") == 'A');
    CHECK(once(';', "m") == 'M');
    CHECK(once('M', ",") == ',');
    CHECK(once('1', "&") == '1');
    // Letters of other scripts, and no name at all: the place.
    CHECK(once('Z', "\xd1\x8f") == 'Z');
    CHECK(once('[', "\xc3\xbc") == '[');
    CHECK(once('S', nullptr) == 'S');
    CHECK(once(290, "x") == 290);
    CHECK(once(321, "1") == 321);
    // The layout changes while a key is down.
    CHECK(keys.code('Y', 9, "y", true) == 'Y');
    CHECK(keys.code('Y', 9, "z", false) == 'Y');
}

TEST_CASE("borders between panels are written as text and read back and damage is left out") {
    auto columns = columns_of(Layout::plan, 1000.0, [](Panel) { return PanelRoom::full; });
    move_border(columns, 0, 0.1);
    move_border(columns[1], 1, -0.05);
    const std::string text =
        text_of_borders({columns, columns_of(Layout::train, 1000.0, [](Panel) { return PanelRoom::full; })});
    const auto again = borders_of_text(text + "0.5 nothing 1\n2 patch 1\n0.5 patch\nx\n\n0.5 | 0.5 scene 1\n");
    REQUIRE(again.size() == 2);
    CHECK(text_of_borders(again) == text);
    CHECK(std::abs(again[0][0].share - columns[0].share) < 1e-4);
    CHECK(again[0][1].panels[1].panel == columns[1].panels[1].panel);
}
