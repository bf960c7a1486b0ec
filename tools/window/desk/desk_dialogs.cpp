// SPDX-License-Identifier: Apache-2.0
// Dialogs for files and values, and what is saved.
#include "tools/window/desk/desk.hpp"

#include "dsp/core/error.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

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
    const bool is_own = !file.empty() && !run::is_of_library(file);
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

/// Undo and redo act on the plan unless the patch layout is shown; saving saves both.
EditButtons Desk::edit_buttons() {
    const bool is_saved = bench_.editor().is_saved() && (!plan_document_ || plan_document_->is_saved());
    if (!plan_document_ || layout == Layout::patch)
        return {bench_.editor().can_undo(), bench_.editor().can_redo(), is_saved,
                [this] { bench_.undo(); },  [this] { bench_.redo(); },  [this] { save(); }};
    CaseRun& run = plan_.case_run();
    const std::vector<StepLine>& steps = run.steps();
    const bool has_done = !steps.empty() && steps.front().is_done, has_undone = !steps.empty() && !steps.back().is_done;
    return {has_done && run.can_give(),
            has_undone && run.can_give(),
            is_saved,
            [&run] { run.give(plan::UndoStep{}); },
            [&run] { run.give(plan::RedoStep{}); },
            [this] { save(); }};
}

void Desk::save() {
    end_typing();
    const bool is_plan_saved = !plan_document_ || plan_document_->is_saved();
    if (!is_plan_saved) save_plan();
    // The patch in which a plan is shown is rarely changed.
    if (!plan_document_ || !bench_.editor().is_saved()) bench_.save();
}

void Desk::tell_saved(const plan::MergedAlternatives& changed) {
    std::string text = fmt::format("saved {}", plan_document_->file().string());
    for (const std::string& name : changed.added)
        text += fmt::format("; another program had changed it: its steps are the alternative '{}'", name);
    for (const std::string& name : changed.forwarded)
        text += fmt::format("; another program had changed it: '{}' has its steps, too", name);
    bench_.tell(std::move(text));
}

bool Desk::save_plan() {
    try {
        if (plan_document_->needs_name()) {
            wants_plan_name_ = true;
            return false;
        }
        tell_saved(plan_document_->save());
        return true;
    } catch (const std::exception& error) {
        bench_.tell(fmt::format("not saved: {}", error.what()), true);
        return false;
    }
}

void Desk::ask_save_plan_as() {
    const plan::CasePlan* const plan = plan_.case_run().plan();
    if (!plan) return bench_.tell("there is no plan to save", true);
    std::error_code ignored;
    const bool is_own = plan_document_ && !plan_document_->needs_name();
    FileChooser chooser(FileChooser::For::save, is_own ? plan_document_->folder() : fs::current_path(ignored),
                        {".plan.json"});
    chooser.name = plan_document_ ? plan_document_->file().filename().string() : std::string("case.plan.json");
    const auto save = [this](const fs::path& path, bool replaces) {
        try {
            const plan::CasePlan* const now = plan_.case_run().plan();
            if (!now) throw Error("there is no plan to save any more");
            plan::MergedAlternatives changed;
            if (plan_document_) changed = plan_document_->save_as(path, replaces);
            else {
                auto made = std::make_unique<PlanDocument>(std::make_shared<const plan::CasePlan>(*now), path);
                made->save_as(path, replaces);
                open_plan(std::move(made));
            }
            tell_saved(changed);
        } catch (const std::exception& error) {
            return dialog_.refuse(error.what());
        }
        questions.named(true);
        memory_.opened(opened_file());
        memory_.keep_layout(opened_file(), layout);
        show_title();
    };
    dialog_.open(
        "Save the plan as", std::move(chooser), [save](const fs::path& path) { save(path, false); },
        [save](const fs::path& path) { save(path, true); });
}

void Desk::open_plan(std::unique_ptr<PlanDocument> plan) {
    plan_document_ = std::move(plan);
    plan_.case_run().use(plan_document_.get());
    questions.use(plan_document_.get());
}

