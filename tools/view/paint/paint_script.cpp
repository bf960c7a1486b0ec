// SPDX-License-Identifier: Apache-2.0
#include "tools/view/paint/paint_script.hpp"

#include "assets/file/whole_file.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "tools/view/paint/paint_desk.hpp"
#include "tools/view/spots.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <charconv>
#include <sstream>

namespace tactus::view {

namespace {

constexpr double longest_wait = 300.0;  // s

const std::vector<std::string> commands{
    "label", "brush",  "stroke", "erase", "remove", "rename", "undo",  "redo", "cursor", "grey", "zoom",       "from",
    "look",  "vessel", "plan",   "until", "press",  "drag",   "wheel", "size", "frames", "wait", "screenshot", "close"};

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; stream >> word;) {
        if (word.front() == '#') break;
        if (word.front() == '"') {
            std::string rest;
            if (word.size() < 2 || word.back() != '"') std::getline(stream, rest, '"');
            word = word.substr(1) + rest;
            if (!word.empty() && word.back() == '"') word.pop_back();
        }
        words.push_back(word);
    }
    return words;
}

}  // namespace

PaintScript::PaintScript(const std::filesystem::path& file) : file_(file) {
    std::istringstream text(file::read_whole_file(file));
    int number = 0;
    for (std::string written; std::getline(text, written);) {
        ++number;
        Line line{number, words_of(written)};
        if (line.words.empty()) continue;
        if (std::ranges::find(commands, line.words.front()) == commands.end())
            throw Error({file.string(), number, 1}, fmt::format("no command '{}'{}", line.words.front(),
                                                                did_you_mean(line.words.front(), commands)));
        lines_.push_back(std::move(line));
    }
}

const std::string& PaintScript::word(const Line& line, std::size_t i) const {
    if (i >= line.words.size())
        throw Error({file_.string(), line.number, 1}, fmt::format("'{}' needs more words", line.words.front()));
    return line.words[i];
}

double PaintScript::number(const Line& line, std::size_t i) const {
    const std::string& text = word(line, i);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size())
        throw Error({file_.string(), line.number, 1}, fmt::format("'{}' is not a number", text));
    return value;
}

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
bool PaintScript::use_mouse(const Line& line) {
    const std::string& what = line.words.front();
    if (frames_ == 0) {
        if (what == "press") {
            const auto box = spot(word(line, 1));
            if (!box) throw Error({file_.string(), line.number, 1}, fmt::format("'{}' is not visible", word(line, 1)));
            from_ = to_ = box->middle();
        } else {
            from_ = to_ = {number(line, 1), number(line, 2)};
            if (what == "drag") to_ = {number(line, 3), number(line, 4)};
        }
    }
    const double share = std::clamp((frames_ - 4) / 8.0, 0.0, 1.0);
    const bool is_down = what != "wheel" && frames_ >= 3 && frames_ < (what == "drag" ? 14 : 6);
    mouse_ = Mouse{from_ + (to_ - from_) * share, is_down, what == "wheel" && frames_ == 3 ? number(line, 3) : 0.0};
    return frames_ >= 17;
}

bool PaintScript::perform(const Line& line, PaintDesk& desk, Window& window) {
    PaintBench& bench = desk.bench();
    Painting& painting = bench.painting();
    const std::string& what = line.words.front();
    const auto fail = [&](const std::string& why) { throw Error({file_.string(), line.number, 1}, why); };
    const auto position = [&](std::size_t i) {
        return Vec3(number(line, i), number(line, i + 1), number(line, i + 2)) * 1e-3;
    };
    const auto label_named = [&](const std::string& name) {
        const auto& labels = painting.labels();
        return static_cast<std::size_t>(std::ranges::find(labels, name, &segment::SeedLabel::name) - labels.begin());
    };
    const auto need = [&](bool is_done) {
        if (!is_done) fail(painting.problem().empty() ? "nothing has changed" : painting.problem());
    };
    if (what == "press" || what == "drag" || what == "wheel") return use_mouse(line);
    if (what == "wait") return ImGui::GetTime() - since_ >= number(line, 1);
    if (what == "frames") return frames_ >= static_cast<int>(number(line, 1));
    if (what == "until") {
        if (ImGui::GetTime() - since_ > longest_wait) fail("the computation does not end");
        if (word(line, 1) == "there") return std::filesystem::exists(word(line, 2));
        // Two frames, so that its results are drawn.
        return frames_ >= 2 && !bench.is_busy() && !bench.makes_plan() && desk.bone().is_ready();
    }
    if (what == "screenshot") {
        if (frames_ == 2) window.want_picture();
        if (frames_ < 3) return false;
        display::write_png(window.picture(), word(line, 1));
        return true;
    }
    if (what == "label") {
        const std::size_t found = label_named(word(line, 1));
        if (found < painting.labels().size()) painting.active = found;
        else {
            need(painting.add_label());
            need(painting.rename(painting.active, word(line, 1)));
        }
    } else if (what == "brush") bench.brush = std::clamp(number(line, 1), 0.1, 100.0) * 1e-3;
    else if (what == "stroke" || what == "erase") {
        painting.begin(bench.brush, position(1), what == "erase");
        for (std::size_t i = 4; i < line.words.size(); i += 3) painting.extend(position(i));
        bench.move_cursor(painting.open_stroke().points.back());
        need(painting.end());
    } else if (what == "remove") need(painting.remove_label(label_named(word(line, 1))));
    else if (what == "rename") need(painting.rename(label_named(word(line, 1)), word(line, 2)));
    else if (what == "undo") need(painting.undo());
    else if (what == "redo") need(painting.redo());
    else if (what == "cursor") bench.move_cursor(position(1));
    else if (what == "grey") bench.window = {number(line, 1), number(line, 2)};
    else if (what == "zoom") {
        desk.sight().pixels_per_m = std::clamp(desk.sight().pixels_per_m * number(line, 1), 200.0, 100'000.0);
        desk.sight().middle = bench.cursor;
    } else if (what == "from") {
        const auto view = display::view_of_name(word(line, 1));
        if (!view) fail(fmt::format("no view '{}'", word(line, 1)));
        desk.bone().look_from(*view);
    } else if (what == "look") {
        if (!bench.look_here()) fail(bench.message());
    } else if (what == "vessel") bench.follow_vessel(position(1));
    else if (what == "plan") bench.make_plan();
    else if (what == "size") window.resize(static_cast<int>(number(line, 1)), static_cast<int>(number(line, 2)));
    else closes_ = true;
    return true;
}

}  // namespace tactus::view
