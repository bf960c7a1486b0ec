// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_edit.hpp"

#include "dsp/core/random.hpp"
#include "graph/edit/patch_editor.hpp"
#include "graph/patch/patch.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>
#include <filesystem>
#include <fstream>

using namespace tactus;

namespace {

const std::string plain = R"(# A voice.
title = "t"
wires = [
  # first
  "tone.signal -> loud.in",     # to the gain

  # second
  "loud.out    -> kept.in"
]

[nodes.tone]                    # the source
type      = "sine"
rate      = "48 kHz"
frequency = "100 Hz"            # low

# what makes it loud
[nodes.loud]
type = "gain"
rate = "48 kHz"

[nodes.kept]
type = "record"
rate = "48 kHz"
)";

std::string with_crlf(std::string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
    return text;
}

/// The patch as the reader sees it, without places.
std::string meaning(const std::string& text) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "p.toml", problems);
    std::string out;
    for (const Error& error : problems.list) out += std::string("PROBLEM ") + error.what() + "\n";
    for (const patch::PatchWire& w : patch.wires)
        out += w.from_node + "." + w.from_port + ">" + w.to_node + "." + w.to_port + " " +
               std::to_string(static_cast<int>(w.mode)) + "\n";
    for (const patch::PatchNode& n : patch.nodes) {
        out += n.name + ":" + n.type + "@" + n.rate + n.group;
        for (const OptionText& s : n.settings) out += " " + s.name + "=" + s.text;
        out += "\n";
    }
    return out;
}

bool reads(const std::string& text) { return meaning(text).find("PROBLEM") == std::string::npos; }

/// `after` is `before` but for one run of bytes.
std::string changed_part(const std::string& before, const std::string& after) {
    std::size_t a = 0, b = 0;
    while (a < before.size() && a < after.size() && before[a] == after[a]) ++a;
    while (b < before.size() - a && b < after.size() - a &&
           before[before.size() - 1 - b] == after[after.size() - 1 - b])
        ++b;
    return after.substr(a, after.size() - a - b);
}

}  // namespace

TEST_CASE("a parameter that stands in the patch changes in its place, comment and all") {
    const std::string made = edit::with_setting(plain, "tone", "frequency", "220 Hz");
    CHECK(made.find("frequency = \"220 Hz\"            # low\n") != std::string::npos);
    CHECK(changed_part(plain, made) == "22");
}

TEST_CASE("a parameter that is new becomes a line in the layout of its table") {
    const std::string made = edit::with_setting(plain, "tone", "amplitude", "0.5");
    CHECK(changed_part(plain, made) == "amplitude = 0.5\n");
    CHECK(made.find("# low\namplitude = 0.5\n\n# what makes it loud") != std::string::npos);
    CHECK(edit::with_setting(plain, "loud", "factor", "007").find("rate = \"48 kHz\"\nfactor = \"007\"\n") !=
          std::string::npos);
}

TEST_CASE("a parameter that is set back to its default takes its line away") {
    const std::string made = edit::without_setting(plain, "tone", "frequency");
    CHECK(made.find("frequency") == std::string::npos);
    CHECK(made.size() == plain.size() - std::string("frequency = \"100 Hz\"            # low\n").size());
    CHECK_THROWS_WITH(edit::without_setting(plain, "loud", "factor"), Catch::Matchers::ContainsSubstring("not set"));
}

TEST_CASE("a wire is added below the last one, under its arrow, and the comments between wires stay") {
    const std::string made = edit::with_wire(plain, {"tone.signal", "kept.second", ""});
    CHECK(made.find("  \"loud.out    -> kept.in\",\n  \"tone.signal -> kept.second\"\n]\n") != std::string::npos);
    CHECK(made.find("# to the gain\n\n  # second\n") != std::string::npos);
    CHECK(edit::without_wire(made, "kept.second").find("\"loud.out    -> kept.in\",\n]\n") != std::string::npos);
}

TEST_CASE("an input has one wire: a second takes the place of the first") {
    const std::string made = edit::with_wire(plain, {"tone.signal", "kept.in", "linear"});
    CHECK(made.find("  # second\n  \"tone.signal -> kept.in as linear\"\n]") != std::string::npos);
    CHECK(made.find("loud.out") == std::string::npos);
}

