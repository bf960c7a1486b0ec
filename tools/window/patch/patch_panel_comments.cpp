// SPDX-License-Identifier: Apache-2.0
// Comments of the patch, and the frames of open sub-patches.
#include "tools/window/patch/patch_panel.hpp"
#include "tools/window/widgets/spots.hpp"
#include "tools/window/widgets/theme.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

const PictureComment* PatchPanel::comment_at(Point world) const {
    const auto& all = bench_.picture().comments;
    const auto found = std::ranges::find_if(all, [&](const PictureComment& c) { return c.box.contains(world); });
    return found == all.end() ? nullptr : &*found;
}

void PatchPanel::press_comment(const PictureComment& comment, Point world) {
    constexpr double corner = 16.0;
    const ImGuiIO& io = ImGui::GetIO();
    if (world.x > comment.box.right - corner && world.y > comment.box.bottom - corner) {
        dragging_.what = Dragging::What::corner;
        dragging_.name = comment.name;
        return;
    }
    if (io.KeyShift || io.KeyCtrl) {
        if (chosen_comments.erase(comment.name) == 0) chosen_comments.insert(comment.name);
    } else if (!chosen_comments.contains(comment.name)) {
        choose_only("");
        chosen_comments = {comment.name};
    }
    dragging_.what = Dragging::What::chosen;
    dragging_.is_alone = io.KeyAlt;
}

void PatchPanel::add_comment(std::optional<Point> at) {
    if (is_read_only) return;
    const Point place = at.value_or(canvas_.to_world({0.5 * width_, 0.5 * height_}));
    commented_ = bench_.add_comment({place.x, place.y}, "a comment");
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
        const bool is_chosen = chosen_comments.contains(comment.name);
        paint.frame(box, is_chosen ? tone::chosen : ink, 4.0 * z, is_chosen ? 2.0 : 1.0);
        const auto size = letters(text_size, 16.0);
        if (!size) continue;
        paint.list()->PushClipRect(vec({box.left, box.top}), vec({box.right, box.bottom}), true);
        paint.list()->AddText(ImGui::GetFont(), static_cast<float>(*size), vec({box.left + 6.0 * z, box.top + 4.0 * z}),
                              tone::text, comment.text.c_str(), nullptr,
                              static_cast<float>(std::max(10.0, box.width() - 12.0 * z)));
        paint.list()->PopClipRect();
    }
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

}  // namespace tactus::window
