// SPDX-License-Identifier: Apache-2.0
// The picture of the patch and the panel of a node under a mouse, by Dear ImGui without a window.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/patch/node_panel.hpp"
#include "tools/window/patch/patch_panel.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

#include <algorithm>
#include <functional>

using namespace tactus;
using namespace tactus::run;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::voice;

namespace {

RunChoice choice_of(const Folder& folder, const std::string& text) {
    RunChoice choice;
    choice.patch = folder.write("outer.toml", text).string();
    choice.out = folder.path / "out";
    return choice;
}

/// A window with the picture of a patch on the left and the panel of a node on the right.
class Table {
public:
    explicit Table(const std::string& text) : bench(choice_of(folder, text)), panel(bench), node(bench) {
        context_ = ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(1500, 900);
        unsigned char* pixels = nullptr;
        int wide = 0, high = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
        frame();
        frame();
    }
    ~Table() { ImGui::DestroyContext(context_); }
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

    void frame() {
        ImGui::GetIO().DeltaTime = 0.3f;
        forget_spots();
        ImGui::NewFrame();
        ImFont* font = ImGui::GetFont();
        const Fonts fonts{font, font, font, 1.0};
        std::set<std::string> looked_at;
        place("patch", 0.0f, 900.0f, [&] { panel.draw(nullptr, fonts, looked_at); });
        place("node", 900.0f, 600.0f, [&] {
            if (shows_list) node.draw_catalogue(panel.selected);
            else node.draw_parameters(panel.selected, fonts);
        });
        ImGui::Render();
    }

    void move(Point to) {
        ImGui::GetIO().MousePos = vec(to);
        frame();
        frame();
    }
    void button(bool is_down) {
        ImGui::GetIO().MouseDown[0] = is_down;
        // What pops up is drawn in the second picture, and where it is, is known after that.
        for (int i = 0; i < 4; ++i) frame();
    }
    void click(Point at) {
        move(at);
        button(true);
        button(false);
    }
    void drag(Point from, Point to) {
        move(from);
        button(true);
        for (int i = 1; i <= 4; ++i) move(from + (to - from) * (i / 4.0));
        button(false);
    }
    Point at(const std::string& name) const {
        const auto found = panel.place_of(name);
        INFO(name);
        REQUIRE(found);
        return *found;
    }
    static Point spot_of(const std::string& name) {
        const auto found = spot(name);
        INFO(name);
        REQUIRE(found);
        return found->middle();
    }
    bool has(const std::string& part) const {
        std::string text = bench.editor().text();
        text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
                   text.end());
        return text.find(part) != std::string::npos;
    }
    /// Where the picture's units lie on the screen.
    Point screen(Point world) const {
        const PictureNode& one = bench.picture().nodes[0];
        const Point a{one.box.middle().x, one.box.top + 0.3 * title_height}, b = one.outputs[0].at;
        const Point on_a = at(one.name), on_b = at(one.name + "." + one.outputs[0].name);
        const double zoom = (on_b.x - on_a.x) / (b.x - a.x);
        return on_a + (world - a) * zoom;
    }
    const PictureNode& shown(const std::string& name) const {
        const int index = bench.picture().find(name);
        REQUIRE(index >= 0);
        return bench.picture().nodes[static_cast<std::size_t>(index)];
    }

    Folder folder;
    Workbench bench;
    PatchPanel panel;
    NodePanel node;
    bool shows_list = false;

private:
    static void place(const char* name, float left, float wide, const std::function<void()>& content) {
        ImGui::SetNextWindowPos(ImVec2(left, 0.0f));
        ImGui::SetNextWindowSize(ImVec2(wide, 900.0f));
        ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        content();
        ImGui::End();
    }

    ImGuiContext* context_;
};

const std::string two_levels = voice + R"([nodes.other]
type = "constant"
rate = "60 Hz"
)";

/// With the nodes where a test can point at them.
const std::string with_comment = voice + R"([window.places]
level = [20, 40]
[window.comments.why]
text = "why"
place = [400, -300]
size = [300, 120]
)";

}  // namespace