TEST_CASE("an input of events keeps its wires when another one is added, and each goes by itself") {
    using edit::InputTakes;
    const std::string both = edit::with_wire(plain, {"tone.signal", "kept.in", ""}, InputTakes::many_wires);
    CHECK(both.find("\"loud.out    -> kept.in\"") != std::string::npos);
    CHECK(both.find("\"tone.signal -> kept.in\"") != std::string::npos);
    // The same two ends are one wire.
    const std::string again = edit::with_wire(both, {"loud.out", "kept.in", "delay 1"}, InputTakes::many_wires);
    CHECK(again.find("\"loud.out    -> kept.in as delay 1\"") != std::string::npos);
    CHECK(again.find("\"loud.out    -> kept.in\"") == std::string::npos);
    CHECK(again.find("\"tone.signal -> kept.in\"") != std::string::npos);
    CHECK(meaning(edit::without_wire(both, "kept.in", "tone.signal")) == meaning(plain));
    CHECK(edit::without_wire(both, "kept.in", "loud.out").find("\"tone.signal -> kept.in\"") != std::string::npos);
    CHECK_THROWS_WITH(edit::without_wire(plain, "kept.in", "tone.signal"),
                      Catch::Matchers::ContainsSubstring("no wire leads from 'tone.signal' to 'kept.in'"));
}

TEST_CASE("a wire that goes takes its line, not its neighbours'") {
    const std::string made = edit::without_wire(plain, "loud.in");
    CHECK(made.find("  # first\n\n  # second\n  \"loud.out    -> kept.in\"\n]") != std::string::npos);
}

TEST_CASE("a node that goes takes its table and its wires along and leaves the comments above others") {
    const std::string made = edit::without_node(plain, "loud");
    CHECK(reads(made));
    CHECK(meaning(made) == "tone:sine@48 kHz frequency=100 Hz\nkept:record@48 kHz\n");
    CHECK(made.find("# what makes it loud") != std::string::npos);
    CHECK_THROWS_WITH(edit::without_node(plain, "none"), Catch::Matchers::ContainsSubstring("no node 'none'"));
}

TEST_CASE("a node under a new name keeps its wires, wherever it is named") {
    const std::string made = edit::with_node_named(plain, "loud", "louder");
    CHECK(made.find("\"tone.signal -> louder.in\",     # to the gain") != std::string::npos);
    CHECK(made.find("\"louder.out    -> kept.in\"") != std::string::npos);
    CHECK(made.find("[nodes.louder]\n") != std::string::npos);
    CHECK(edit::with_node_named(made, "louder", "loud") == plain);
    CHECK_THROWS_WITH(edit::with_node_named(plain, "loud", "tone"), Catch::Matchers::ContainsSubstring("already"));
    CHECK_THROWS_WITH(edit::with_node_named(plain, "loud", "a b"), Catch::Matchers::ContainsSubstring("no name"));
}

TEST_CASE("a new node's table stands behind the last node's, with its wires in the list") {
    const std::string made =
        edit::with_node(plain, {"echo", "delay", "48 kHz", "", {{"time", "10 ms"}}, {{"loud.out", "echo.in", ""}}});
    CHECK(reads(made));
    CHECK(made.ends_with("rate = \"48 kHz\"\n\n[nodes.echo]\ntype = \"delay\"\nrate = \"48 kHz\"\ntime = \"10 ms\"\n"));
    CHECK(made.find("\"loud.out    -> kept.in\",\n  \"loud.out    -> echo.in\"\n]") != std::string::npos);
}

