// SPDX-License-Identifier: Apache-2.0
#include <GL/glcorearb.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "tools/window/files/start_page.hpp"

#include "devices/display/read_png.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/frame/tooltip.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr double card_width = 200.0, picture_height = 125.0, card_height = 150.0;

template <class F>
F function(const char* name) {
    return reinterpret_cast<F>(glfwGetProcAddress(name));
}

std::uint32_t upload(const display::Image& image) {
    GLuint texture = 0;
    function<PFNGLGENTEXTURESPROC>("glGenTextures")(1, &texture);
    function<PFNGLBINDTEXTUREPROC>("glBindTexture")(GL_TEXTURE_2D, texture);
    const auto set = function<PFNGLTEXPARAMETERIPROC>("glTexParameteri");
    set(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    set(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    function<PFNGLPIXELSTOREIPROC>("glPixelStorei")(GL_UNPACK_ALIGNMENT, 1);
    function<PFNGLTEXIMAGE2DPROC>("glTexImage2D")(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB,
                                                  GL_UNSIGNED_BYTE, image.rgb.data());
    return texture;
}

}  // namespace

StartPage::~StartPage() {
    if (!glfwGetCurrentContext()) return;
    for (const auto& [path, texture] : textures_)
        if (texture) function<PFNGLDELETETEXTURESPROC>("glDeleteTextures")(1, &texture);
}

void StartPage::open() {
    std::error_code ignored;
    all_ = start_list(run::library_folder(), fs::current_path(ignored), memory_.recent());
    is_open = true;
}

std::uint32_t StartPage::texture_of(const StartItem& item) {
    if (item.picture.empty()) return 0;
    const auto [at, is_new] = textures_.emplace(item.picture.string(), 0);
    if (is_new) try {
            at->second = upload(display::read_png(item.picture.string()));
        } catch (const Error&) {
            // The graph is drawn instead.
        }
    return at->second;
}

/// One new graph per frame: compiling some patches takes a while.
const PatchPicture* StartPage::graph_of(const StartItem& item) {
    const auto [at, is_new] = graphs_.emplace(item.path.string(), nullptr);
    if (is_new) try {
            patch::Problems problems;
            run::PatchChoice choice;
            choice.patch = item.path.string();
            if (const auto plan = run::read_plan(choice, problems))
                at->second = std::make_unique<PatchPicture>(picture_of(*plan));
        } catch (const std::exception&) {
            // Opening it says what is wrong.
        }
    return at->second.get();
}

void StartPage::list(const char* title, const std::vector<StartItem>& items) {
    if (items.empty()) return;
    ImGui::Spacing();
    ImGui::TextDisabled("%s", title);
    int i = 0;
    for (const StartItem& item : items) {
        ImGui::PushID(title);
        ImGui::PushID(i++);
        if (ImGui::Selectable(item.title.c_str())) chosen = item.path;
        mark_spot(std::string(title) + " " + item.title);
        if (ImGui::IsItemHovered()) show_tooltip(item.path);
        ImGui::PopID();
        ImGui::PopID();
    }
}

void StartPage::lists(const Fonts& fonts) {
    ImGui::PushFont(fonts.large);
    ImGui::TextUnformatted("Tactus");
    ImGui::PopFont();
    const ImVec2 wide(-1.0f, 1.6f * ImGui::GetFrameHeight());
    if (ImGui::Button("New patch", wide)) wants_new = true;
    mark_spot("New patch");
    if (ImGui::IsItemHovered()) show_tooltip("an empty canvas (Ctrl+N)");
    if (ImGui::Button("Open...", wide)) wants_dialog = true;
    mark_spot("Open...");
    if (ImGui::IsItemHovered()) show_tooltip("a patch or a take (Ctrl+O); a file may also be dropped on the window");
    list("opened last", all_.recent);
    list("takes here", all_.takes);
    list("plans here", all_.plans);
}

void StartPage::card(const StartItem& item, Point corner, Point size, const Fonts& fonts) {
    const Painter paint(ImGui::GetWindowDrawList(), fonts);
    const double s = fonts.scale;
    const Box picture{corner.x, corner.y, corner.x + size.x, corner.y + picture_height * s};
    paint.box(picture, colour(0x0c1015), 4.0 * s);
    if (const std::uint32_t texture = texture_of(item))
        ImGui::GetWindowDrawList()->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)),
                                             vec({picture.left, picture.top}), vec({picture.right, picture.bottom}));
    else if (const PatchPicture* graph = graph_of(item)) {
        Canvas canvas;
        canvas.fit(graph->bounds, picture.width(), picture.height());
        const auto at = [&](Point world) { return canvas.to_pixel(world) + Point{picture.left, picture.top}; };
        for (const PictureWire& wire : graph->wires)
            for (const BezierCurve& piece : wire.way)
                paint.list()->AddBezierCubic(vec(at(piece[0])), vec(at(piece[1])), vec(at(piece[2])), vec(at(piece[3])),
                                             faded(tone::dim, 0.7), 1.0f, 12);
        for (const PictureNode& node : graph->nodes) {
            const Point low = at({node.box.left, node.box.top}), high = at({node.box.right, node.box.bottom});
            paint.box({low.x, low.y, high.x, high.y}, tone::node_edge, 2.0);
        }
    }
    paint.text({corner.x + 4.0 * s, picture.bottom + 4.0 * s}, 14.0 * s, tone::text,
               paint.shortened(item.title, 14.0 * s, size.x - 8.0 * s, true), true);
}

