// SPDX-License-Identifier: Apache-2.0
#include "tools/window/script.hpp"

#include "assets/file/whole_file.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "tools/terminal.hpp"
#include "tools/window/desk/desk.hpp"
#include "tools/window/frame/cut_letters.hpp"
#include "tools/window/widgets/spot_list.hpp"
#include "tools/window/widgets/spots.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::window {

namespace {

constexpr double longest_wait = 60.0;  // s, for conditions to wait for

const std::vector<std::string> commands{
    "open",      "run",        "stop",    "pause",      "resume", "record",  "select",    "set",     "reset",
    "add",       "wire",       "connect", "remove",     "rename", "undo",    "redo",      "save",    "scope",
    "reference", "freeze",     "export",  "disconnect", "fit",    "look",    "catalogue", "goto",    "scene",
    "hover",     "click",      "drag",    "wheel",      "wait",   "until",   "frames",    "size",    "minimise",
    "restore",   "screenshot", "close",   "say",        "from",   "stereo",  "clip",      "measure", "check",
    "scale",     "press",      "double",  "slide",      "pull",   "type",    "key",       "cost",    "head",
    "display",   "offset",     "screens", "shut",       "layout", "instant", "text",      "spots",   "letters"};

}  // namespace

Script::Script(const std::filesystem::path& file) : lines_(read_script(file, commands, {{"rig", "display"}})) {}

void Script::step(Desk& desk, Window& window) {
    ++pictures_;
    while (!is_done()) {
        const ScriptLine line = lines_[next_];
        if (!since_) {
            since_ = ImGui::GetTime();
            pictures_ = 0;
        }
        try {
            if (!perform(line, desk, window)) return;
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            throw Error(line.where, error.what());
        }
        since_.reset();
        ++next_;
        // Another patch has another desk.
        if (line.words.front() == "open") return;
    }
}

/// Commands that change the patch; each may be refused.
bool Script::edit(const ScriptLine& line, Desk& desk) {
    Workbench& bench = desk.bench();
    const std::string& what = line.words.front();
    const auto split = [&](std::size_t i) {
        const std::string& text = line.word(i);
        const std::size_t dot = text.find('.');
        if (dot == std::string::npos) throw Error(fmt::format("'{}' is not NODE.NAME", text));
        return std::pair(text.substr(0, dot), text.substr(dot + 1));
    };
    if (what == "set") return bench.set(split(1).first, split(1).second, line.word(2));
    if (what == "reset") return bench.reset(split(1).first, split(1).second);
    if (what == "connect") return bench.connect(line.word(1), line.word(2), line.words.size() > 3 ? line.words[3] : "");
    if (what == "disconnect") return bench.disconnect(line.word(1));
    if (what == "remove") return bench.remove(line.word(1));
    if (what == "rename") return bench.rename(line.word(1), line.word(2));
    if (what == "undo" && line.words.size() > 1) {
        while (bench.undo()) {
        }
        return true;
    }
    if (what == "undo") return bench.undo();
    if (what == "redo") return bench.redo();
    if (what == "save") return line.words.size() > 1 ? bench.save_as(line.words[1]) : bench.save();
    if (what == "wire") {
        if (bench.last_added().empty()) throw Error("there is no new node that needs wires");
        return bench.connect(line.word(1), bench.last_added() + "." + line.word(2));
    }
    // add TYPE GROUP
    return !bench.add_node(line.word(1), line.word(2)).empty();
}

bool Script::wait_for(const ScriptLine& line, Desk& desk, Window& window) {
    const std::string& what = line.words.front();
    const double waited = ImGui::GetTime() - since_.value_or(0.0);
    if (what == "wait") return waited >= line.number(1);
    if (what == "frames") return pictures_ >= static_cast<int>(line.number(1));
    if (what == "screenshot") {
        // The first frame draws the changes, the second is saved.
        if (pictures_ == 1) window.want_picture();
        if (pictures_ < 2) return false;
        display::write_png(window.picture(), line.word(1));
        return true;
    }
    if (what == "click" || what == "drag") {
        const std::size_t last = what == "drag" ? 3 : 1;
        const double share = std::clamp((pictures_ - 2) / 6.0, 0.0, 1.0);
        const Point from{line.number(1), line.number(2)}, to{line.number(last), line.number(last + 1)};
        mouse_ = Mouse{from + (to - from) * share, pictures_ >= 1 && pictures_ < 10, false, 0.0};
        return pictures_ >= 12;
    }
    if (what == "press" || what == "double" || what == "slide" || what == "pull") return use_hand(line, desk);
    if (what == "type") {
        keys_ = {};
        if (pictures_ == 1) keys_.text = line.word(1);
        return pictures_ >= 4;
    }
    if (what == "key") {
        keys_ = key_named(line.word(1));
        keys_.is_down = pictures_ >= 1 && pictures_ < 3;
        keys_.ctrl = keys_.ctrl && keys_.is_down;
        if (pictures_ < 6) return false;
        keys_ = {};
        return true;
    }
    if (what == "cost") {
        if (pictures_ == 0) cost_began_ = window.drawn_s();
        if (pictures_ < static_cast<int>(line.number(1))) return false;
        say(stderr,
            fmt::format("{} pictures, {:.2f} ms each, {} triangles beside the scene's\n", pictures_,
                        1e3 * (window.drawn_s() - cost_began_) / pictures_, ImGui::GetIO().MetricsRenderIndices / 3));
        return true;
    }
    if (what == "wheel") {
        mouse_ = Mouse{{line.number(1), line.number(2)}, false, false, pictures_ == 1 ? line.number(3) : 0.0};
        return pictures_ >= 3;
    }
    if (waited > longest_wait) throw Error(fmt::format("'{}' was not reached within {} s", what, longest_wait));
    if (what == "instant") return desk.take() && std::abs(desk.take()->time() - line.number(1)) < 1e-3;
    if (what == "scene") return !desk.take() || desk.take()->scene_is_there();
    // until SECONDS | until paused | until recording | until over
    const auto status = desk.bench().status();
    if (line.word(1) == "paused") return status->state == RunStatus::State::stands;
    if (line.word(1) == "recording") return status->is_recording;
    if (line.word(1) == "over") return status->state == RunStatus::State::over;
    if (status->state == RunStatus::State::over) throw Error("the run is over: " + status->failure);
    return status->state != RunStatus::State::loading && status->time >= line.number(1);
}

