// SPDX-License-Identifier: Apache-2.0
// What is done with the chosen nodes, and comments, frames and the small map.
#include "graph/patch/sub_patch.hpp"
#include "tools/window/document/clipboard_lane.hpp"
#include "tools/window/patch/patch_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

std::vector<std::string> PatchPanel::chosen_nodes() const {
    std::set<std::string> names;
    for (const std::string& name : chosen) names.insert(name.substr(0, name.find(':')));
    return {names.begin(), names.end()};
}

void PatchPanel::copy() const {
    if (!has_chosen()) return;
    ImGui::SetClipboardText(copied_text().c_str());
    pastes_ = 0;
}

/// With places of all, so that they stand to each other where they are pasted as they do here.
std::string PatchPanel::copied_text() const {
    const PatchPicture& picture = bench_.picture();
    const std::vector<std::string> nodes = chosen_nodes();
    std::map<std::string, patch::PatchPlace> places;
    for (const std::string& name : nodes)
        if (const int index = picture.find(name); index >= 0) {
            const PictureNode& node = picture.nodes[static_cast<std::size_t>(index)];
            places[name] = place_in_lane(picture, node, {node.box.left, node.box.top});
        }
    return bench_.copy(nodes, places, {chosen_comments.begin(), chosen_comments.end()});
}

namespace {

/// How far a copy moves so that its upper left corner stands at a point; vertically by what stands in the lane there.
patch::PatchPlace way_to(const PatchPicture& picture, const std::string& text, Point at, patch::PatchPlace otherwise) {
    const patch::PatchWindow window = patch::window_of(text);
    patch::Problems ignored;
    const patch::Patch copy = patch::read_patch(text, "clipboard", ignored);
    const PictureLane* lane = copy.nodes.empty() ? nullptr : lane_at(picture, at);
    double left = 1e9, top = 1e9;
    for (const patch::PatchNode& node : copy.nodes) {
        const auto place = window.places.find(node.name);
        if (place == window.places.end()) continue;
        left = std::min(left, place->second.x);
        if (lane && lane_of(node) == lane->name) top = std::min(top, place->second.y);
    }
    const std::string of_comments = lane_of_comments(copy);
    for (const patch::PatchComment& comment : window.comments) {
        left = std::min(left, comment.place.x);
        if (copy.nodes.empty() || (lane && of_comments == lane->name)) top = std::min(top, comment.place.y);
    }
    if (left >= 1e9) return otherwise;
    if (copy.nodes.empty()) return {at.x - left, at.y - top};
    return {at.x - left, top >= 1e9 ? otherwise.y : std::max(at.y - lane->top, lane_head_height) - top};
}

}  // namespace

void PatchPanel::paste(std::optional<Point> at) {
    const char* text = ImGui::GetClipboardText();
    if (!text || is_read_only) return;
    if (!at && is_pointed_) at = mouse_;
    const double by = 30.0 * ++pastes_;
    patch::PatchPlace way{by, by};
    if (at) way = way_to(bench_.picture(), text, *at, way);
    choose_these(bench_.paste(text, way));
}

void PatchPanel::duplicate() {
    if (!has_chosen() || is_read_only) return;
    choose_these(bench_.paste(copied_text(), {40.0, 40.0}));
}

void PatchPanel::choose_these(const Workbench::Pasted& made) {
    if (made.nodes.empty() && made.comments.empty()) return;
    choose_only(made.nodes.empty() ? "" : made.nodes.front());
    chosen = {made.nodes.begin(), made.nodes.end()};
    chosen_comments = {made.comments.begin(), made.comments.end()};
}

void PatchPanel::cut() {
    copy();
    remove_chosen();
}

/// Nodes within an open sub-patch stand in the file of that.
std::vector<std::string> PatchPanel::whole_nodes() const {
    std::vector<std::string> whole;
    for (const std::string& name : chosen)
        if (name.find(patch::within_node) == std::string::npos) whole.push_back(name);
    return whole;
}

void PatchPanel::remove_chosen() {
    if (is_read_only || !has_chosen()) return;
    const std::vector<std::string> whole = whole_nodes();
    if (whole.empty() && chosen_comments.empty())
        return bench_.tell(fmt::format("{} stands within a sub-patch: open the file of that to remove it, or close the "
                                       "sub-patch to remove it as a whole",
                                       *chosen.begin()),
                           true);
    bench_.remove(whole, {chosen_comments.begin(), chosen_comments.end()});
}