void StartPage::keys(int columns) {
    const int count = static_cast<int>(all_.examples.size());
    if (count == 0 || ImGui::GetIO().WantTextInput) return;
    const auto pressed = [](ImGuiKey_ key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    int by = 0;
    if (pressed(ImGuiKey_RightArrow)) ++by;
    if (pressed(ImGuiKey_LeftArrow)) --by;
    if (pressed(ImGuiKey_DownArrow)) by += columns;
    if (pressed(ImGuiKey_UpArrow)) by -= columns;
    if (by != 0) {
        marked_ = std::clamp(marked_ + by, 0, count - 1);
        follows_mark_ = true;
    }
    if (pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter))
        chosen = all_.examples[static_cast<std::size_t>(marked_)].path;
}

void StartPage::examples(const Fonts& fonts) {
    const double s = fonts.scale, gap = 12.0 * s;
    const double wide = static_cast<double>(ImGui::GetContentRegionAvail().x);
    const int columns = std::max(1, static_cast<int>((wide + gap) / (card_width * s + gap)));
    const Point size{std::min(card_width * s, wide), card_height * s};
    ImGui::TextDisabled("examples");
    if (all_.examples.empty())
        ImGui::TextWrapped("There is no library in %s; build the target 'bundled_library'.",
                           run::library_folder().c_str());
    if (!ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) keys(columns);
    for (std::size_t i = 0; i < all_.examples.size(); ++i) {
        const StartItem& item = all_.examples[i];
        if (static_cast<int>(i) % columns != 0) ImGui::SameLine(0.0f, static_cast<float>(gap));
        const Point corner = point(ImGui::GetCursorScreenPos());
        ImGui::PushID(item.note.c_str());
        const bool pressed = ImGui::InvisibleButton("card", vec(size));
        ImGui::PopID();
        mark_spot("example " + item.note);
        if (ImGui::IsItemVisible()) card(item, corner, size, fonts);
        const bool is_marked = static_cast<int>(i) == marked_;
        if (is_marked && std::exchange(follows_mark_, false)) ImGui::SetScrollHereY();
        if (ImGui::IsItemHovered() || is_marked)
            Painter(ImGui::GetWindowDrawList(), fonts)
                .frame({corner.x - 2.0, corner.y - 2.0, corner.x + size.x + 2.0, corner.y + size.y},
                       ImGui::IsItemHovered() ? tone::text : tone::chosen, 4.0 * s, 2.0);
        if (pressed) chosen = item.path;
    }
}

void StartPage::draw(const Fonts& fonts) {
    const double s = fonts.scale;
    const double wide = static_cast<double>(ImGui::GetContentRegionAvail().x);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({12.0 * s, 10.0 * s}));
    ImGui::BeginChild("start lists", vec({std::clamp(0.25 * wide, 190.0 * s, 320.0 * s), 0.0}), false,
                      ImGuiWindowFlags_AlwaysUseWindowPadding);
    lists(fonts);
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("start examples", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    examples(fonts);
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

}  // namespace tactus::window