void Desk::tend_plan() {
    if (plan_document_) {
        if (std::string problem = plan_document_->tend(); !problem.empty()) bench_.tell(std::move(problem), true);
        if (std::exchange(shows_unsaved_, !plan_document_->is_saved()) == plan_document_->is_saved()) show_title();
    }
    const CaseRun& run = plan_.case_run();
    if (plan_document_) scene_.folder_of_results = run.folder_of_results();
    if (!run.is_there()) return;
    const RunStatus::State state = bench_.status()->state;
    const bool has_no_run = state == RunStatus::State::over || state == RunStatus::State::loading;
    if (plan_document_ && has_no_run) preview_.tend(plan_document_->newest(), run.scene_port());
    // In a run its bodies are for those that the mouse moves.
    else if (run.newest() && plan_.mover().needs_bodies()) preview_.tend(run.newest(), run.scene_port());
    plan_.mover().tend(preview_.parts());
    if (std::exchange(told_problem_, preview_.problem()) != preview_.problem() && !preview_.problem().empty())
        bench_.tell(preview_.problem(), true);
}

bool Desk::shows_preview() const {
    if (!plan_document_ || !preview_.observer()) return false;
    const RunStatus::State state = bench_.status()->state;
    return state == RunStatus::State::over || state == RunStatus::State::loading;
}

void Desk::keep_plan() noexcept {
    if (!plan_document_) return;
    plan_.case_run().take_what_waits();
    plan_document_->keep();
}

void Desk::ask_save_as() {
    end_typing();
    std::error_code ignored;
    const fs::path file = bench_.editor().file();
    const bool is_own = !bench_.is_untitled() && !run::is_of_library(file);
    FileChooser chooser(FileChooser::For::save,
                        is_own ? fs::absolute(file, ignored).parent_path() : fs::current_path(ignored), {".toml"});
    chooser.name = bench_.is_untitled() ? "" : bench_.free_file().filename().string();
    using Existing = Workbench::Existing;
    const auto save = [this](const fs::path& path, Existing existing) {
        if (!bench_.save_as(path.string(), existing)) return dialog_.refuse(bench_.messages().back().text);
        questions.named(true);
        memory_.opened(opened_file());
        memory_.keep_layout(opened_file(), layout);
        show_title();
    };
    dialog_.open(
        "Save the patch as", std::move(chooser), [save](const fs::path& path) { save(path, Existing::refuse); },
        [save](const fs::path& path) { save(path, Existing::replace); });
}

void Desk::show_title() {
    window_.set_title(plan_document_ ? fmt::format("{}{} - {} - Tactus", plan_document_->is_saved() ? "" : "* ",
                                                   plan_document_->file().filename().string(), bench_.title())
                                     : fmt::format("{} - Tactus", bench_.title()));
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
    value_.ask({node + "." + param, value, [this, node, param](const std::string& typed) {
                    constexpr std::string_view device = "devices.";
                    if (node.starts_with(device)) bench_.set_device(node.substr(device.size()), param, typed);
                    else bench_.set(node, param, typed);
                }});
}

void Desk::ask_device_setting() {
    value_.ask({"DEVICE.SETTING VALUE", "", [this](const std::string& typed) {
                    const std::size_t blank = typed.find(' '), dot = typed.find('.');
                    if (blank == std::string::npos || dot >= blank)
                        throw Error("write DEVICE.SETTING VALUE, as simulated.start_z 60 mm");
                    bench_.set_device(typed.substr(0, dot), typed.substr(dot + 1, blank - dot - 1),
                                      typed.substr(blank + 1));
                }});
}

void Desk::draw_dialogs() {
    // A patch without a place of its own needs one.
    if (bench_.wants_name && !dialog_.is_open()) {
        bench_.wants_name = false;
        ask_save_as();
    }
    if (wants_plan_name_ && !dialog_.is_open()) {
        wants_plan_name_ = false;
        ask_save_plan_as();
    }
    dialog_.draw(fonts_);
    import_.draw(fonts_);
    if (!dialog_.is_open()) questions.named(false);
    list_.draw(commands_, fonts_);
    value_.draw();
}

}  // namespace tactus::window
