// SPDX-License-Identifier: Apache-2.0
// Text has room in every window: no border cuts a letter where nothing scrolls.
#include "tools/window/frame/cut_letters.hpp"

#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "tests/tools/jaw_case.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/window/on_display.hpp"

#include <imgui.h>

#include <fstream>
#include <functional>
#include <string>

using namespace tactus::test;

namespace {

struct LetterWindow {
    int width, height;
    double scale;
};
constexpr LetterWindow letter_windows[] = {{800, 600, 1.0}, {1280, 800, 1.0}, {1600, 1200, 2.0}};

/// The canvas of the patch and those of curves are moved by the mouse: their borders cut what lies on them.
bool is_on_canvas(const std::string& line) {
    return line.find("/patch_") != std::string::npos || line.find("/scopes_") != std::string::npos;
}

/// Lines of a script that give the window each of the sizes in turn and perform `lines` in it. In them `@` is the name of the
/// size, so that `letters menu-@` keeps the frame of each size, and `$` is the first menu: a small window has all in one.
std::string at_each_size(const std::string& lines) {
    std::string script;
    for (const LetterWindow& window : letter_windows) {
        script += fmt::format("scale {}\nsize {} {}\nframes 8\n", window.scale, window.width, window.height);
        for (const char c : lines) {
            if (c == '@') script += std::to_string(window.width);
            else if (c == '$') script += window.width < 1000 * window.scale ? "Menu" : "File";
            else script += c;
        }
    }
    return script;
}

}  // namespace

TEST_CASE("letters that a border cuts are found where nothing scrolls, and only there") {
    const Folder folder;
    const auto cut_by = [&](const std::function<void()>& contents) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(400.0f, 300.0f);
        unsigned char* pixels = nullptr;
        int wide = 0, high = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
        for (int frame = 0; frame < 3; ++frame) {
            ImGui::NewFrame();
            ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
            ImGui::SetNextWindowSize(io.DisplaySize);
            ImGui::Begin("all", nullptr, ImGuiWindowFlags_NoDecoration);
            contents();
            ImGui::End();
            tactus::window::want_cut_letters(folder.path / "letters");
            ImGui::Render();
            tactus::window::write_cut_letters();
        }
        ImGui::DestroyContext();
        return slurp(folder.path / "letters");
    };
    CHECK(cut_by([] { ImGui::Button("fits"); }) == "");
    // By the button itself, and by the border of a panel.
    CHECK(cut_by([] { ImGui::Button("has no room", ImVec2(43.0f, 0.0f)); }) != "");
    const auto in_panel = [](ImGuiWindowFlags flags) {
        return [flags] {
            ImGui::BeginChild("panel", ImVec2(64.0f, 30.0f), true, flags);
            ImGui::Text("a text that has no room");
            ImGui::EndChild();
        };
    };
    CHECK(cut_by(in_panel(ImGuiWindowFlags_NoScrollbar)) != "");
    CHECK(cut_by(in_panel(ImGuiWindowFlags_HorizontalScrollbar)) == "");
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("no border cuts a letter of menus, dialogs and panels in windows of any size", "[display]") {
    const VirtualDisplay display(1800, 1300);
    if (!display.is_there()) return skip("Xvfb is not installed (apt install xvfb)");
    const Folder folder;
    folder.write("voice.toml", voice);
    tactus::plan::CasePlan plan = tactus::plan::load_case_plan(case_folder() / "case.plan.json");
    tactus::plan::make_files_absolute(plan, case_folder());
    tactus::plan::save_case_plan(plan, folder.path / "jaw.plan.json");
    folder.write(
        "script",
        at_each_size("letters start-@\nframes 3\n") + "open voice.toml\nframes 5\npress tone\n" +
            at_each_size("letters patch-@\nkey ctrl+p\nframes 4\nletters commands-@\nkey escape\nframes 3\n"
                         "key f1\nframes 4\nletters help-@\nkey escape\nframes 3\nkey ctrl+o\nframes 5\n"
                         "letters open-@\nkey escape\nframes 3\n") +
            "open jaw.plan.json\nlayout plan\nwait 4\n" +
            at_each_size(
                "letters plan-@\nframes 3\npress $\nframes 4\nletters menu-@\nframes 3\nkey escape\nframes 3\n") +
            "close\n");
    const Outcome outcome = on(display, folder, "view --view-scale 1 --view-script script", 150);
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.code == 0);
    for (const LetterWindow& window : letter_windows) {
        for (const char* shown : {"start", "patch", "commands", "help", "open", "plan", "menu"}) {
            const std::string frame = fmt::format("{}-{}", shown, window.width);
            CAPTURE(frame);
            std::ifstream list(folder.path / frame);
            REQUIRE(list.good());
            for (std::string line; std::getline(list, line);)
                if (!is_on_canvas(line)) FAIL_CHECK(line);
        }
    }
}
