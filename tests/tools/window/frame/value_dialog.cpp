// SPDX-License-Identifier: Apache-2.0
// The dialog for a value, by Dear ImGui without a window.
#include "tools/window/frame/value_dialog.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::window;

namespace {

constexpr int enter = 257, escape = 256;

/// A window with nothing but the dialog, and a keyboard.
class Keyboard {
public:
    Keyboard() : before_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()) {
        ImGui::SetCurrentContext(own_);
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(800, 600);
        io.KeyMap[ImGuiKey_Enter] = enter;
        io.KeyMap[ImGuiKey_Escape] = escape;
        unsigned char* pixels = nullptr;
        int wide = 0, high = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
        frames(2);
    }
    ~Keyboard() {
        ImGui::DestroyContext(own_);
        ImGui::SetCurrentContext(before_);
        forget_spots();
        forget_spots();
    }
    Keyboard(const Keyboard&) = delete;
    Keyboard& operator=(const Keyboard&) = delete;

    void frames(int count) {
        for (int i = 0; i < count; ++i) {
            ImGui::GetIO().DeltaTime = 0.02f;
            forget_spots();
            ImGui::NewFrame();
            ImGui::Begin("all");
            dialog.draw();
            ImGui::End();
            ImGui::Render();
        }
        forget_spots();
    }
    void type(const std::string& text) {
        ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
        frames(2);
    }
    void tap(int key) {
        ImGui::GetIO().KeysDown[key] = true;
        frames(2);
        ImGui::GetIO().KeysDown[key] = false;
        frames(3);
    }

    ValueDialog dialog;

private:
    ImGuiContext *before_, *own_;
};

}  // namespace

TEST_CASE("a value that is refused stays in its dialog with the reason until it is mended") {
    Keyboard keyboard;
    std::vector<std::string> taken;
    keyboard.dialog.ask({"cursor A", "3 s", [&](const std::string& typed) {
                             if (typed != "80 ms") throw Error("'" + typed + "' cannot be");
                             taken.push_back(typed);
                         }});
    keyboard.frames(3);
    REQUIRE(spot("value"));
    // What is there is chosen as a whole: typed letters replace it.
    keyboard.type("9 N");
    keyboard.tap(enter);
    CHECK(spot("value"));
    CHECK(spot("value refused"));
    CHECK(taken.empty());
    keyboard.type("80 ms");
    keyboard.tap(enter);
    CHECK(taken == std::vector<std::string>{"80 ms"});
    CHECK_FALSE(spot("value"));
}

TEST_CASE("Escape leaves the dialog for a value and takes nothing") {
    Keyboard keyboard;
    bool is_taken = false;
    keyboard.dialog.ask({"cursor A", "3 s", [&](const std::string&) { is_taken = true; }});
    keyboard.frames(3);
    REQUIRE(spot("value"));
    keyboard.tap(escape);
    CHECK_FALSE(spot("value"));
    CHECK_FALSE(is_taken);
}
