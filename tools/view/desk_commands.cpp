// SPDX-License-Identifier: Apache-2.0
// What can be done in the window, by name, and the dialogs that it opens.
#include "tools/view/desk.hpp"

#include "nodes/catalogue.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/view/run_bar.hpp"
#include "tools/view/scene/hand_offer.hpp"
#include "tools/view/spots.hpp"
#include "tools/view/theme.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

namespace tactus::view {

namespace fs = std::filesystem;

void Desk::add_file_commands(std::vector<Command>& all) {
    const auto is_patch = [this] { return take_ == nullptr; };
    all.push_back({"File", "New patch", "Ctrl+N", "empty canvas begin", [this] { wishes.new_patch = true; }});
    all.push_back({"File", "Open...", "Ctrl+O", "patch take plan file", [this] { ask_open(); }});
    all.push_back({"File", "Start page", "", "examples recent home", [this] { wishes.start_page = true; }});
    all.push_back(
        {"File", "Save", "Ctrl+S", "write file", [this] { save(); },
         [this] { return !take_ && (!bench_.editor().is_saved() || bench_.is_untitled() || nodes_.has_begun_edit()); },
         nullptr, true});
    all.push_back(
        {"File", "Save as...", "Ctrl+Shift+S", "write copy another name", [this] { ask_save_as(); }, is_patch});
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
    all.push_back({"Edit", "Undo", "Ctrl+Z", "back revert", [this] { bench_.undo(); },
                   [this] { return !start_page_.is_open && bench_.editor().can_undo(); }});
    const auto can_redo = [this] { return !start_page_.is_open && bench_.editor().can_redo(); };
    all.push_back({"Edit", "Redo", "Ctrl+Y", "again", [this] { bench_.redo(); }, can_redo});
    all.push_back({"", "Redo", "Ctrl+Shift+Z", "again", [this] { bench_.redo(); }, can_redo});
    all.push_back({"Edit", "Cut", "Ctrl+X", "nodes", [this] { patch_.cut(); }, has_chosen, nullptr, true});
    all.push_back({"Edit", "Copy", "Ctrl+C", "nodes", [this] { patch_.copy(); }, has_chosen});
    all.push_back({"Edit", "Paste", "Ctrl+V", "nodes", [this] { patch_.paste(); }, may});
    all.push_back({"Edit", "Duplicate", "Ctrl+D", "nodes copy", [this] { patch_.duplicate(); }, has_chosen});
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

std::vector<Command> Desk::all_commands() {
    std::vector<Command> all = commands_;
    const PatchPicture& picture = bench_.picture();
    for (const PictureNode& node : picture.nodes)
        all.push_back({"go to", node.name, "", node.type, [this, name = node.name] {
                           patch_.selected = name;
                           patch_.look_at(name);
                       }});
    const std::string folder = (session::library_folder() / "patches").string();
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".toml")
            all.push_back({"open", "Open " + entry.path().stem().string(), "", "example",
                           [this, path = entry.path()] { wishes.open = path; }});
    const StartList nearby = start_list({}, fs::current_path(ignored), memory_.recent());
    for (const auto* list : {&nearby.recent, &nearby.takes, &nearby.plans})
        for (const StartItem& item : *list)
            all.push_back({"open", "Open " + item.title, "", "file recent take plan",
                           [this, path = item.path] { wishes.open = path; }});
    scene_.add_commands(all);
    if (shows(columns_, Panel::scopes)) scopes_.add_commands(all);
    if (take_) return all;
    add_hand_commands(bench_, all);
    plan_.add_commands(all);
    if (!take_) slices_.add_commands(all);
    for (const session::HandForces& forces : bench_.status()->forces)
        if (forces.state == control::ForceState::by_hand && !forces.node.empty())
            all.push_back(
                {"run", "Let forces return", "", "recover fault " + forces.device, [this, node = forces.node] {
                     if (bench_.running()) bench_.running()->recover(node);
                 }});
    for (const NodeType* type : nodes::catalogue())
        all.push_back({"add", "Add " + type->name, "", std::string(type->about), [this, name = type->name] {
                           if (const std::string made = bench_.add_node(name, bench_.lane_for(name)); !made.empty())
                               patch_.selected = made;
                       }});
    patch_.add_commands(all, sees_patch());
    if (!bench_.written().devices.empty())
        all.push_back({"set", "Set a device setting...", "", "DEVICE.SETTING VALUE, as simulated.start_z 60 mm",
                       [this] { ask_value("DEVICE.SETTING VALUE", "", ""); }});
    for (const patch::PatchDevice& device : bench_.written().devices)
        for (const OptionText& setting : device.settings)
            all.push_back(
                {"set", fmt::format("Set devices.{}.{}...", device.name, setting.name), "", "device",
                 [this, name = device.name, setting] { ask_value("devices." + name, setting.name, setting.text); }});
    if (const int index = picture.find(patch_.selected);
        index >= 0 && picture.nodes[static_cast<std::size_t>(index)].plan >= 0)
        for (const ParameterField& field :
             parameters_of(*bench_.plan(), picture.nodes[static_cast<std::size_t>(index)].plan))
            all.push_back({"set", fmt::format("Set {}.{}...", patch_.selected, field.name), "", field.about,
                           [this, node = patch_.selected, field] { ask_value(node, field.name, field.text); }});
    return all;
}

void Desk::use_layout(Layout wanted) {
    layout = wanted;
    memory_.keep_layout(opened_file(), wanted);
}

void Desk::ask_file(const std::string& title, FileChooser chooser, FileDialog::Done done) {
    dialog_.open(title, std::move(chooser), std::move(done));
}

void Desk::ask_open() {
    std::error_code ignored;
    const fs::path file = bench_.editor().file();
    const bool is_own = !file.empty() && !session::is_of_library(file);
    FileChooser chooser(FileChooser::For::open,
                        is_own ? fs::absolute(file, ignored).parent_path() : fs::current_path(ignored),
                        {".toml", ".plan.json"});
    ask_file("Open a patch, a take or a plan", std::move(chooser),
             [this](const fs::path& path) { wishes.open = path; });
}

void Desk::end_typing() {
    if (take_) return;
    nodes_.end_typing(patch_.selected);
    patch_.end_typing();
}

void Desk::save() {
    end_typing();
    bench_.save();
}

void Desk::ask_save_as() {
    end_typing();
    std::error_code ignored;
    const fs::path file = bench_.editor().file();
    const bool is_own = !bench_.is_untitled() && !session::is_of_library(file);
    FileChooser chooser(FileChooser::For::save,
                        is_own ? fs::absolute(file, ignored).parent_path() : fs::current_path(ignored), {".toml"});
    chooser.name = bench_.is_untitled() ? "" : bench_.free_file().filename().string();
    using Existing = Workbench::Existing;
    const auto save = [this](const fs::path& path, Existing existing) {
        if (!bench_.save_as(path.string(), existing)) return dialog_.refuse(bench_.messages().back().text);
        questions.named(true);
        plan_file.clear();
        memory_.opened(opened_file());
        memory_.keep_layout(opened_file(), layout);
        show_title();
    };
    dialog_.open(
        "Save the patch as", std::move(chooser), [save](const fs::path& path) { save(path, Existing::refuse); },
        [save](const fs::path& path) { save(path, Existing::replace); });
}

void Desk::show_title() {
    window_.set_title(plan_file.empty()
                          ? fmt::format("{} - Tactus", bench_.title())
                          : fmt::format("{} - {} - Tactus", plan_file.filename().string(), bench_.title()));
}

void Desk::ask_part() {
    FileChooser chooser(FileChooser::For::open, fs::absolute(bench_.editor().file()).parent_path(), {".toml"});
    ask_file("Add a patch as a node", std::move(chooser), [this](const fs::path& path) {
        if (const std::string made = bench_.add_part(path, ""); !made.empty()) patch_.selected = made;
    });
}

void Desk::ask_scan() {
    std::error_code ignored;
    FileChooser chooser(FileChooser::For::open, fs::current_path(ignored),
                        {".nrrd", ".nhdr", ".nii", ".nii.gz", ".dcm", ".zip", ".inv3"});
    chooser.takes_folders = true;
    ask_file("Open a scan: a CT, or a folder of DICOM", std::move(chooser), [this](const fs::path& path) {
        slices_.open(path);
        use_layout(Layout::plan);
    });
}

void Desk::ask_value(const std::string& node, const std::string& param, const std::string& value) {
    value_of_ = param.empty() ? node : node + "." + param;
    value_ = value;
    asks_value_ = true;
}

void Desk::draw_value() {
    constexpr const char* title = "value";
    if (std::exchange(asks_value_, false)) {
        ImGui::OpenPopup(title);
        ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    }
    if (!ImGui::BeginPopup(title)) return;
    ImGui::TextUnformatted(value_of_.c_str());
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(20.0f * ImGui::GetFontSize());
    const bool entered =
        ImGui::InputText("##value", &value_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    mark_spot("value");
    if (entered && value_of_.starts_with("DEVICE")) {
        const std::size_t blank = value_.find(' '), dot = value_.find('.');
        if (dot < blank && blank != std::string::npos)
            bench_.set_device(value_.substr(0, dot), value_.substr(dot + 1, blank - dot - 1), value_.substr(blank + 1));
        else bench_.tell("write DEVICE.SETTING VALUE, as simulated.start_z 60 mm", true);
        ImGui::CloseCurrentPopup();
    } else if (entered) {
        const std::size_t dot = value_of_.rfind('.');
        const std::string owner = value_of_.substr(0, dot), name = value_of_.substr(dot + 1);
        constexpr std::string_view device = "devices.";
        if (owner.starts_with(device)) bench_.set_device(owner.substr(device.size()), name, value_);
        else bench_.set(owner, name, value_);
        ImGui::CloseCurrentPopup();
    }
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void Desk::go_to_largest_force() {
    std::optional<TakeFeed::Peak> best;
    const auto look_at = [&](const std::string& port) {
        if (const auto peak = take_->feed().largest(port); peak && (!best || peak->value > best->value)) best = peak;
    };
    try {
        if (bench_.plan())
            for (const compile::PlanNode& node : bench_.plan()->nodes)
                if (node.type->role == NodeRole::hand_sink)
                    for (const compile::PlanOutput& output : node.outputs)
                        if (output.name == "applied") look_at(node.name + ".applied");
        // A patch without a hand has forces, too.
        if (!best)
            for (const Feed::Port& port : take_->feed().ports())
                if (port.type == &value::wrench) look_at(port.name);
    } catch (const Error& error) {
        return bench_.tell(error.what(), true);
    }
    if (!best) return bench_.tell("this take has no forces", true);
    take_->play(false);
    take_->go_to(best->when);
    patch_.selected = best->port.substr(0, best->port.find('.'));
    patch_.wants_scope = best->port;
    bench_.tell(fmt::format("largest force: {:.3f} N at {:.3f} s, {}", best->value, best->when, best->port));
}

void Desk::take_dropped(const fs::path& file) {
    const FileKind kind = kind_of_file(file);
    if (kind == FileKind::patch || kind == FileKind::take) wishes.open = file;
    else if (take_) bench_.tell("a take is read-only; run the patch to change it", true);
    else if (is_ct(file) && plan_.case_run().is_there()) {
        slices_.open(file);
        use_layout(Layout::plan);
    } else if (kind == FileKind::scan) import_scan(file, node_for_drop(), place_of_drop());
    else if (kind == FileKind::plan) wishes.open = file;
    else if (start_page_.is_open) bench_.tell("open a patch first, then drop " + file.filename().string(), true);
    else take_file(file, node_for_drop(), place_of_drop());
    if (wishes.any()) start_page_.is_open = false;
}

std::optional<Point> Desk::place_of_drop() const {
    return shows(columns_, Panel::patch) ? patch_.mouse_over() : std::nullopt;
}

std::string Desk::node_for_drop() const {
    const std::string under = shows(columns_, Panel::patch) ? patch_.node_under_mouse() : "";
    return under.empty() ? patch_.selected : under;
}

void Desk::take_file(const fs::path& file, const std::string& node, std::optional<Point> at) {
    if (const std::string taken = bench_.take_file(file, node, at); !taken.empty()) patch_.choose_only(taken);
}

void Desk::import_scan(const fs::path& scan, const std::string& node, std::optional<Point> at) {
    std::error_code ignored;
    const fs::path patch = bench_.editor().file();
    const bool is_own = !bench_.is_untitled() && !session::is_of_library(patch);
    import_.open(scan, is_own ? fs::absolute(patch).parent_path() : fs::current_path(ignored),
                 [this, node, at](const fs::path& bone, const std::string& text) {
                     bench_.tell(text);
                     if (!start_page_.is_open) take_file(bone, node, at);
                 });
}

void Desk::ask_import() {
    std::error_code ignored;
    FileChooser chooser(FileChooser::For::open, fs::current_path(ignored),
                        {".nrrd", ".nhdr", ".nii", ".nii.gz", ".dcm", ".zip", ".inv3", ".stl", ".ply", ".obj"});
    chooser.takes_folders = true;
    ask_file("Make a bone of a scan or a mesh", std::move(chooser),
             [this](const fs::path& path) { import_scan(path, patch_.selected, std::nullopt); });
}

void Desk::open_start_page() {
    start_page_.open();
    start_told_ = bench_.told();
}

/// The page has no list of messages: only what went wrong since it opened.
void Desk::draw_problem() {
    const auto& all = bench_.messages();
    const bool is_there = bench_.told() > start_told_ && !all.empty() && all.back().is_problem;
    const float wide = ImGui::GetContentRegionAvail().x;
    const char* const text = is_there ? all.back().text.c_str() : "";
    const float high =
        is_there ? ImGui::CalcTextSize(text, nullptr, false, wide).y + ImGui::GetStyle().ItemSpacing.y : 0.0f;
    ImGui::BeginChild("start", ImVec2(0.0f, is_there ? -high : 0.0f));
    start_page_.draw(fonts_);
    ImGui::EndChild();
    if (!is_there) return;
    ImGui::PushStyleColor(ImGuiCol_Text, tone::bad);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
    mark_spot("problem");
}

void Desk::draw_start() {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, vec({8.0 * fonts_.scale, 6.0 * fonts_.scale}));
    draw_problem();
    ImGui::PopStyleVar();
    scene_.rest();
    if (std::exchange(start_page_.wants_new, false)) wishes.new_patch = true;
    if (std::exchange(start_page_.wants_dialog, false)) ask_open();
    if (const auto path = std::exchange(start_page_.chosen, std::nullopt)) wishes.open = *path;
    const bool has_popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup) || dialog_.is_open() || list_.is_open();
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) && !has_popup) start_page_.is_open = false;
    ask_farewell();
    draw_dialogs();
    if (farewell != Farewell::asks && !dialog_.is_open()) questions.draw();
    if (std::exchange(questions.has_restored, false)) start_page_.is_open = false;
    ImGui::End();
    ImGui::PopFont();
}

void Desk::draw_dialogs() {
    // A patch without a place of its own needs one.
    if (bench_.wants_name && !dialog_.is_open()) {
        bench_.wants_name = false;
        ask_save_as();
    }
    dialog_.draw(fonts_);
    import_.draw(fonts_);
    if (!dialog_.is_open()) questions.named(false);
    list_.draw(commands_, fonts_);
    draw_value();
}

}  // namespace tactus::view
