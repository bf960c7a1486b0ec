// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/elide.hpp"

#include "tests/support/catch.hpp"

#include <imgui.h>

using tactus::window::elided;

TEST_CASE("a text that is too long ends in an ellipsis within its width, and never within a character") {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(200.0f, 100.0f);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    ImGui::NewFrame();
    const auto wide = [](const std::string& text) { return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x); };
    const std::string name = "fragment_07, locked, µµµµ";
    CHECK(elided(name, wide(name)) == name);
    CHECK(elided(name, 500.0) == name);
    CHECK(elided("", 0.0).empty());
    for (double room = wide("…"); room < wide(name); room += 1.0) {
        const std::string part = elided(name, room);
        INFO(part);
        CHECK(wide(part) <= room);
        REQUIRE(part.ends_with("…"));
        const std::string begin = part.substr(0, part.size() - std::string("…").size());
        CHECK(name.starts_with(begin));
        CHECK((static_cast<unsigned char>(name[begin.size()]) & 0xC0u) != 0x80u);
    }
    CHECK(elided(name, 0.0) == "…");
    ImGui::EndFrame();
    ImGui::DestroyContext();
}