TEST_CASE("a click on an input changes nothing, also when the hand shakes") {
    Table table(voice);
    const Point at = table.at("loud.in") + Point{-4.0, 0.0};
    table.move(at);
    table.button(true);
    table.move(at + Point{-2.0, 1.0});
    table.button(false);
    CHECK(table.bench.editor().text() == voice);
    CHECK_FALSE(table.bench.editor().can_undo());
}

TEST_CASE("a wire is taken off its input and dropped on the ground to remove it, and led elsewhere by its source") {
    Table table(two_levels);
    const Point input = table.at("loud.factor"), source = table.at("level.value");
    table.drag(source + (input - source) * 0.06, table.at("other.value"));
    CHECK(table.has("other.value -> loud.factor"));
    CHECK_FALSE(table.has("level.value"));
    REQUIRE(table.bench.undo());
    CHECK_FALSE(table.bench.editor().can_undo());
    table.frame();
    table.drag(table.at("loud.factor"), table.screen({-30.0, -30.0}));
    CHECK_FALSE(table.has("-> loud.factor"));
}

TEST_CASE("a wire led onto a node asks for the parameter and is not removed") {
    Table table(voice);
    table.drag(table.at("loud.factor"), table.at("tone"));
    CHECK(table.bench.editor().text() == voice);
    table.click(Table::spot_of("drive amplitude"));
    CHECK(table.has("level.value -> tone.amplitude"));
    CHECK_FALSE(table.has("loud.factor"));
    CHECK(table.bench.undo());
    CHECK_FALSE(table.bench.editor().can_undo());
}

TEST_CASE("a comment is chosen by a click, takes what lies in it along, and goes by Del") {
    Table table(with_comment);
    const auto& comment = table.bench.window().comments;
    // Around the node 'level'.
    const Box box = table.shown("level").box;
    patch::PatchComment around = comment[0];
    around.place = {box.left - 40.0, box.top - 60.0};
    around.size = {box.width() + 80.0, box.height() + 90.0};
    REQUIRE(table.bench.comment(around));
    table.frame();
    const Box before = table.shown("level").box;
    const Point head = table.screen({before.left - 20.0, before.top - 50.0});
    table.click(head);
    CHECK(table.panel.chosen_comments == std::set<std::string>{"why"});
    CHECK(table.panel.has_chosen());
    const double first = comment[0].place.x;
    table.drag(head, head + Point{60.0, 0.0});
    const double moved = comment[0].place.x - first;
    CHECK(moved > 20.0);
    CHECK(table.shown("level").box.left - before.left == Approx(moved).margin(1.1));
    REQUIRE(table.bench.undo());
    table.frame();
    table.panel.chosen_comments = {"why"};
    table.panel.remove_chosen();
    CHECK(table.bench.window().comments.empty());
    CHECK(table.bench.picture().find("level") >= 0);
}

TEST_CASE("a frame drawn over empty ground chooses nodes and comments") {
    Table table(with_comment);
    patch::PatchComment comment = table.bench.window().comments[0];
    const Box all = table.bench.picture().bounds, loud = table.shown("loud").box;
    comment.place = {loud.right + 30.0, loud.top};
    comment.size = {90.0, 60.0};
    REQUIRE(table.bench.comment(comment));
    table.frame();
    table.drag(table.screen({all.left - 15.0, all.top - 10.0}), table.screen({loud.right + 50.0, all.bottom + 5.0}));
    CHECK(table.panel.chosen.size() == 3);
    CHECK(table.panel.chosen_comments.size() == 1);
    table.panel.choose_all();
    CHECK(table.panel.chosen_comments.size() == 1);
}

TEST_CASE("a new comment is the one that is written, whatever the others are called") {
    Table table(with_comment);
    table.panel.add_comment();
    table.frame();
    table.frame();
    table.frame();
    ImGui::GetIO().AddInputCharacter('X');
    table.frame();
    table.click(Table::spot_of("comment done"));
    table.frame();
    CHECK(table.has("[window.comments.why]\ntext = \"why\""));
    const auto& all = table.bench.window().comments;
    const auto note = std::ranges::find(all, "note", &patch::PatchComment::name);
    REQUIRE(note != all.end());
    CHECK(note->text.find('X') != std::string::npos);
}

