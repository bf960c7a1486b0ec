// SPDX-License-Identifier: Apache-2.0
// Finding commands and node types by words.
#include "tools/view/frame/commands.hpp"
#include "tests/support/catch.hpp"
#include "tools/view/frame/search.hpp"
#include "tools/view/patch/type_search.hpp"

#include <algorithm>

using namespace tactus;
using namespace tactus::view;

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
    for (const char* name : {"gain", "sphere_contact", "device_input", "audio_output", "filter"}) {
        const auto found = types_for(name, nullptr);
        REQUIRE_FALSE(found.empty());
        CHECK(found.front()->name == name);
    }
    const auto has = [](const std::vector<const NodeType*>& all, const char* name) {
        return std::ranges::any_of(all, [&](const NodeType* type) { return type->name == name; });
    };
    CHECK(has(types_for("speaker", nullptr), "audio_output"));
    CHECK(has(types_for("ball", nullptr), "sphere_contact"));
    CHECK(has(types_for("", &value::pose), "sphere_contact"));
    CHECK_FALSE(has(types_for("", &value::pose), "audio_output"));
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