TEST_CASE("edits do the same to every layout that TOML allows") {
    const std::string one_line =
        "wires=[\"tone.signal->loud.in\",\"loud.out -> kept.in\"]\n[nodes]\ntone={type=\"sine\",rate=\"48 "
        "kHz\",frequency="
        "\"100 Hz\"}\nloud = { type = \"gain\", rate = \"48 kHz\" }\nkept = { type = \"record\", rate = \"48 kHz\" }";
    const std::string braces =
        "wires = [ 'tone.signal -> loud.in'\n, \"loud\\u002eout -> kept.in\" # ] not yet\n , ]\nnodes = { tone = { "
        "type = "
        "\"sine\", rate = \"48 kHz\", frequency = \"100 Hz\" }, \"loud\" = { rate = \"48 kHz\", type = \"gain\" }, "
        "kept.type = \"record\", kept.rate = \"48 kHz\" }\n";
    const std::string dotted =
        "nodes.tone.type = \"sine\"\nnodes.tone.rate = '48 kHz'\nnodes.tone.frequency = \"100 Hz\"\n"
        "nodes.\"loud\" . type = \"gain\"  # [nodes.loud]\nnodes.loud.rate = \"48 kHz\"\nwires = [\"tone.signal -> "
        "loud.in\""
        ", # a ] and a \"\n\"loud.out -> kept.in\"]\n\"nodes\".kept.type = \"\"\"record\"\"\"\nnodes.kept.rate = \"48 "
        "kHz\"\n";
    const std::string quoted =
        "\"wires\" = [ \"\"\"\ntone.signal -> loud.in\"\"\", \"loud.out -> kept.in\", ]\n[ nodes . \"tone\" ]\ntype = "
        "\"sine\"\nrate = \"48 kHz\"\n\"frequency\" = \"100 Hz\"\n[\"nodes\".'loud']\ntype = \"gain\"\nrate = \"48 "
        "kHz\"\n"
        "[nodes.kept]\nrate = \"48 kHz\"\ntype = \"record\"";
    for (const std::string& text :
         {plain, with_crlf(plain), "\xEF\xBB\xBF" + plain, one_line, braces, dotted, quoted}) {
        INFO(text);
        REQUIRE(reads(text));
        const std::string set = edit::with_setting(text, "tone", "frequency", "220 Hz");
        CHECK(meaning(set).find("frequency=220 Hz") != std::string::npos);
        CHECK(changed_part(text, set) == "22");
        const std::string added = edit::with_setting(text, "loud", "factor", "2");
        CHECK(meaning(added).find("factor=2\n") != std::string::npos);
        CHECK(meaning(edit::without_setting(added, "loud", "factor")) == meaning(text));
        CHECK(meaning(edit::without_setting(text, "tone", "frequency")).find("frequency") == std::string::npos);
        const std::string named = edit::with_node_named(text, "loud", "louder");
        CHECK(meaning(named).find("tone.signal>louder.in 0\nlouder.out>kept.in 0\n") != std::string::npos);
        CHECK(meaning(edit::with_node_named(named, "louder", "loud")) == meaning(text));
        const std::string wired = edit::with_wire(text, {"tone.signal", "kept.other", "delay 3"});
        CHECK(meaning(wired).find("loud.out>kept.in 0\ntone.signal>kept.other 3\n") != std::string::npos);
        CHECK(meaning(edit::without_wire(wired, "kept.other")) == meaning(text));
        for (const char* to : {"loud.in", "kept.in"}) {
            const std::string less = edit::without_wire(text, to);
            INFO(less);
            CHECK(reads(less));
            CHECK(meaning(less).find(std::string(">") + to) == std::string::npos);
            CHECK(reads(edit::with_wire(less, {"tone.signal", to, ""})));
        }
        const std::string without = edit::without_node(text, "loud");
        INFO(without);
        CHECK(reads(without));
        CHECK(meaning(without).find("loud") == std::string::npos);
        const std::string grown =
            edit::with_node(text, {"echo", "delay", "48 kHz", "", {}, {{"tone.signal", "echo.in", ""}}});
        INFO(grown);
        CHECK(reads(grown));
        CHECK(meaning(grown).find("echo:delay@48 kHz") != std::string::npos);
        CHECK(meaning(edit::without_node(grown, "echo")) == meaning(text));
        if (text.find('\r') == std::string::npos) continue;
        for (std::size_t at = 0; (at = grown.find('\n', at)) != std::string::npos; ++at) CHECK(grown[at - 1] == '\r');
    }
}

TEST_CASE("a patch without wires gets its list above the first table") {
    const std::string bare = "title = \"t\"\n\n[nodes.a]\ntype = \"sine\"\nrate = \"48 kHz\"\n";
    CHECK(edit::with_wire(bare, {"a.signal", "a.in", ""})
              .starts_with("title = \"t\"\nwires = [\n  \"a.signal -> a.in\",\n]\n\n"));
    for (const char* list : {"wires = []\n", "wires = [ # none\n]\n", "wires = [\n  # none\n  ]\n"}) {
        const std::string text = list + bare;
        INFO(text);
        const std::string made = edit::with_wire(text, {"a.signal", "a.in", ""});
        INFO(made);
        CHECK(meaning(made).starts_with("a.signal>a.in 0\n"));
        CHECK(meaning(edit::without_wire(made, "a.in")) == meaning(text));
    }
}

TEST_CASE("an edit that does not compile is refused with the reason and changes nothing") {
    edit::PatchEditor editor(plain, "p.toml", [](std::string_view text) -> std::optional<std::string> {
        if (text.find("bad") != std::string_view::npos) return "bad is not allowed";
        return std::nullopt;
    });
    const auto set = [&](const char* value) {
        return editor.apply(
            [value](std::string_view text) { return edit::with_setting(text, "tone", "frequency", value); });
    };
    CHECK(set("bad") == "bad is not allowed");
    CHECK(editor.text() == plain);
    CHECK_FALSE(editor.can_undo());
    CHECK(editor.apply([](std::string_view text) { return edit::without_node(text, "nobody"); })->find("no node") == 0);
    CHECK_FALSE(set("5 Hz"));
    CHECK(editor.can_undo());
    CHECK_FALSE(editor.is_saved());
}