TEST_CASE("with an open sub-patch the other nodes are moved and aligned") {
    Table table(voice);
    table.folder.write("ear.toml", "[inputs]\nsound = \"a.in\"\n[nodes.a]\ntype = \"gain\"\nrate = \"48 kHz\"\n");
    REQUIRE(table.bench.add_part(table.folder.path / "ear.toml", "") == "ear");
    REQUIRE(table.bench.connect("tone.signal", "ear.sound"));
    REQUIRE(table.bench.open_sub_patch("ear", true));
    table.frame();
    table.panel.choose_all();
    CHECK(table.panel.chosen.contains("ear:a"));
    table.panel.nudge({20.0, 0.0});
    CHECK(table.bench.window().places.size() == 3);
    table.frame();
    table.panel.align(PatchPanel::Align::top);
    CHECK_FALSE(table.bench.messages().back().is_problem);
    table.frame();
    table.panel.chosen = {"ear:a"};
    table.panel.selected = "ear:a";
    table.panel.nudge({20.0, 0.0});
    CHECK(table.bench.messages().back().text.find("within a sub-patch") != std::string::npos);
}

TEST_CASE("what is copied is pasted where the pointer is") {
    Table table(voice);
    table.panel.chosen = {"tone"};
    table.panel.selected = "tone";
    table.panel.copy();
    const Box box = table.shown("loud").box;
    const Point wanted{box.left + 300.0, box.top + 20.0};
    table.move(table.screen(wanted));
    table.panel.paste();
    table.frame();
    REQUIRE(table.bench.picture().find("tone_2") >= 0);
    CHECK(table.shown("tone_2").box.left == Approx(wanted.x).margin(2.0));
    CHECK(table.shown("tone_2").box.top == Approx(wanted.y).margin(2.0));
}

TEST_CASE("a type is dragged from the list into the patch, and the list is searched by other words for the same") {
    Table table(voice);
    table.shows_list = true;
    table.node.search = "device input";
    table.frame();
    table.frame();
    const Box box = table.shown("level").box;
    const Point ground = table.screen({box.right + 60.0, box.middle().y});
    table.drag(Table::spot_of("type device_input"), ground);
    REQUIRE(table.bench.picture().find("device_input") >= 0);
    CHECK(table.bench.window().places.contains("device_input"));
    CHECK(table.has("[nodes.device_input]\ntype = \"device_input\"\nrate = \"60 Hz\""));
    CHECK(table.panel.selected == "device_input");
}

TEST_CASE("a node dragged into another lane runs there when a person says so") {
    Table table(voice);
    const Box box = table.shown("loud").box;
    const Point there = table.screen({box.left + 40.0, box.bottom + 2.0});
    table.drag(table.at("level"), there);
    CHECK(table.bench.editor().text() == voice);
    table.click(Table::spot_of("leave in its lane"));
    CHECK(table.has("type = \"constant\"\nrate = \"60 Hz\""));
    CHECK(table.bench.window().places.contains("level"));
    REQUIRE(table.bench.undo());
    table.frame();
    table.drag(table.at("level"), there);
    table.click(Table::spot_of("run in the lane"));
    CHECK(table.has("type = \"constant\"\nrate = \"48 kHz\""));
    REQUIRE(table.bench.undo());
    CHECK_FALSE(table.bench.editor().can_undo());
}

TEST_CASE("the panel of a node changes its lane") {
    Table table(voice);
    table.click(table.at("level"));
    table.click(Table::spot_of("lane"));
    table.frame();
    table.click(Table::spot_of("lane 48 kHz"));
    CHECK(table.has("type = \"constant\"\nrate = \"48 kHz\""));
}

TEST_CASE("a device setting that is being typed is set when another node is clicked") {
    Table table(R"(wires = ["hand.pose -> ball.pose", "ball.wrench -> out.wrench"]
[devices.one]
driver = "simulated"
start_z = "60 mm"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
[nodes.out]
type = "device_output"
rate = "1 kHz"
)");
    table.click(table.at("hand"));
    table.frame();
    table.click(Table::spot_of("device start_z"));
    // Behind what is there.
    ImGui::GetIO().AddInputCharacter('m');
    table.frame();
    const std::size_t told = table.bench.messages().size();
    table.click(table.at("ball"));
    table.frame();
    // No such unit: the answer says so.
    CHECK(table.bench.messages().size() > told);
    CHECK(table.bench.messages().back().text.find("start_z") != std::string::npos);
}
