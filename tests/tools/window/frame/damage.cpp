// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/damage.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <vector>

using namespace tactus::window;

namespace {

constexpr int width = 300, height = 200;
const auto fonts = reinterpret_cast<ImTextureID>(std::uintptr_t{7});
const auto scene = reinterpret_cast<ImTextureID>(std::uintptr_t{9});

/// Dear ImGui without a window.
struct Gui {
    Gui() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(width, height);
        io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
        unsigned char* pixels = nullptr;
        int wide = 0, high = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
        io.Fonts->SetTexID(fonts);
    }
    ~Gui() { ImGui::DestroyContext(); }
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    const ImDrawData& picture(const std::function<void(ImDrawList&)>& content) {
        ImGui::GetIO().DeltaTime = 0.01f;
        ImGui::NewFrame();
        content(*ImGui::GetBackgroundDrawList());
        ImGui::Render();
        return *ImGui::GetDrawData();
    }
};

using Corners = std::vector<ImDrawVert>;

/// What is drawn on one pixel, in order, as far as bounding boxes tell.
std::vector<Corners> drawn_on(const ImDrawData& picture, int x, int y) {
    std::vector<Corners> all;
    for (int l = 0; l < picture.CmdListsCount; ++l)
        for (const ImDrawCmd& command : picture.CmdLists[l]->CmdBuffer) {
            // The scissor of Dear ImGui's backend, which counts from below.
            const ImVec4& clip = command.ClipRect;
            const int left = static_cast<int>(clip.x), low = static_cast<int>(height - clip.w);
            const int up = height - 1 - y;
            if (x < left || x >= left + static_cast<int>(clip.z - clip.x) || up < low ||
                up >= low + static_cast<int>(clip.w - clip.y))
                continue;
            const ImDrawList& list = *picture.CmdLists[l];
            for (unsigned i = 0; i < command.ElemCount; i += 3) {
                Corners corners;
                for (unsigned c = 0; c < 3; ++c)
                    corners.push_back(list.VtxBuffer[static_cast<int>(
                        command.VtxOffset + list.IdxBuffer[static_cast<int>(command.IdxOffset + i + c)])]);
                const auto [first, last] = std::ranges::minmax(corners, {}, [](const auto& v) { return v.pos.x; });
                const auto [top, bottom] = std::ranges::minmax(corners, {}, [](const auto& v) { return v.pos.y; });
                const auto px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
                if (px >= first.pos.x && px <= last.pos.x && py >= top.pos.y && py <= bottom.pos.y)
                    all.push_back(corners);
            }
        }
    return all;
}

bool same(const std::vector<Corners>& a, const std::vector<Corners>& b) {
    return std::ranges::equal(a, b, [](const Corners& x, const Corners& y) {
        return std::memcmp(x.data(), y.data(), 3 * sizeof(ImDrawVert)) == 0;
    });
}

int boxes_at(const std::vector<PixelBox>& boxes, int x, int y) {
    return static_cast<int>(std::ranges::count_if(
        boxes, [&](const PixelBox& b) { return x >= b.left && x < b.right && y >= b.top && y < b.bottom; }));
}

void panels(ImDrawList& list, const char* number, float at) {
    list.AddRectFilled(ImVec2(0, 0), ImVec2(width, height), 0xff202020);
    list.AddRectFilled(ImVec2(20, 20), ImVec2(140, 180), 0xff404040, 6.0f);
    list.PushClipRect(ImVec2(30.5f, 30.5f), ImVec2(130.25f, 90.75f));
    list.AddText(ImVec2(35, 40), 0xffffffff, number);
    list.AddText(ImVec2(35, 60), 0xffffffff, "a text that stays, and is longer than its place");
    list.PopClipRect();
    list.AddLine(ImVec2(160, 20), ImVec2(160 + at, 100), 0xff00ff00, 2.0f);
}

}  // namespace

TEST_CASE("of a picture of the window only the places that differ are drawn again, and with all that lies there") {
    Gui gui;
    Damage damage;
    const std::vector<PixelBox> all =
        damage.find(gui.picture([](auto& l) { panels(l, "1.00", 0); }), width, height, fonts);
    CHECK(all == std::vector<PixelBox>{{0, 0, width, height}});
    CHECK(damage.find(gui.picture([](auto& l) { panels(l, "1.00", 0); }), width, height, fonts).empty());

    std::vector<std::vector<Corners>> before;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) before.push_back(drawn_on(*ImGui::GetDrawData(), x, y));
    const ImDrawData& next = gui.picture([](auto& l) { panels(l, "1.07", 40); });
    const std::vector<PixelBox> boxes = damage.find(next, width, height, fonts);
    const ImDrawData& part = damage.part();
    int drawn = 0, wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto now = drawn_on(next, x, y), in_part = drawn_on(part, x, y);
            const int covered = boxes_at(boxes, x, y);
            drawn += covered;
            wrong += covered > 1;
            wrong += covered == 0 && !same(now, before[static_cast<std::size_t>(y * width + x)]);
            wrong += covered == 0 && !in_part.empty();
            wrong += covered == 1 && !same(now, in_part);
        }
    CHECK(wrong == 0);
    CHECK(drawn > 0);
    CHECK(drawn < width * height / 3);
}

TEST_CASE("a texture counts as changed until somebody says that it is the same as before") {
    Gui gui;
    Damage damage;
    const auto draw = [&](std::optional<std::uint64_t> version) {
        forget_versions();
        if (version) say_version(9, *version);
        return damage.find(gui.picture([](ImDrawList& l) {
            panels(l, "1", 0);
            l.AddImage(scene, ImVec2(192, 96), ImVec2(256, 128));
        }),
                           width, height, fonts);
    };
    draw(3);
    CHECK(draw(3).empty());
    CHECK(draw(4) == std::vector<PixelBox>{{192, 96, 256, 128}});
    CHECK(draw(4).empty());
    CHECK_FALSE(draw({}).empty());
    CHECK_FALSE(draw({}).empty());
}

TEST_CASE("what comes on top or goes away again, another size, and corners that are no numbers, are seen") {
    Gui gui;
    Damage damage;
    const auto draw = [&](bool has_menu, int wide = width, float corner = 10.0f) {
        return damage.find(gui.picture([&](ImDrawList& l) {
            panels(l, "1", 0);
            if (has_menu) l.AddRectFilled(ImVec2(200, 100), ImVec2(240, 140), 0x80ffffff);
            if (!(corner == 10.0f)) l.AddTriangleFilled(ImVec2(corner, 0), ImVec2(5, 5), ImVec2(0, corner), 0xff0000ff);
        }),
                           wide, height, fonts);
    };
    draw(false);
    const auto opened = draw(true), closed = draw(false);
    CHECK(boxes_at(opened, 220, 120) == 1);
    CHECK(closed == opened);
    CHECK(draw(false, width - 40) == std::vector<PixelBox>{{0, 0, width - 40, height}});
    for (const float corner : {NAN, INFINITY, -INFINITY, 1e30f}) draw(false, width, corner);
    damage.part();
    damage.forget();
    CHECK(draw(false) == std::vector<PixelBox>{{0, 0, width, height}});
    CHECK(draw(false).empty());
}
