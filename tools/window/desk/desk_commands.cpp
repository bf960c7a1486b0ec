// SPDX-License-Identifier: Apache-2.0
// What can be done in the window, by name: what menus and keys have.
#include "tools/window/desk/desk.hpp"

#include "tools/window/desk/run_bar.hpp"

#include <fmt/format.h>

namespace tactus::window {

namespace fs = std::filesystem;

void Desk::add_file_commands(std::vector<Command>& all) {
    const auto is_patch = [this] { return take_ == nullptr; };
    all.push_back({"File", "New patch", "Ctrl+N", "empty canvas begin", [this] { wishes.new_patch = true; }});
    all.push_back({"File", "Open...", "Ctrl+O", "patch take plan file", [this] { ask_open(); }});
    all.push_back({"File", "Start page", "", "examples recent home", [this] { wishes.start_page = true; }});
    all.push_back({"File", "Save", "Ctrl+S", "write file", [this] { save(); },
                   [this] {
                       return !take_ && (!bench_.editor().is_saved() || bench_.is_untitled() ||
                                         nodes_.has_begun_edit() || (plan_document_ && !plan_document_->is_saved()));
                   },
                   nullptr, true});
    all.push_back(
        {"File", "Save as...", "Ctrl+Shift+S", "write copy another name", [this] { ask_save_as(); }, is_patch});
    all.push_back({"File", "Save the plan as...", "", "write case copy another name", [this] { ask_save_plan_as(); },
                   [this] { return !take_ && plan_.case_run().plan() != nullptr; }});
    all.push_back(
        {"File", "Make a bone of a scan or a mesh...", "", "import ct dicom stl", [this] { ask_import(); }, is_patch});
    all.push_back({"File", "Keep the layout in the patch", "", "window panels",
                   [this] { bench_.keep_layout(std::string(name_of(layout))); }, is_patch});
    all.push_back(
        {"File", "Close the window", "Ctrl+Q", "quit exit end", [this] { window_.close(); }, nullptr, nullptr, true});
}

void Desk::add_edit_commands(std::vector<Command>& all) {
    const auto may = [this] { return take_ == nullptr && sees_patch(); };
    const auto has_chosen = [may, this] { return may() && !patch_.chosen.empty(); };
    const auto has_any = [may, this] { return may() && patch_.has_chosen(); };
    const auto has_several = [may, this] { return may() && patch_.chosen.size() > 1; };
    using Align = PatchPanel::Align;
    all.push_back({"Edit", "Undo", "Ctrl+Z", "back revert", [this] { edit_buttons().undo(); },
                   [this] { return !start_page_.is_open && edit_buttons().can_undo; }});
    const auto can_redo = [this] { return !start_page_.is_open && edit_buttons().can_redo; };
    all.push_back({"Edit", "Redo", "Ctrl+Y", "again", [this] { edit_buttons().redo(); }, can_redo});
    all.push_back({"", "Redo", "Ctrl+Shift+Z", "again", [this] { edit_buttons().redo(); }, can_redo});
    all.push_back({"Edit", "Cut", "Ctrl+X", "nodes comments", [this] { patch_.cut(); }, has_any, nullptr, true});
    all.push_back({"Edit", "Copy", "Ctrl+C", "nodes comments", [this] { patch_.copy(); }, has_any});
    all.push_back({"Edit", "Paste", "Ctrl+V", "nodes comments", [this] { patch_.paste(); }, may});
    all.push_back({"Edit", "Duplicate", "Ctrl+D", "nodes comments copy", [this] { patch_.duplicate(); }, has_any});
    all.push_back({"Edit", "Remove", "Del", "delete nodes erase", [this] { patch_.remove_chosen(); }, has_any});
    all.push_back({"Edit", "Choose all", "Ctrl+A", "select nodes everything", [this] { patch_.choose_all(); },
                   [this] { return sees_patch(); }});
    all.push_back(
        {"Edit", "Add a node...", "Tab", "new insert create", [this] { patch_.open_palette(); }, may, nullptr, true});
    all.push_back({"Edit", "Add a sub-patch from a file...", "", "patch node part nest open", [this] { ask_part(); },
                   [this] { return take_ == nullptr && !start_page_.is_open; }});
    all.push_back({"Edit", "Add a comment", "", "note text box", [this] { patch_.add_comment(); }, may});
    all.push_back({"Edit", "Make a sub-patch of the chosen nodes...", "Ctrl+G", "group part nest",
                   [this] { patch_.make_sub_patch(); }, has_chosen});
    all.push_back({"", "Align left edges", "", "arrange", [this] { patch_.align(Align::left); }, has_several});
    all.push_back({"", "Align top edges", "", "arrange", [this] { patch_.align(Align::top); }, has_several});
    all.push_back(
        {"", "Align as a row", "", "arrange distribute", [this] { patch_.align(Align::columns); }, has_several});
    all.push_back(
        {"", "Align as a column", "", "arrange distribute", [this] { patch_.align(Align::rows); }, has_several});
    constexpr double step = 20.0;
    const auto move = [&](const char* keys, const char* name, Point by) {
        all.push_back({"", name, keys, "nodes nudge", [this, by] { patch_.nudge(by); }, has_any});
    };
    move("Ctrl+Left", "Move the nodes left", {-step, 0.0});
    move("Ctrl+Right", "Move the nodes right", {step, 0.0});
    move("Ctrl+Up", "Move the nodes up", {0.0, -step});
    move("Ctrl+Down", "Move the nodes down", {0.0, step});
}

void Desk::add_view_commands(std::vector<Command>& all) {
    for (const Layout each : {Layout::patch, Layout::plan, Layout::train})
        all.push_back({"View", fmt::format("Layout: {}", name_of(each)),
                       fmt::format("Ctrl+{}", 1 + static_cast<int>(each)), "panels window",
                       [this, each] { use_layout(each); }, nullptr, [this, each] { return layout == each; }});
    all.push_back(
        {"View", "Show the whole patch", "F", "fit zoom all", [this] { patch_.fit(); }, nullptr, nullptr, true});
    all.push_back({"View", "Small map", "", "minimap overview", [this] { patch_.has_minimap = !patch_.has_minimap; },
                   nullptr, [this] { return patch_.has_minimap; }});
    all.push_back({"View", "Look at the scene anew", "", "camera reset fit", [this] { scene_.reset(); }});
    all.push_back({"View", "List of node types", "", "catalogue library", [this] { nodes_.wants_catalogue = true; }});
    all.push_back({"Help", "Find a command...", "Ctrl+P", "palette search", [this] { list_.open(all_commands()); }});
    all.push_back({"Help", "Menus by keyboard", "F10", "open", [this] { wants_menus_ = true; }});
    all.push_back({"Help", "Keys", "F1", "shortcuts help", [this] { list_.open_help(); }});
}

void Desk::add_run_commands(std::vector<Command>& all) {
    if (take_) {
        all.push_back({"Take", "Play or stand", "Space", "", [this] { take_->play(!take_->is_playing()); }});
        all.push_back(
            {"Take", "Go to the largest force", "M", "maximum peak instant", [this] { go_to_largest_force(); }});
        all.push_back({"Take", "Go to the beginning", "Home", "start", [this] { take_->go_to(0.0); }});
        all.push_back({"Take", "Go to the end", "End", "", [this] { take_->go_to(take_->length()); }});
        all.push_back({"Take", "Back to the patch", "", "", [this] { bench_.wants_patch = true; },
                       [this] { return bench_.has_patch_behind; }});
        return;
    }
    using State = RunStatus::State;
    const auto runs = [this] { return bench_.running() && bench_.status()->state != State::over; };
    all.push_back(
        {"Run", "Run the patch", "F5", "start play go", [this] { bench_.run(); }, [runs] { return !runs(); }});
    all.push_back({"Run", "End the run", "", "stop", [this] { bench_.stop(); }, runs});
    all.push_back({"Run", "Pause or go on", "Space", "hold resume",
                   [this] { bench_.pause(bench_.status()->state == State::runs); }, runs});
    all.push_back({"Run", "Record a take", "Ctrl+R", "save log", [this] { bench_.record(!bench_.is_recording()); },
                   nullptr, [this, runs] { return runs() && bench_.is_recording(); }});
    all.push_back({"Run", "Hear the force", "", "sound tone audible sonify",
                   [this] { bench_.hear_force(!bench_.hears_force()); }, [this] { return bench_.can_hear_force(); },
                   [this] { return bench_.hears_force(); }});
    all.push_back({"Run", "Faults of this run", "", "history errors forces", [this] { show_faults(bench_); }});
    all.push_back({"Run", "Look at the take", "", "recording open", [this] { bench_.wants_take = true; },
                   [this, runs] {
                       return !runs() && !bench_.take().empty() && fs::exists(bench_.take() / "result.json") &&
                              bench_.editor().is_saved();
                   }});
}

std::vector<Command> Desk::make_commands() {
    std::vector<Command> all;
    add_file_commands(all);
    add_edit_commands(all);
    add_run_commands(all);
    add_view_commands(all);
    return all;
}

}  // namespace tactus::window