TEST_CASE("random edits taken back give the bytes there were, and made again those there are") {
    for (const std::string& start : {plain, with_crlf(plain)}) {
        edit::PatchEditor editor(start, "p.toml", [](std::string_view text) -> std::optional<std::string> {
            return reads(std::string(text)) ? std::nullopt : std::optional<std::string>("unreadable");
        });
        const Random random{7};
        std::uint64_t drawn = 0;
        const auto pick = [&](std::uint64_t n) { return random.bits(drawn++) % n; };
        std::vector<std::string> states{start};
        for (int i = 0; i < 200; ++i) {
            const std::string name = "n" + std::to_string(pick(6)), other = "n" + std::to_string(pick(6));
            const std::uint64_t kind = pick(7);
            editor.apply([&](std::string_view text) {
                switch (kind) {
                    case 0: return edit::with_setting(text, name, "gain", std::to_string(pick(9)) + " dB");
                    case 1: return edit::without_setting(text, name, "gain");
                    case 2:
                        return edit::with_node(text,
                                               {name, "gain", "48 kHz", "", {}, {{other + ".out", name + ".in", ""}}});
                    case 3: return edit::without_node(text, name);
                    case 4: return edit::with_wire(text, {name + ".out", other + ".in", pick(2) ? "linear" : ""});
                    case 5: return edit::without_wire(text, name + ".in");
                    default: return edit::with_node_named(text, name, other);
                }
            });
            if (editor.text() != states.back()) states.push_back(editor.text());
        }
        REQUIRE(states.size() > 60);
        for (std::size_t i = states.size(); i-- > 1;) {
            REQUIRE(editor.text() == states[i]);
            editor.undo();
        }
        CHECK(editor.text() == start);
        CHECK_FALSE(editor.can_undo());
        while (editor.can_redo()) editor.redo();
        CHECK(editor.text() == states.back());
    }
}

TEST_CASE("saving replaces the file at once, through a link too, and never over somebody else's change") {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("tactus-edit-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const fs::path file = folder / "p.toml", link = folder / "link.toml";
    const auto write = [](const fs::path& path, const std::string& text) {
        std::ofstream(path, std::ios::binary) << text;
    };
    const auto read = [](const fs::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    write(file, plain);
    fs::create_symlink(file, link);
    edit::PatchEditor editor(plain, link, [](std::string_view) { return std::nullopt; });
    editor.apply([](std::string_view text) { return edit::with_setting(text, "tone", "frequency", "5 Hz"); });
    editor.save();
    CHECK(fs::is_symlink(link));
    CHECK(read(file) == editor.text());
    CHECK(editor.is_saved());
    CHECK_FALSE(fs::exists(file.string() + ".part"));

    write(file, plain);
    editor.apply([](std::string_view text) { return edit::with_setting(text, "tone", "frequency", "6 Hz"); });
    CHECK_THROWS_WITH(editor.save(), Catch::Matchers::ContainsSubstring("somebody else"));
    CHECK(read(file) == plain);
    CHECK(editor.reload());
    CHECK(editor.text() == plain);
    editor.undo();
    CHECK(editor.text().find("6 Hz") != std::string::npos);
    fs::remove_all(folder);
}

TEST_CASE("what stands within a patch that is a node is edited in its own file") {
    using Catch::Matchers::ContainsSubstring;
    CHECK_THROWS_WITH(edit::with_setting(plain, "voice:tone", "frequency", "5 Hz"),
                      ContainsSubstring("is within 'voice'"));
    CHECK_THROWS_WITH(edit::without_setting(plain, "voice:tone", "frequency"), ContainsSubstring("is within 'voice'"));
    CHECK_THROWS_WITH(edit::without_node(plain, "voice:tone"), ContainsSubstring("is within 'voice'"));
    CHECK_THROWS_WITH(edit::with_node_named(plain, "voice:tone", "b"), ContainsSubstring("is within 'voice'"));
    CHECK_THROWS_WITH(edit::with_wire(plain, {"voice:tone.signal", "x.in", {}}),
                      ContainsSubstring("is within 'voice'"));
    CHECK_THROWS_WITH(edit::without_wire(plain, "voice:tone.in"), ContainsSubstring("is within 'voice'"));
}
