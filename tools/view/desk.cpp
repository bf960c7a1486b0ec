// SPDX-License-Identifier: Apache-2.0
#include "tools/view/desk.hpp"

#include "tools/view/run_bar.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/state_banner.hpp"
#include "tools/view/theme.hpp"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace tactus::view {

Desk::Desk(Window& window, Workbench& bench, TakeBench* take)
    : questions(bench),
      window_(window),
      bench_(bench),
      take_(take),
      fonts_{window.body, window.bold, window.large, window.scale()},
      patch_(bench),
      nodes_(bench),
      scopes_(bench),
      scene_(bench),
      calibration_(bench, scene_) {
    patch_.is_read_only = nodes_.is_read_only = take != nullptr;
}

const Feed* Desk::feed() const {
    if (take_) return &take_->feed();
    return live_.get();
}

/// A new run resets everything that shows the previous run.
void Desk::follow_run() {
    if (take_) {
        take_->tend(static_cast<double>(ImGui::GetIO().DeltaTime));
        double longest = 0.1;
        for (const Scopes::Scope& scope : scopes_.list()) longest = std::max(longest, scope.span);
        take_->feed().traced_s = longest;
        take_->feed().follow(looked_at_, scopes_.traced());
        return;
    }
    bench_.tend();
    if (runs_ != bench_.runs()) {
        runs_ = bench_.runs();
        live_ = bench_.observer() ? std::make_unique<LiveFeed>(bench_.observer()) : nullptr;
    }
    if (!live_) return;
    live_->set_now(bench_.status()->time);
    std::set<std::string> traced = scopes_.traced();
    calibration_.add_traced(traced);
    live_->follow(looked_at_, traced);
}

void Desk::panel(const char* id, double width, double height) {
    ImGui::BeginChild(
        id, vec({width, height}), false,
        ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_AlwaysUseWindowPadding);
}

void Desk::splitter(const char* id, bool upright, double height, double& share, double whole) {
    const double thick = 6.0 * fonts_.scale;
    if (upright) ImGui::SameLine(0.0f, 0.0f);
    const Point size =
        upright ? Point{thick, height} : Point{static_cast<double>(ImGui::GetContentRegionAvail().x), thick};
    ImGui::InvisibleButton(id, vec({std::max(size.x, 1.0), std::max(size.y, 1.0)}));
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    if (ImGui::IsItemActive()) {
        const ImVec2 by = ImGui::GetIO().MouseDelta;
        share = std::clamp(share + static_cast<double>(upright ? by.x : by.y) / std::max(whole, 1.0), 0.15, 0.85);
    }
    if (upright) ImGui::SameLine(0.0f, 0.0f);
}

void Desk::show_messages(double height) {
    ImGui::BeginChild("messages", vec({0.0, height}));
    const auto& all = bench_.messages();
    for (std::size_t i = all.size() > 60 ? all.size() - 60 : 0; i < all.size(); ++i) {
        ImGui::PushStyleColor(ImGuiCol_Text, all[i].is_problem ? tone::bad : tone::dim);
        ImGui::TextWrapped("%s", all[i].text.c_str());
        ImGui::PopStyleColor();
    }
    static std::size_t seen = 0;
    if (seen != all.size()) ImGui::SetScrollHereY(1.0f);
    seen = all.size();
    ImGui::EndChild();
}

void Desk::shortcuts() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    const auto pressed = [](char key) { return ImGui::IsKeyPressed(key, false); };
    if (io.KeyCtrl && pressed('Z')) io.KeyShift ? bench_.redo() : bench_.undo();
    if (io.KeyCtrl && pressed('Y')) bench_.redo();
    if (io.KeyCtrl && pressed('S') && !take_) bench_.save();
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Space), false)) {
        if (take_) take_->play(!take_->is_playing());
        else bench_.pause(bench_.status()->state == RunStatus::State::runs);
    }
}

