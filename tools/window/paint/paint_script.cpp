// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/paint_script.hpp"

#include "assets/file/whole_file.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "tools/window/paint/paint_desk.hpp"
#include "tools/window/paint/paint_lines.hpp"
#include "tools/window/widgets/spot_list.hpp"
#include "tools/window/widgets/spots.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

namespace tactus::window {

namespace {

constexpr double longest_wait = 300.0;  // s

}  // namespace

PaintScript::PaintScript(const std::filesystem::path& file)
    : lines_(paint_lines(file::read_whole_file(file), file.string())) {}

void PaintScript::step(PaintDesk& desk, Window& window) {
    ++frames_;
    while (next_ < lines_.size()) {
        if (since_ < 0.0) {
            since_ = ImGui::GetTime();
            frames_ = 0;
        }
        if (!perform(lines_[next_], desk, window)) return;
        since_ = -1.0;
        ++next_;
    }
}

void PaintScript::move_mouse() const {
    if (!mouse_) return;
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = ImVec2(static_cast<float>(mouse_->at.x), static_cast<float>(mouse_->at.y));
    io.MouseDown[0] = mouse_->left;
    io.MouseWheel = static_cast<float>(mouse_->wheel);
}

/// At the speed of a hand: the item under the mouse is known one frame later.
bool PaintScript::use_mouse(const ScriptLine& line) {
    const std::string& what = line.words.front();
    if (frames_ == 0) {
        if (what == "press") {
            const auto box = spot(line.word(1));
            if (!box) throw Error(line.where, fmt::format("'{}' is not visible", line.word(1)));
            from_ = to_ = box->middle();
        } else {
            from_ = to_ = {line.number(1), line.number(2)};
            if (what == "drag") to_ = {line.number(3), line.number(4)};
        }
    }
    const double share = std::clamp((frames_ - 4) / 8.0, 0.0, 1.0);
    const bool is_down = what != "wheel" && frames_ >= 3 && frames_ < (what == "drag" ? 14 : 6);
    mouse_ = Mouse{from_ + (to_ - from_) * share, is_down, what == "wheel" && frames_ == 3 ? line.number(3) : 0.0};
    return frames_ >= 17;
}

bool PaintScript::perform(const ScriptLine& line, PaintDesk& desk, Window& window) {
    PaintBench& bench = desk.bench();
    const std::string& what = line.words.front();
    if (what == "press" || what == "drag" || what == "wheel") return use_mouse(line);
    if (what == "wait") return ImGui::GetTime() - since_ >= line.number(1);
    if (what == "frames") return frames_ >= static_cast<int>(std::min(line.number(1), 1e6));
    if (what == "until") {
        if (ImGui::GetTime() - since_ > longest_wait) throw Error(line.where, "the computation does not end");
        if (line.word(1) == "there") return std::filesystem::exists(line.word(2));
        // Two frames, so that its results are drawn.
        return frames_ >= 2 && !bench.is_busy() && !bench.makes_plan() && desk.bone().is_ready();
    }
    if (what == "screenshot") {
        if (frames_ == 2) window.want_picture();
        if (frames_ < 3) return false;
        display::write_png(window.picture(), line.word(1));
        return true;
    }
    if (what == "click_bone") {
        const auto at = desk.bone().place_of(Vec3(line.number(1), line.number(2), line.number(3)) * 1e-3);
        if (frames_ == 0 && !at) throw Error(line.where, "this place is not in the picture of the bone");
        if (frames_ == 0) from_ = to_ = *at;
        mouse_ = Mouse{from_, frames_ >= 3 && frames_ < 6, 0.0};
        return frames_ >= 17;
    }
    if (what == "size") window.resize(static_cast<int>(line.number(1)), static_cast<int>(line.number(2)));
    else if (what == "close") closes_ = true;
    else if (what == "shut") window.close();
    else if (what == "spots") file::write_whole_file(line.word(1), spot_list());
    else {
        bool is_refused = false;
        try {
            is_refused = !edit(line, desk);
        } catch (const Error&) {
            if (!line.is_refused) throw;
            is_refused = true;
        }
        const std::string& why = bench.painting().problem();
        if (is_refused && !line.is_refused)
            throw Error(line.where, what == "look" || what == "island" ? bench.message()
                                    : why.empty()                      ? "nothing has changed"
                                                                       : why);
        if (!is_refused && line.is_refused) throw Error(line.where, fmt::format("'{}' was not refused", what));
    }
    return true;
}

/// False: it was refused.
bool PaintScript::edit(const ScriptLine& line, PaintDesk& desk) {
    PaintBench& bench = desk.bench();
    Painting& painting = bench.painting();
    const std::string& what = line.words.front();
    const auto position = [&](std::size_t i) {
        return Vec3(line.number(i), line.number(i + 1), line.number(i + 2)) * 1e-3;
    };
    const auto label_named = [&](const std::string& name) {
        const auto& labels = painting.labels();
        return static_cast<std::size_t>(std::ranges::find(labels, name, &segmentation::SeedLabel::name) -
                                        labels.begin());
    };
    if (what == "label") {
        const std::size_t found = label_named(line.word(1));
        if (found == painting.labels().size()) return painting.add_label(line.word(1));
        painting.active = found;
    } else if (what == "brush") bench.brush = std::clamp(line.number(1), 0.1, 100.0) * 1e-3;
    else if (what == "stroke" || what == "erase") {
        painting.begin(bench.brush, position(1), what == "erase");
        for (std::size_t i = 4; i < line.words.size(); i += 3) painting.extend(position(i));
        if (!painting.is_open()) return false;
        bench.move_cursor(painting.open_stroke().points.back());
        return painting.end();
    } else if (what == "remove") return painting.remove_label(label_named(line.word(1)));
    else if (what == "rename") return painting.rename(label_named(line.word(1)), line.word(2));
    else if (what == "merge") return painting.merge(label_named(line.word(1)), label_named(line.word(2)));
    else if (what == "undo") return painting.undo();
    else if (what == "redo") return painting.redo();
    else if (what == "cursor") bench.move_cursor(position(1));
    else if (what == "grey") bench.window = {line.number(1), line.number(2)};
    else if (what == "zoom") {
        desk.sight().pixels_per_m = std::clamp(desk.sight().pixels_per_m * line.number(1), 200.0, 100'000.0);
        desk.sight().middle = bench.cursor;
    } else if (what == "from") desk.bone().look_from(*display::view_of_name(line.word(1)));
    else if (what == "look") return bench.look_here();
    else if (what == "island") return bench.look_at_island();
    else if (what == "tool")
        bench.tool = line.word(1) == "paint"   ? PaintBench::Tool::paint
                     : line.word(1) == "erase" ? PaintBench::Tool::erase
                                               : PaintBench::Tool::vessel;
    else if (what == "vessel") bench.follow_vessel(position(1));
    else bench.make_plan();
    return true;
}

}  // namespace tactus::window
