// SPDX-License-Identifier: Apache-2.0
// Comments on the clipboard, alone and with nodes, by Dear ImGui without a window.
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/patch/patch_panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <memory>

using namespace tactus;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::voice;

namespace {

const std::string commented = voice + R"([window.places]
level = [20, 40]
[window.comments.why]
text = "the reason\nwhy"
colour = "amber"
place = [10, 20]
size = [300, 120]
[window.comments.note_2]
text = "another"
place = [400, 300]
size = [200, 80]
)";

/// The panels of several windows with one clipboard.
class Desks {
public:
    Desks() : before_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()) {
        ImGui::SetCurrentContext(own_);
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = ImVec2(1500, 900);
        unsigned char* pixels = nullptr;
        int wide = 0, high = 0;
        ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
    }
    ~Desks() {
        ImGui::DestroyContext(own_);
        ImGui::SetCurrentContext(before_);
    }
    Desks(const Desks&) = delete;
    Desks& operator=(const Desks&) = delete;

private:
    ImGuiContext *before_, *own_;
};

struct Side {
    Folder folder;
    Workbench bench;
    PatchPanel panel{bench};

    explicit Side(const std::string& text) : bench(choice_of(folder, text)) {}
    static run::RunChoice choice_of(const Folder& folder, const std::string& text) {
        run::RunChoice choice;
        choice.patch = folder.write("outer.toml", text).string();
        choice.out = folder.path / "out";
        return choice;
    }
    const patch::PatchComment& comment(const std::string& name) const {
        const auto& all = bench.window().comments;
        const auto found = std::ranges::find(all, name, &patch::PatchComment::name);
        INFO(name);
        REQUIRE(found != all.end());
        return *found;
    }
    bool has(const std::string& name) const {
        return std::ranges::find(bench.window().comments, name, &patch::PatchComment::name) !=
               bench.window().comments.end();
    }
    /// From the top of the node to that of the comment, as they are drawn.
    Point apart(const std::string& node, const std::string& name) const {
        const int index = bench.picture().find(node);
        REQUIRE(index >= 0);
        const Box box = bench.picture().nodes[static_cast<std::size_t>(index)].box;
        const auto drawn = std::ranges::find(bench.picture().comments, name, &PictureComment::name);
        REQUIRE(drawn != bench.picture().comments.end());
        return {drawn->box.left - box.left, drawn->box.top - box.top};
    }
};

}  // namespace

TEST_CASE("chosen comments alone are copied and pasted under free names, as one step") {
    const Desks desks;
    Side side(commented);
    const std::string before = side.bench.editor().text();
    side.panel.chosen_comments = {"why", "note_2"};
    side.panel.copy();
    CHECK_FALSE(side.bench.editor().can_undo());
    side.panel.paste();
    CHECK(side.panel.chosen.empty());
    CHECK(side.panel.chosen_comments == std::set<std::string>{"why_2", "note_3"});
    CHECK(side.bench.messages().back().text.find("added 2 comments") != std::string::npos);
    const patch::PatchComment& copy = side.comment("why_2");
    CHECK(copy.text == "the reason\nwhy");
    CHECK(copy.colour == "amber");
    CHECK(copy.place.x == 40.0);
    CHECK(copy.place.y == 50.0);
    CHECK(copy.size.x == 300.0);
    // A second time beside the first.
    side.panel.paste();
    CHECK(side.comment("why_3").place.x == 70.0);
    REQUIRE(side.bench.undo());
    REQUIRE(side.bench.undo());
    CHECK(side.bench.editor().text() == before);
}

TEST_CASE("chosen comments and nodes are duplicated together, as one step") {
    const Desks desks;
    Side side(commented);
    const std::string before = side.bench.editor().text();
    side.panel.chosen = {"level"};
    side.panel.selected = "level";
    side.panel.chosen_comments = {"why"};
    const Point apart = side.apart("level", "why");
    side.panel.duplicate();
    CHECK(side.panel.chosen == std::set<std::string>{"level_2"});
    CHECK(side.panel.chosen_comments == std::set<std::string>{"why_2"});
    CHECK(side.bench.messages().back().text.find("added 1 node and 1 comment") != std::string::npos);
    const Point copied = side.apart("level_2", "why_2");
    CHECK(copied.x == Approx(apart.x).margin(1.0));
    CHECK(copied.y == Approx(apart.y).margin(1.0));
    REQUIRE(side.bench.undo());
    CHECK(side.bench.editor().text() == before);
}

TEST_CASE("comments that are cut are gone in one step and come back by paste") {
    const Desks desks;
    Side side(commented);
    const std::string before = side.bench.editor().text();
    side.panel.chosen_comments = {"why"};
    side.panel.cut();
    CHECK_FALSE(side.has("why"));
    CHECK(side.has("note_2"));
    side.panel.paste();
    CHECK(side.comment("why").text == "the reason\nwhy");
    REQUIRE(side.bench.undo());
    REQUIRE(side.bench.undo());
    CHECK(side.bench.editor().text() == before);
    // With nodes, too.
    side.panel.chosen = {"level"};
    side.panel.chosen_comments = {"why"};
    side.panel.cut();
    CHECK(side.bench.picture().find("level") < 0);
    CHECK_FALSE(side.has("why"));
    REQUIRE(side.bench.undo());
    CHECK(side.bench.editor().text() == before);
}

TEST_CASE("nodes and their comments come into another window as they stood to each other") {
    const Desks desks;
    Side from(commented);
    from.panel.chosen = {"level"};
    from.panel.selected = "level";
    from.panel.chosen_comments = {"why"};
    const Point apart = from.apart("level", "why");
    from.panel.copy();
    // Its lane of 60 Hz lies below another one.
    Side to(
        "[nodes.fast]\ntype = \"constant\"\nrate = \"1 kHz\"\n[nodes.slow]\ntype = \"constant\"\nrate = \"60 Hz\"\n");
    to.panel.paste();
    REQUIRE(to.bench.picture().find("level") >= 0);
    const Point there = to.apart("level", "why");
    CHECK(there.x == Approx(apart.x).margin(1.0));
    CHECK(there.y == Approx(apart.y).margin(1.0));
    REQUIRE(to.bench.undo());
    CHECK_FALSE(to.has("why"));
    CHECK(to.bench.picture().find("level") < 0);
    // Comments alone.
    from.panel.choose_only("");
    from.panel.chosen_comments = {"note_2"};
    from.panel.copy();
    to.panel.paste(Point{500.0, 60.0});
    CHECK(to.comment("note_2").place.x == 500.0);
    CHECK(to.comment("note_2").place.y == 60.0);
}

TEST_CASE("a clipboard without nodes or comments is refused") {
    const Desks desks;
    Side side(voice);
    for (const char* text : {"", "words", "[window.comments]\n", "title = \"none\"\n"}) {
        ImGui::SetClipboardText(text);
        side.panel.paste();
        CHECK(side.bench.messages().back().text == "the clipboard holds no nodes or comments of a patch");
        CHECK_FALSE(side.bench.editor().can_undo());
    }
}