void PatchPanel::choose_all() {
    choose_only("");
    for (const PictureNode& node : bench_.picture().nodes) chosen.insert(node.name);
    for (const PictureComment& comment : bench_.picture().comments) chosen_comments.insert(comment.name);
    if (!chosen.empty()) selected = *chosen.begin();
}

void PatchPanel::align(Align how) {
    const PatchPicture& picture = bench_.picture();
    std::vector<const PictureNode*> nodes;
    const std::vector<std::string> whole = whole_nodes();
    for (const PictureNode& node : picture.nodes)
        if (std::ranges::find(whole, node.name) != whole.end()) nodes.push_back(&node);
    if (nodes.size() < 2 || is_read_only) return;
    const bool is_row = how == Align::top || how == Align::columns;
    std::ranges::sort(nodes, {}, [&](const PictureNode* n) { return is_row ? n->box.left : n->box.top; });
    std::map<std::string, patch::PatchPlace> places;
    Point next{nodes.front()->box.left, nodes.front()->box.top};
    for (const PictureNode* node : nodes) {
        Point at{node->box.left, node->box.top};
        if (how == Align::left) at.x = next.x;
        if (how == Align::top) at.y = next.y;
        if (how == Align::columns) at.x = std::exchange(next.x, next.x + node_width + column_gap);
        if (how == Align::rows) at.y = std::exchange(next.y, next.y + node->box.height() + 18.0);
        places[node->name] = place_in_lane(picture, *node, at);
    }
    bench_.place(places);
}

PatchPanel::Things PatchPanel::moving(bool is_alone) const {
    const PatchPicture& picture = bench_.picture();
    Things things;
    for (const std::string& name : whole_nodes()) things.nodes.insert(name);
    things.comments = chosen_comments;
    if (is_alone) return things;
    const auto lies_in = [](const Box& inner, const Box& outer) {
        return outer.contains({inner.left, inner.top}) && outer.contains({inner.right, inner.bottom});
    };
    for (const PictureComment& frame : picture.comments) {
        if (!chosen_comments.contains(frame.name)) continue;
        for (const PictureNode& node : picture.nodes)
            if (node.name.find(patch::within_node) == std::string::npos && lies_in(node.box, frame.box))
                things.nodes.insert(node.name);
        for (const PictureComment& other : picture.comments)
            if (lies_in(other.box, frame.box)) things.comments.insert(other.name);
    }
    return things;
}

patch::PatchComment PatchPanel::moved_comment(const std::string& name, Point by) const {
    const patch::PatchComment* found = comment_named(name);
    patch::PatchComment moved = found ? *found : patch::PatchComment{};
    moved.place = {moved.place.x + by.x, moved.place.y + by.y};
    return moved;
}

void PatchPanel::move_chosen(Point by, bool is_alone) {
    const PatchPicture& picture = bench_.picture();
    const Things things = moving(is_alone);
    std::map<std::string, patch::PatchPlace> places;
    for (const PictureNode& node : picture.nodes)
        if (things.nodes.contains(node.name))
            places[node.name] = place_in_lane(picture, node, Point{node.box.left, node.box.top} + by);
    std::vector<patch::PatchComment> comments;
    for (const std::string& name : things.comments) comments.push_back(moved_comment(name, by));
    if (!places.empty() || !comments.empty()) bench_.place(places, comments);
    else if (!chosen.empty())
        bench_.tell(fmt::format("{} stands within a sub-patch, whose own file says where", *chosen.begin()), true);
}

void PatchPanel::nudge(Point by) {
    if (!is_read_only && has_chosen()) move_chosen(by, false);
}

void PatchPanel::make_sub_patch() {
    if (chosen.empty() || is_read_only) return;
    new_name_ = bench_.free_name("part");
    wants_part_name_ = true;
}

void PatchPanel::open_palette() {
    if (is_read_only) return;
    const Point at = Box{0.0, 0.0, width_, height_}.contains(canvas_.to_pixel(mouse_))
                         ? canvas_.to_pixel(mouse_)
                         : Point{0.3 * width_, 0.3 * height_};
    palette_.open(at + corner_, canvas_.to_world(at), {}, nullptr);
}

