// SPDX-License-Identifier: Apache-2.0
// The panels of the window in their columns.
#include "tools/window/desk/desk.hpp"
#include "tools/window/frame/layout_text.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

/// A child window of a panel, with the distances of its contents.
class PanelFrame {
public:
    PanelFrame(const char* id, double height, Point padding, Point spacing, bool scrolls) {
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, vec(padding));
        const ImGuiWindowFlags still = ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar;
        ImGui::BeginChild(id, vec({0.0, height}), false,
                          ImGuiWindowFlags_AlwaysUseWindowPadding | (scrolls ? ImGuiWindowFlags_None : still));
        const Point at = point(ImGui::GetWindowPos()), far = at + point(ImGui::GetWindowSize());
        set_spot(std::string("panel ") + id, {at.x, at.y, far.x, far.y});
        // Of the panel, not of what pops up from it.
        ImGui::PopStyleVar();
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec(spacing));
    }
    ~PanelFrame() {
        ImGui::PopStyleVar();
        ImGui::EndChild();
    }
    PanelFrame(const PanelFrame&) = delete;
    PanelFrame& operator=(const PanelFrame&) = delete;
};

bool has_same_panels(const std::vector<LayoutColumn>& a, const std::vector<LayoutColumn>& b) {
    return std::ranges::equal(a, b, [](const LayoutColumn& x, const LayoutColumn& y) {
        return std::ranges::equal(x.panels, y.panels, {}, &PanelPlace::panel, &PanelPlace::panel);
    });
}

}  // namespace

double Desk::splitter(const std::string& id, bool upright, double height) {
    const double thick = 6.0 * fonts_.scale;
    if (upright) ImGui::SameLine(0.0f, 0.0f);
    const Point size =
        upright ? Point{thick, height} : Point{static_cast<double>(ImGui::GetContentRegionAvail().x), thick};
    ImGui::InvisibleButton(id.c_str(), vec({std::max(size.x, 1.0), std::max(size.y, 1.0)}));
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    const ImVec2 by = ImGui::GetIO().MouseDelta;
    const bool is_moved = ImGui::IsItemActive();
    if (upright) ImGui::SameLine(0.0f, 0.0f);
    return is_moved ? static_cast<double>(upright ? by.x : by.y) : 0.0;
}

PanelRoom Desk::room_of(Panel panel) {
    switch (panel) {
        case Panel::patch: return PanelRoom::full;
        case Panel::node: {
            // Where no patch is shown, nobody can click a node of it.
            const bool is_idle = layout == Layout::plan && patch_.selected.empty() && !nodes_.wants_catalogue;
            return is_idle ? PanelRoom::none : PanelRoom::full;
        }
        case Panel::scopes: return scopes_.list().empty() ? PanelRoom::line : PanelRoom::full;
        case Panel::scene: return scene_.is_empty() ? PanelRoom::none : PanelRoom::full;
        case Panel::tree: return scene_.is_empty() ? PanelRoom::none : PanelRoom::full;
        case Panel::steps: return plan_.case_run().is_there() && !take_ ? PanelRoom::full : PanelRoom::none;
        case Panel::task: return take_ ? PanelRoom::none : PanelRoom::full;
        case Panel::slices:
            if (!plan_.case_run().is_there() || take_) return PanelRoom::none;
            return slices_.is_shown() ? PanelRoom::full : PanelRoom::line;
    }
    return PanelRoom::none;
}

void Desk::arrange(double width) {
    std::vector<LayoutColumn> wanted =
        columns_of(layout, width / fonts_.scale, [this](Panel panel) { return room_of(panel); });
    if (!std::exchange(knows_borders_, true)) moved_ = placed_ = borders_of_text(memory_.borders_of(opened_file()));
    if (!has_same_panels(wanted, columns_)) {
        if (!columns_.empty()) {
            std::erase_if(moved_, [&](const auto& known) { return has_same_panels(known, columns_); });
            moved_.push_back(std::move(columns_));
        }
        const auto known = std::ranges::find_if(moved_, [&](const auto& k) { return has_same_panels(k, wanted); });
        columns_ = known == moved_.end() ? wanted : *known;
    }
    for (std::size_t c = 0; c < columns_.size(); ++c)
        for (std::size_t p = 0; p < columns_[c].panels.size(); ++p)
            columns_[c].panels[p].is_line = wanted[c].panels[p].is_line;
}