bool Script::perform(const ScriptLine& line, Desk& desk, Window& window) {
    Workbench& bench = desk.bench();
    const std::string& what = line.words.front();
    const auto is = [&](auto... names) { return ((what == names) || ...); };
    if (is("wait", "frames", "screenshot", "click", "drag", "wheel", "scene", "instant", "until", "press", "double",
           "slide", "pull", "type", "key", "cost"))
        return wait_for(line, desk, window);
    if (is("set", "reset", "connect", "disconnect", "remove", "rename", "undo", "redo", "save", "wire", "add")) {
        const bool made = edit(line, desk);
        if (made == line.is_refused)
            throw Error(made                       ? "was expected to be refused, but was accepted"
                        : bench.messages().empty() ? "was refused"
                                                   : bench.messages().back().text);
        return true;
    }
    if (is("text")) file::write_durable_file(line.word(1), bench.editor().text());
    else if (is("run")) bench.run();
    else if (is("stop")) bench.stop();
    else if (is("pause", "resume")) bench.pause(what == "pause");
    else if (is("record")) bench.record(line.words.size() < 2 || line.words[1] != "off");
    else if (is("select")) desk.patch().selected = line.word(1);
    else if (is("scope")) desk.scopes().add(line.word(1), line.words.size() > 2 && line.words[2] == "spectrum");
    else if (is("reference")) desk.scopes().set_reference(line.word(1));
    else if (is("freeze")) desk.scopes().freeze(line.words.size() < 2 || line.words[1] != "off");
    else if (is("export")) {
        if (!desk.feed()) throw Error("no run");
        desk.scopes().write(static_cast<std::size_t>(line.number(1)), *desk.feed(), line.word(2));
    } else if (is("fit")) desk.patch().fit();
    else if (is("look")) desk.patch().look_at(line.word(1));
    else if (is("catalogue")) {
        desk.nodes().wants_catalogue = true;
        desk.nodes().search = line.words.size() > 1 ? line.words[1] : "";
    } else if (is("goto")) {
        if (!desk.take()) throw Error("no take is open");
        desk.take()->go_to(line.number(1));
    } else if (is("hover")) mouse_ = Mouse{{line.number(1), line.number(2)}, false, false, 0.0};
    else if (is("size")) window.resize(static_cast<int>(line.number(1)), static_cast<int>(line.number(2)));
    else if (is("scale")) window.rescale(line.number(1));
    else if (is("minimise", "restore")) window.minimise(what == "minimise");
    else if (is("from")) {
        const auto view = display::view_of_name(line.word(1));
        if (!view) throw Error(fmt::format("no view '{}'", line.word(1)));
        desk.scene().look_from(*view);
    } else if (is("stereo")) desk.scene().use_stereo(line.word(1));
    else if (is("head")) desk.scene().use_head(line.words.size() > 1 ? line.words[1] : "");
    else if (is("display")) desk.scene().use_display(line.words.size() > 1 ? line.words[1] : "");
    else if (is("offset")) desk.scene().use_offset(line.word(1));
    else if (is("screens")) desk.scene().show_screens(line.words.size() < 2 || line.words[1] != "off");
    else if (is("clip")) desk.scene().clip(static_cast<int>(line.number(1)), line.number(2));
    else if (is("measure")) desk.scene().is_measuring = true;
    else if (is("check")) bench.check_saved();
    else if (is("spots")) file::write_whole_file(line.word(1), spot_list() + desk.patch().place_list());
    else if (is("letters")) want_cut_letters(line.word(1));
    else if (is("say")) bench.tell(line.word(1));
    else if (is("layout")) {
        const auto layout = layout_of_name(line.word(1));
        if (!layout) throw Error(fmt::format("no layout '{}'", line.word(1)));
        desk.layout = *layout;
    } else if (is("shut")) window.close();
    else if (is("open")) {
        if (open) open(line.word(1));
    } else closes_ = true;
    return true;
}

}  // namespace tactus::window