void Desk::ask_farewell() {
    if (farewell == Farewell::asks && !ImGui::IsPopupOpen("The patch is still running"))
        ImGui::OpenPopup("The patch is still running");
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal("The patch is still running", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::Text("The window is closing. Continue the run?");
    const auto choose = [&](const char* label, Farewell what) {
        if (!ImGui::Button(label)) return;
        farewell = what;
        ImGui::CloseCurrentPopup();
    };
    choose("End it", Farewell::ends);
    ImGui::SameLine();
    choose("Continue the run", Farewell::goes_on);
    ImGui::SameLine();
    choose("Keep the window", Farewell::none);
    if (farewell == Farewell::none) bench_.want_edits();
    ImGui::EndPopup();
}

void Desk::draw_scene(double height) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({6.0 * fonts_.scale, 6.0 * fonts_.scale}));
    panel("scene", 0.0, scene_height_ * height);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({6.0 * fonts_.scale, 4.0 * fonts_.scale}));
    scene_.draw(take_ ? take_->scene() : bench_.observer(), fonts_);
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    splitter("between scene and node", false, 0.0, scene_height_, height);
}

void Desk::draw() {
    follow_run();
    scene_.hand().begin_picture();
    looked_at_.clear();
    fonts_ = {window_.body, window_.bold, window_.large, window_.scale()};
    forget_spots();
    ImGui::NewFrame();
    ImGui::PushFont(fonts_.body);
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos(viewport->Pos);
    ImGui::SetNextWindowSize(viewport->Size);
    ImGui::Begin("desk", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
    shortcuts();
    run_bar(bench_, take_, fonts_);
    const Point below_bar = point(ImGui::GetCursorScreenPos());
    const double gap = 6.0 * fonts_.scale, messages = 38.0 * fonts_.scale;
    const double width = static_cast<double>(ImGui::GetContentRegionAvail().x);
    const double height = static_cast<double>(ImGui::GetContentRegionAvail().y) - messages - 2.0 * gap;
    const double left = left_ * width;

    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 0.0f));
    ImGui::BeginChild("left", vec({left, height}));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
    // Without scopes the patch panel uses their space.
    const double bar = 64.0 * fonts_.scale;
    panel("patch", 0.0, scopes_.list().empty() ? std::max(height - bar, 0.5 * height) : patch_height_ * height);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({8.0 * fonts_.scale, 6.0 * fonts_.scale}));
    patch_.draw(feed(), fonts_, looked_at_);
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    splitter("between patch and scopes", false, 0.0, patch_height_, height);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({6.0 * fonts_.scale, 6.0 * fonts_.scale}));
    ImGui::BeginChild("scopes", ImVec2(0, 0), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({6.0 * fonts_.scale, 4.0 * fonts_.scale}));
    if (!patch_.wants_scope.empty()) scopes_.add(std::exchange(patch_.wants_scope, {}));
    scopes_.draw(feed(), fonts_);
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::EndChild();
    scene_.hand().beat();
    splitter("between left and right", true, height, left_, width);
    ImGui::BeginChild("right", vec({0.0, height}));
    // Without a scene the node panel uses its space.
    if (scene_.is_empty()) scene_.rest();
    else draw_scene(height);
    scene_.hand().beat();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec({8.0 * fonts_.scale, 6.0 * fonts_.scale}));
    ImGui::BeginChild("node", ImVec2(0, 0), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({8.0 * fonts_.scale, 5.0 * fonts_.scale}));
    if (ImGui::BeginTabBar("tabs")) {
        const auto tab = [](const char* label, ImGuiTabItemFlags flags) {
            const bool is_open = ImGui::BeginTabItem(label, nullptr, flags);
            mark_spot(label);
            return is_open;
        };
        if (tab("Node", 0)) {
            nodes_.draw_parameters(patch_.selected, fonts_);
            ImGui::EndTabItem();
        }
        if (!scene_.is_empty() && tab("Scene", 0)) {
            scene_.draw_tree();
            ImGui::EndTabItem();
        }
        const ImGuiTabItemFlags front = nodes_.wants_catalogue ? ImGuiTabItemFlags_SetSelected : 0;
        nodes_.wants_catalogue = false;
        if (tab("Add a node", front)) {
            nodes_.draw_catalogue(patch_.selected, fonts_);
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::PopStyleVar();
    ImGui::Dummy(vec({1.0, gap}));
    show_messages(messages);
    ask_farewell();
    // One dialog at a time.
    if (farewell != Farewell::asks) questions.draw();
    ImGui::End();
    if (!take_) state_banner(bench_, below_bar, fonts_);
    if (std::exchange(scene_.wants_calibration, false)) calibration_.is_open = true;
    calibration_.draw(live_.get());
    ImGui::PopFont();
}

}  // namespace tactus::view