/// When the mouse lets a border go.
void Desk::keep_borders() {
    constexpr std::size_t most = 8;
    if (!moves_border_ || ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    moves_border_ = false;
    std::erase_if(placed_, [&](const auto& known) { return has_same_panels(known, columns_); });
    placed_.push_back(columns_);
    if (placed_.size() > most) placed_.erase(placed_.begin());
    memory_.keep_borders(opened_file(), text_of_borders(placed_));
}

void Desk::draw_column(std::size_t index, double height) {
    LayoutColumn& column = columns_[index];
    // A panel that is only a line leaves its room to the others.
    const double line = std::min(64.0 * fonts_.scale, 0.5 * height);
    double shares = 0.0, lines = 0.0;
    for (const PanelPlace& place : column.panels) {
        if (place.is_line) lines += line;
        else shares += place.share;
    }
    const double shared = shares > 0.0 ? std::max(height - lines, 0.5 * height) / shares : 0.0;
    for (std::size_t p = 0; p < column.panels.size(); ++p) {
        const bool is_last = p + 1 == column.panels.size();
        const PanelPlace place = column.panels[p];
        draw_panel(place.panel, is_last ? 0.0 : place.is_line ? line : place.share * shared);
        scene_.hand().beat();
        if (is_last) break;
        if (const double by = splitter(fmt::format("behind panel {}", p), false, 0.0); by != 0.0) {
            move_border(column, p, by / std::max(height, 1.0));
            moves_border_ = true;
        }
    }
}

void Desk::draw_panel(Panel panel, double height) {
    switch (panel) {
        case Panel::patch: return draw_patch(height);
        case Panel::scopes: return draw_scopes(height);
        case Panel::scene: return draw_scene(height);
        case Panel::node: return draw_node(height);
        case Panel::tree: return draw_tree(height);
        case Panel::steps: return draw_steps(height);
        case Panel::task: return draw_task(height);
        case Panel::slices: return draw_slices(height);
    }
}

void Desk::draw_patch(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("patch", height, {0.0, 0.0}, {8.0 * s, 6.0 * s}, false);
    patch_.draw(feed(), fonts_, looked_at_);
}

void Desk::draw_scopes(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("scopes", height, {6.0 * s, 6.0 * s}, {6.0 * s, 4.0 * s}, true);
    if (!patch_.wants_scope.empty()) scopes_.add(std::exchange(patch_.wants_scope, {}));
    scopes_.draw(feed(), fonts_);
}

/// The first thing to do, over the scene: which way the blade goes as it is seen now.
void Desk::draw_first_step(const Vec3& feed) {
    const auto picture = spot("scene picture");
    if (!picture) return;
    const Vec3 right = scene_.camera.orientation * Vec3(1.0, 0.0, 0.0),
               up = scene_.camera.orientation * Vec3(0.0, 1.0, 0.0);
    const double across = glm::dot(feed, right), above = glm::dot(feed, up);
    const bool is_level = std::abs(across) > std::abs(above);
    const std::string direction = is_level ? across > 0.0 ? "right" : "left" : above > 0.0 ? "up" : "down";
    const std::string lines[] = {"Hold T: the saw runs.", fmt::format("Drag {}{} with the left button, into the bone.",
                                                                      is_level ? "to the " : "", direction)};
    const Painter paint(ImGui::GetWindowDrawList(), fonts_);
    const double size = 1.1 * static_cast<double>(ImGui::GetFontSize());
    const double wide = std::max(paint.width_of(lines[0], size), paint.width_of(lines[1], size));
    const double left = picture->middle().x - 0.5 * wide, top = picture->top + 0.8 * size;
    const Box box{left - 8.0, top - 5.0, left + wide + 8.0, top + 2.6 * size + 4.0};
    paint.box(box, colour(0x12161d, 225), 5.0);
    for (int i = 0; i < 2; ++i) paint.text({left, top + 1.3 * size * i}, size, tone::text, lines[i]);
    set_spot("hint " + direction, box);
}

void Desk::draw_scene(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("scene", height, {6.0 * s, 6.0 * s}, {6.0 * s, 4.0 * s}, false);
    scene_.has_few_tools = layout == Layout::train;
    if (shows_preview() && preview_.loaded() < preview_.count() && preview_.problem().empty()) {
        const std::string done = fmt::format("bone {} of {}", preview_.loaded() + 1, preview_.count());
        ImGui::ProgressBar(static_cast<float>(preview_.loaded()) / static_cast<float>(preview_.count()),
                           vec({-1.0, 0.0}), done.c_str());
        mark_spot("bones are loaded");
    }
    scene_.draw(take_ ? take_->scene() : shows_preview() ? preview_.observer() : bench_.observer(), fonts_);
    if (layout == Layout::train && scene_.hand().is_there())
        if (const auto first = train_.first_cut()) draw_first_step(first->within - first->entry);
}

void Desk::draw_tree(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("tree", height, {8.0 * s, 6.0 * s}, {6.0 * s, 4.0 * s}, true);
    scene_.draw_tree();
}

void Desk::draw_steps(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("plan steps", height, {8.0 * s, 6.0 * s}, {6.0 * s, 5.0 * s}, true);
    plan_.draw(fonts_);
}

void Desk::draw_slices(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("slices", height, {6.0 * s, 6.0 * s}, {6.0 * s, 4.0 * s}, false);
    slices_.draw(fonts_);
}

void Desk::draw_task(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("task", height, {10.0 * s, 8.0 * s}, {8.0 * s, 8.0 * s}, true);
    train_.draw(bench_.observer(), scene_.hand().is_there(), fonts_);
}

void Desk::draw_node(double height) {
    const double s = fonts_.scale;
    const PanelFrame frame("node", height, {8.0 * s, 6.0 * s}, {8.0 * s, 5.0 * s}, true);
    if (!ImGui::BeginTabBar("tabs")) return;
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
    // In the layout 'plan' the steps have a panel of their own.
    if (plan_.case_run().is_there() && !take_ && !shows(columns_, Panel::steps) && tab("Plan", 0)) {
        plan_.draw(fonts_);
        ImGui::EndTabItem();
    }
    const ImGuiTabItemFlags front = nodes_.wants_catalogue ? ImGuiTabItemFlags_SetSelected : 0;
    nodes_.wants_catalogue = false;
    if (tab("Add a node", front)) {
        nodes_.draw_catalogue(patch_.selected);
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

}  // namespace tactus::window
