// SPDX-License-Identifier: Apache-2.0
// What is done with the chosen nodes, and comments, frames and the small map.
#include "graph/patch/sub_patch.hpp"
#include "tools/view/patch/patch_panel.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::view {

std::vector<std::string> PatchPanel::chosen_nodes() const {
    std::set<std::string> names;
    for (const std::string& name : chosen) names.insert(name.substr(0, name.find(':')));
    return {names.begin(), names.end()};
}

void PatchPanel::copy() const {
    if (chosen.empty()) return;
    ImGui::SetClipboardText(bench_.copy(chosen_nodes()).c_str());
    pastes_ = 0;
}

void PatchPanel::paste() {
    const char* text = ImGui::GetClipboardText();
    if (!text || is_read_only) return;
    const double by = 30.0 * ++pastes_;
    const std::vector<std::string> made = bench_.paste(text, {by, by});
    if (made.empty()) return;
    chosen = {made.begin(), made.end()};
    selected = made.front();
}

void PatchPanel::duplicate() {
    if (chosen.empty() || is_read_only) return;
    const std::vector<std::string> made = bench_.paste(bench_.copy(chosen_nodes()), {40.0, 40.0});
    if (made.empty()) return;
    chosen = {made.begin(), made.end()};
    selected = made.front();
}

void PatchPanel::cut() {
    copy();
    remove_chosen();
}

/// A node within an open sub-patch stands in the file of that; it does not take the sub-patch along.
void PatchPanel::remove_chosen() {
    if (is_read_only || chosen.empty()) return;
    std::vector<std::string> whole;
    for (const std::string& name : chosen)
        if (name.find(patch::within_node) == std::string::npos) whole.push_back(name);
    if (!whole.empty()) bench_.remove(whole);
    else
        bench_.tell(fmt::format("{} stands within a sub-patch: open the file of that to remove it, or close the "
                                "sub-patch to remove it as a whole",
                                *chosen.begin()),
                    true);
}

void PatchPanel::choose_all() {
    chosen.clear();
    for (const PictureNode& node : bench_.picture().nodes) chosen.insert(node.name);
    if (!chosen.empty()) selected = *chosen.begin();
}

void PatchPanel::align(Align how) {
    const PatchPicture& picture = bench_.picture();
    std::vector<const PictureNode*> nodes;
    for (const PictureNode& node : picture.nodes)
        if (chosen.contains(node.name)) nodes.push_back(&node);
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

void PatchPanel::nudge(Point by) {
    const PatchPicture& picture = bench_.picture();
    std::map<std::string, patch::PatchPlace> places;
    for (const PictureNode& node : picture.nodes)
        if (chosen.contains(node.name))
            places[node.name] = place_in_lane(picture, node, Point{node.box.left, node.box.top} + by);
    if (!places.empty() && !is_read_only) bench_.place(places);
}

void PatchPanel::add_comment() {
    if (is_read_only) return;
    const Point at = canvas_.to_world({0.5 * width_, 0.5 * height_});
    if (bench_.add_comment({at.x, at.y}, "a comment")) commented_ = bench_.window().comments.back().name;
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
    const PictureComment* comment = comment_at(mouse_);
    if (comment && ImGui::MenuItem("Change the comment...", nullptr, false, may)) commented_ = comment->name;
    if (comment && ImGui::MenuItem("Remove the comment", nullptr, false, may)) bench_.remove_comment(comment->name);
    if (ImGui::MenuItem("Add a node...", "Tab", false, may)) open_palette();
    if (ImGui::MenuItem("Add a comment", nullptr, false, may)) add_comment();
    if (ImGui::MenuItem("Paste", "Ctrl+V", false, may)) paste();
    if (ImGui::MenuItem("Place all automatically", nullptr, false, may)) {
        choose_all();
        bench_.place_automatically(chosen_nodes());
    }
    if (ImGui::MenuItem("Show all", "F")) fit();
    ImGui::MenuItem("Small map", nullptr, &has_minimap);
}

void PatchPanel::draw_comments(const Painter& paint) {
    const double z = canvas_.zoom;
    for (const PictureFrame& frame : bench_.picture().frames) {
        const Box box = screen(frame.box);
        paint.box(box, colour(0x2b3a52, 130), 6.0 * z);
        paint.frame(box, tone::node_edge, 6.0 * z);
        if (const auto size = letters(small_size, 14.0))
            paint.text({box.left + 4.0 * z, box.top - 1.2 * *size}, *size, tone::dim, frame.name);
    }
    for (const PictureComment& comment : bench_.picture().comments) {
        const Box box = screen(comment.box);
        const std::uint32_t ink = colour_named(comment.colour.empty() ? "grey" : comment.colour);
        paint.box(box, faded(ink, 0.35), 4.0 * z);
        paint.frame(box, ink, 4.0 * z);
        const auto size = letters(text_size, 16.0);
        if (!size) continue;
        paint.list()->PushClipRect(vec({box.left, box.top}), vec({box.right, box.bottom}), true);
        paint.list()->AddText(ImGui::GetFont(), static_cast<float>(*size), vec({box.left + 6.0 * z, box.top + 4.0 * z}),
                              tone::text, comment.text.c_str(), nullptr,
                              static_cast<float>(std::max(10.0, box.width() - 12.0 * z)));
        paint.list()->PopClipRect();
    }
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
    if (dragging_.what == What::nodes)
        for (const PictureNode& node : bench_.picture().nodes)
            if (chosen.contains(node.name)) ghost(node.box);
    for (const PictureComment& comment : bench_.picture().comments)
        if (comment.name == dragging_.name) {
            if (dragging_.what == What::comment) ghost(comment.box);
            else
                paint.frame(
                    screen(Box{comment.box.left, comment.box.top, comment.box.right + by.x, comment.box.bottom + by.y}),
                    tone::chosen, 4.0, 2.0);
        }
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

const patch::PatchComment* PatchPanel::comment_named(const std::string& name) const {
    const auto& all = bench_.window().comments;
    const auto found = std::ranges::find(all, name, &patch::PatchComment::name);
    return found == all.end() ? nullptr : &*found;
}

void PatchPanel::keep_comment(const std::string& colour) {
    const patch::PatchComment* found = comment_named(writing_);
    if (!found || (found->text == comment_text_ && colour.empty())) return;
    patch::PatchComment changed = *found;
    changed.text = comment_text_;
    if (!colour.empty()) changed.colour = colour;
    bench_.comment(changed);
}

void PatchPanel::edit_comment() {
    constexpr const char* title = "comment";
    if (!commented_.empty()) {
        writing_ = std::exchange(commented_, {});
        if (const patch::PatchComment* found = comment_named(writing_)) {
            comment_text_ = found->text;
            ImGui::OpenPopup(title);
        }
    }
    if (!ImGui::BeginPopup(title)) {
        // A click beside it ends the writing and keeps the words.
        keep_comment("");
        return writing_.clear();
    }
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::InputTextMultiline("##text", &comment_text_,
                              ImVec2(26.0f * ImGui::GetFontSize(), 6.0f * ImGui::GetFontSize()));
    mark_spot("comment text");
    const bool ends = ImGui::Button("Done");
    mark_spot("comment done");
    for (const std::string& colour : patch::colour_names()) {
        ImGui::SameLine();
        if (ImGui::ColorButton(colour.c_str(), ImGui::ColorConvertU32ToFloat4(colour_named(colour))))
            keep_comment(colour);
        mark_spot("comment " + colour);
    }
    if (ends) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
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

}  // namespace tactus::view
