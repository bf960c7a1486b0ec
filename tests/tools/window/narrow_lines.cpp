// SPDX-License-Identifier: Apache-2.0
// Lines of controls in narrow windows, drawn without a display.
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/desk/run_bar.hpp"
#include "tools/window/signal/scopes.hpp"
#include "tools/window/widgets/spots.hpp"

#include <imgui.h>

#include <functional>

using namespace tactus;
using namespace tactus::window;

namespace {

/// Draws a few frames of one window that fills so many pixels, with letters as wide as the window's.
void draw(float width, float height, const std::function<void(const Fonts&)>& contents) {
    ImGuiContext* const context = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(width, height);
    ImFontConfig config;
    config.SizePixels = 15.0f;
    ImFont* const font = io.Fonts->AddFontDefault(&config);
    unsigned char* pixels = nullptr;
    int wide = 0, high = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
    for (int frame = 0; frame < 3; ++frame) {
        forget_spots();
        ImGui::NewFrame();
        ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
        ImGui::SetNextWindowSize(io.DisplaySize);
        ImGui::Begin("all", nullptr, ImGuiWindowFlags_NoDecoration);
        contents({font, font, font, 1.0});
        ImGui::End();
        ImGui::Render();
    }
    ImGui::DestroyContext(context);
}

struct OneNumber : Feed {
    std::vector<Port> ports() const override { return {{"a.out", &value::number, 1000.0}}; }
    double now() const override { return 0.0; }
    void follow(const std::set<std::string>&, const std::set<std::string>&) override {}
    Latest latest(const std::string&) const override { return {}; }
    const Trace* trace(const std::string&) const override { return &empty; }
    Trace empty;
};

run::RunChoice voice_in(const test::Folder& folder, const std::string& title) {
    run::RunChoice choice;
    std::string text = test::voice;
    text.replace(text.find("title = \"voice\""), 15, "title = \"" + title + "\"");
    choice.patch = folder.write("voice.toml", text).string();
    choice.out = folder.path / "out";
    return choice;
}

}  // namespace

TEST_CASE("a scope in the column of a small window is closed and saved by its own line") {
    const test::Folder folder;
    Workbench bench(voice_in(folder, "voice"));
    Scopes scopes(bench);
    scopes.add("a.out");
    const OneNumber feed;
    for (const float width : {430.0f, 490.0f, 620.0f, 1000.0f}) {
        draw(width, 300.0f, [&](const Fonts& fonts) { scopes.draw(&feed, fonts); });
        CAPTURE(width);
        for (const char* what : {"scope 0 close", "scope 0 PNG", "scope 0 CSV", "scope 0 options", "scope 0 kind"}) {
            INFO(what);
            const auto place = spot(what);
            REQUIRE(place);
            CHECK(place->left >= 0.0);
            CHECK(place->right <= static_cast<double>(width));
        }
        CHECK(spot("scope 0 freeze").has_value() == (width > 600.0f));
    }
}

TEST_CASE("the history of faults has its place beside a long title, and stays when the run is over") {
    const test::Folder folder;
    Workbench bench(voice_in(folder, "A title that is as long as the bar of a small window would let it be"));
    for (const auto state : {RunStatus::State::runs, RunStatus::State::over}) {
        RunStatus status;
        status.state = state;
        status.faults.push_back({"hand", "no force arrived in time", 1.6, 2.7, 4.25});
        draw(800.0f, 100.0f, [&](const Fonts& fonts) { run_bar(bench, status, nullptr, {}, fonts); });
        CAPTURE(static_cast<int>(state));
        const auto faults = spot("faults"), undo = spot("Undo"), save = spot("Saved"), record = spot("record");
        REQUIRE((faults && undo && save && record));
        CHECK(record->right <= faults->left);
        CHECK(faults->right <= undo->left);
        CHECK(save->right <= 800.0);
    }
}