void PatchPanel::node_menu(const std::string& name, bool is_part) {
    ImGui::TextDisabled("%s", chosen.size() > 1 ? fmt::format("{} nodes", chosen.size()).c_str() : name.c_str());
    const bool may = !is_read_only;
    const std::size_t within = name.find(':');
    if (is_part && ImGui::MenuItem("Open the sub-patch", "double-click", false, may)) bench_.open_sub_patch(name, true);
    if (within != std::string::npos && ImGui::MenuItem("Close the sub-patch", nullptr, false, may))
        bench_.open_sub_patch(name.substr(0, within), false);
    if (ImGui::MenuItem("Copy", "Ctrl+C")) copy();
    if (ImGui::MenuItem("Duplicate", "Ctrl+D", false, may)) duplicate();
    if (ImGui::MenuItem("Make a sub-patch...", nullptr, false, may)) make_sub_patch();
    if (ImGui::BeginMenu("Colour", may)) {
        for (const std::string& colour : patch::colour_names()) {
            ImGui::PushStyleColor(ImGuiCol_Text, colour_named(colour) | 0xFF000000u);
            if (ImGui::MenuItem(("\u25a0 " + colour).c_str())) bench_.colour(chosen_nodes(), colour);
            ImGui::PopStyleColor();
        }
        if (ImGui::MenuItem("none")) bench_.colour(chosen_nodes(), "");
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Align", may && chosen.size() > 1)) {
        if (ImGui::MenuItem("left edges")) align(Align::left);
        if (ImGui::MenuItem("top edges")) align(Align::top);
        if (ImGui::MenuItem("as a row")) align(Align::columns);
        if (ImGui::MenuItem("as a column")) align(Align::rows);
        ImGui::EndMenu();
    }
    if (ImGui::MenuItem("Place automatically", nullptr, false, may)) bench_.place_automatically(chosen_nodes());
    if (ImGui::MenuItem("Remove", "Del", false, may)) remove_chosen();
}

void PatchPanel::canvas_menu() {
    const bool may = !is_read_only;
    const PictureComment* comment = comment_at(menu_at_);
    if (comment && ImGui::MenuItem("Change the comment...", nullptr, false, may)) commented_ = comment->name;
    if (comment && ImGui::MenuItem("Copy the comment", "Ctrl+C")) {
        if (!chosen_comments.contains(comment->name)) choose_these({{}, {comment->name}});
        copy();
    }
    if (comment && ImGui::MenuItem("Remove the comment", nullptr, false, may)) bench_.remove_comment(comment->name);
    if (ImGui::MenuItem("Add a node...", "Tab", false, may)) open_palette();
    if (ImGui::MenuItem("Add a comment", nullptr, false, may)) add_comment(menu_at_);
    if (ImGui::MenuItem("Paste", "Ctrl+V", false, may)) paste(menu_at_);
    if (ImGui::MenuItem("Place all automatically", nullptr, false, may)) {
        choose_all();
        bench_.place_automatically(chosen_nodes());
    }
    if (ImGui::MenuItem("Show all", "F")) fit();
    ImGui::MenuItem("Small map", nullptr, &has_minimap);
}

void PatchPanel::draw_dragging(const Painter& paint) {
    if (!dragging_.is_moved()) return;
    const Point by = dragging_.to - dragging_.from;
    using What = Dragging::What;
    const auto ghost = [&](const Box& b) {
        paint.frame(screen(Box{b.left + by.x, b.top + by.y, b.right + by.x, b.bottom + by.y}), tone::chosen, 4.0, 2.0);
    };
    if (dragging_.what == What::frame) {
        const Box box =
            screen(Box{std::min(dragging_.from.x, dragging_.to.x), std::min(dragging_.from.y, dragging_.to.y),
                       std::max(dragging_.from.x, dragging_.to.x), std::max(dragging_.from.y, dragging_.to.y)});
        paint.box(box, faded(tone::chosen, 0.15));
        return paint.frame(box, tone::chosen);
    }
    if (dragging_.what == What::corner) {
        for (const PictureComment& comment : bench_.picture().comments)
            if (comment.name == dragging_.name)
                paint.frame(
                    screen(Box{comment.box.left, comment.box.top, comment.box.right + by.x, comment.box.bottom + by.y}),
                    tone::chosen, 4.0, 2.0);
        return;
    }
    const Things things = moving(dragging_.is_alone);
    for (const PictureNode& node : bench_.picture().nodes)
        if (things.nodes.contains(node.name)) ghost(node.box);
    for (const PictureComment& comment : bench_.picture().comments)
        if (things.comments.contains(comment.name)) ghost(comment.box);
}

