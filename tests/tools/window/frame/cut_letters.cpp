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
#include <vector>

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

/// What is cut in a window that performs a script whose lines `letters NAME` keep the frames.
std::string cut_in(const VirtualDisplay& display, const Folder& folder, const std::string& arguments,
                   const std::string& script, const std::vector<std::string>& frames, const LetterWindow& window) {
    folder.write("script",
                 fmt::format("size {} {}\nframes 8\n", window.width, window.height) + script + "frames 3\nclose\n");
    const Outcome outcome =
        on(display, folder, fmt::format("{} --view-scale {} --view-script script", arguments, window.scale), 150);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 0);
    std::string cut;
    for (const std::string& frame : frames) {
        std::ifstream list(folder.path / frame);
        REQUIRE(list.good());
        for (std::string line; std::getline(list, line);)
            if (!is_on_canvas(line)) cut += frame + ": " + line + "\n";
    }
    return cut;
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

TEST_CASE("no border cuts a letter of menus, dialogs and panels in windows of any size", "[display]") {
    const VirtualDisplay display(1800, 1300);
    if (!display.is_there()) return skip("Xvfb is not installed (apt install xvfb)");
    for (const LetterWindow& window : letter_windows) {
        CAPTURE(window.width, window.height, window.scale);
        const Folder folder;
        folder.write("voice.toml", voice);
        CHECK(
            cut_in(display, folder, "view voice.toml",
                   "press tone\nframes 4\nletters patch\nkey ctrl+p\nframes 4\nletters commands\nkey escape\nframes 3\n"
                   "key f1\nframes 4\nletters help\nkey escape\nframes 3\nkey ctrl+o\nframes 5\nletters open\n"
                   "key escape\nframes 3\n",
                   {"patch", "commands", "help", "open"}, window) == "");
        CHECK(cut_in(display, folder, "view", "letters start\n", {"start"}, window) == "");
        tactus::plan::CasePlan plan = tactus::plan::load_case_plan(case_folder() / "case.plan.json");
        tactus::plan::make_files_absolute(plan, case_folder());
        tactus::plan::save_case_plan(plan, folder.path / "jaw.plan.json");
        // A small window has all menus in one.
        const std::string menu = window.width < 1000 * window.scale ? "Menu" : "File";
        CHECK(cut_in(display, folder, "view jaw.plan.json --layout plan",
                     "wait 6\nletters plan\nframes 3\npress " + menu + "\nframes 4\nletters menu\n", {"plan", "menu"},
                     window) == "");
    }
}