/// Shown while a part of the patch is outside of the panel.
std::optional<Box> PatchPanel::minimap() const {
    const Box& all = bench_.picture().bounds;
    const Box seen = canvas_.visible(width_, height_);
    const double wide = 150.0 * unit_, least = 320.0 * unit_;
    const bool is_all =
        seen.left <= all.left && seen.top <= all.top && seen.right >= all.right && seen.bottom >= all.bottom;
    if (!has_minimap || is_all || width_ < least || height_ < 0.7 * least || bench_.picture().nodes.empty())
        return std::nullopt;
    const double scale = std::min(wide / std::max(all.width(), 1.0), 0.3 * height_ / std::max(all.height(), 1.0));
    const Point far = corner_ + Point{width_ - 8.0 * unit_, height_ - 8.0 * unit_};
    return Box{far.x - all.width() * scale, far.y - all.height() * scale, far.x, far.y};
}

/// A press on the small map goes there, and means nothing else. True: it was one.
bool PatchPanel::press_minimap() {
    const ImGuiIO& io = ImGui::GetIO();
    const auto map = minimap();
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        is_on_map_ = map && ImGui::IsItemHovered() && map->contains(point(io.MousePos));
    if (!is_on_map_ || !map) return is_on_map_ = false;
    const Box& all = bench_.picture().bounds;
    const double x = std::clamp((io.MousePos.x - map->left) / map->width(), 0.0, 1.0),
                 y = std::clamp((io.MousePos.y - map->top) / map->height(), 0.0, 1.0);
    const Point world{all.left + x * all.width(), all.top + y * all.height()};
    canvas_.origin = world - Point{width_, height_} * (0.5 / canvas_.zoom);
    follows_size_ = false;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) is_on_map_ = false;
    return true;
}

void PatchPanel::draw_minimap(const Painter& paint) {
    const auto found = minimap();
    if (!found) return;
    const Box& map = *found;
    const Box& all = bench_.picture().bounds;
    const double scale = map.width() / std::max(all.width(), 1.0);
    const auto on_map = [&](const Box& b) {
        return Box{map.left + (b.left - all.left) * scale, map.top + (b.top - all.top) * scale,
                   map.left + (b.right - all.left) * scale, map.top + (b.bottom - all.top) * scale};
    };
    paint.box({map.left - 3.0, map.top - 3.0, map.right + 3.0, map.bottom + 3.0}, colour(0x0c1015, 235), 3.0);
    paint.list()->PushClipRect(vec({map.left - 2.0, map.top - 2.0}), vec({map.right + 2.0, map.bottom + 2.0}), true);
    for (const Box& stack : bench_.picture().stacks) paint.box(on_map(stack), tone::node_edge);
    for (const PictureNode& node : bench_.picture().nodes)
        if (chosen.contains(node.name)) paint.box(on_map(node.box), tone::chosen);
    paint.frame(on_map(canvas_.visible(width_, height_)), tone::text);
    paint.list()->PopClipRect();
    set_spot("small map", map);
}

void PatchPanel::name_sub_patch() {
    constexpr const char* title = "name of the sub-patch";
    if (std::exchange(wants_part_name_, false)) ImGui::OpenPopup(title);
    if (!ImGui::BeginPopup(title)) return;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool typed = ImGui::InputTextWithHint("##name", "its name", &new_name_, ImGuiInputTextFlags_EnterReturnsTrue);
    mark_spot("part name");
    ImGui::SameLine();
    const bool pressed = ImGui::Button("Make it");
    if (typed || pressed) {
        if (bench_.make_sub_patch(chosen_nodes(), new_name_)) choose_only(new_name_);
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace tactus::window
