// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/workbench.hpp"

#include "tools/run/site_choice.hpp"

#include "assets/file/whole_file.hpp"
#include "graph/edit/patch_arrange.hpp"
#include "graph/patch/sub_patch.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/document/hand_of_patch.hpp"
#include "tools/window/document/patch_change.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <utility>

namespace tactus::window {

using run::find_patch;
using run::plan_of;

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_messages = 200;

std::string_view without_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

}  // namespace

Workbench::Workbench(const RunChoice& choice) : choice_(choice) {
    const fs::path file = run::file_of(choice);
    editor_ = std::make_unique<edit::PatchEditor>(choice.text ? *choice.text : file::read_whole_file(file), file,
                                                  [this](std::string_view text) { return refusal(text); });
    choice_.text.reset();
    check(editor_->text());
    adopt();
    tell_faults();
    tell_unfinished();
    last_take_ = choice.record;
}

std::string Workbench::title() const {
    return written_.title.empty() ? editor_->file().stem().string() : written_.title;
}

RunChoice Workbench::choice() const {
    RunChoice choice = choice_;
    choice.patch = editor_->file().string();
    choice.record.clear();
    // Whoever opens it again takes the hand anew.
    without_last(choice.overrides.settings, hand_settings_);
    return choice;
}

void Workbench::tell(std::string text, bool is_problem) {
    messages_.push_back({std::move(text), is_problem});
    ++told_;
    if (messages_.size() > max_messages) messages_.pop_front();
}

std::optional<std::string> Workbench::Judged::problem() const {
    if (faults.empty()) return std::nullopt;
    return faults.front().text;
}

Workbench::Judged Workbench::judge(std::string_view text) const {
    const fs::path file = editor_ ? editor_->file() : run::file_of(choice_);
    Judged judged;
    judged.running = without_mark(text);
    RecoveredPatch parts = recover_patch(judged.running, file, [this](patch::Patch patch, patch::Problems& problems) {
        return plan_of(std::move(patch), choice_.overrides, choice_.seed, nullptr, problems);
    });
    if (parts.faults.empty() && !parts.unfinished.empty())
        judged.running = edit::without_nodes(judged.running, parts.unfinished.names());
    judged.written = std::move(parts.written);
    judged.unfinished = std::move(parts.unfinished);
    judged.plan = std::move(parts.plan);
    judged.faults = std::move(parts.faults);
    return judged;
}

std::optional<std::string> Workbench::check(std::string_view text) {
    try {
        checked_ = judge(text);
    } catch (const Error& error) {
        checked_ = {};
        checked_.faults.push_back({error.what(), error.message(), 0, {}, {}, {}, {}, {}, {}});
    }
    return checked_.problem();
}

std::optional<std::string> Workbench::refusal(std::string_view text) {
    check(text);
    return refusal_of(faults_, checked_.faults);
}

/// Shows the plan that was checked last.
void Workbench::adopt() {
    faults_ = std::move(checked_.faults);
    plan_ = std::move(checked_.plan);
    written_ = std::move(checked_.written);
    unfinished_ = std::move(checked_.unfinished);
    running_text_ = std::move(checked_.running);
    checked_ = {};
    window_ = patch::window_of(without_mark(editor_->text()));
    PictureMatter matter{plan_.get(), &unfinished_, &window_, {}};
    for (const patch::PatchNode& node : written_.nodes)
        if (patch::is_sub_patch(node)) matter.parts.emplace_back(node.name, node.type);
    picture_ = picture_of(matter);
    ++plan_version_;
}

void Workbench::tell_faults() {
    if (faults_.empty()) return;
    tell(fmt::format("{}{}", faults_.front().text,
                     faults_.size() == 1 ? "" : fmt::format("; {} errors in all", faults_.size())),
         true);
}

void Workbench::tell_unfinished() {
    // The list of errors says why.
    if (unfinished_.empty() || is_broken()) return;
    const UnfinishedNode& first = unfinished_.nodes.front();
    const std::size_t others = unfinished_.nodes.size() - 1;
    tell(fmt::format("{} does not run yet: {}{}", first.name, first.lacks,
                     others == 0 ? "" : fmt::format("; nor do {} more", others)));
}

/// Handles a text changed by undo, or saved by another program.
void Workbench::adopt_text() {
    check(editor_->text());
    adopt();
    tell_faults();
    follow();
}

/// Applies the current text to the run, unless it does not compile.
void Workbench::follow() {
    if (!run_ || !plan_ || is_broken()) return;
    const PatchChange change = followed_ ? change_between(*followed_, *plan_) : PatchChange{{}, true};
    for (const PatchChange::Setting& s : change.settings) run_->set(s.node, s.param, s.value);
    if (change.needs_edit) run_->edit(running_text_);
    followed_ = plan_;
}

bool Workbench::edit(const edit::PatchEditor::Edit& how, std::string done) {
    const std::int64_t version = editor_->version();
    const std::size_t faults = faults_.size();
    if (const auto problem = editor_->apply(how)) {
        tell(*problem, true);
        return false;
    }
    if (editor_->version() == version) return true;
    adopt();
    follow();
    tell(std::move(done));
    if (faults > 0 && faults_.empty()) tell("no errors are left; the patch can run");
    tell_unfinished();
    return true;
}

namespace {

/// Where a parameter is written: nodes within a sub-patch have theirs by what that offers.
std::pair<std::string, std::string> owner_of(const Workbench& bench, const std::string& node,
                                             const std::string& param) {
    const std::string offered = node.find(patch::within_node) == std::string::npos ? "" : bench.offered_as(node, param);
    const std::size_t dot = offered.find('.');
    if (dot == std::string::npos) return {node, param};
    return {offered.substr(0, dot), offered.substr(dot + 1)};
}

}  // namespace

bool Workbench::set(const std::string& node, const std::string& param, const std::string& value) {
    const auto [owner, name] = owner_of(*this, node, param);
    return edit([&](std::string_view text) { return edit::with_setting(text, owner, name, value); },
                fmt::format("{}.{} = {}", owner, name, value));
}

bool Workbench::reset(const std::string& node, const std::string& param) {
    const auto [owner, name] = owner_of(*this, node, param);
    return edit([&](std::string_view text) { return edit::without_setting(text, owner, name); },
                fmt::format("{}.{} has its default", owner, name));
}

std::string Workbench::line(int number) const { return edit::line_of(editor_->text(), number); }

bool Workbench::replace_line(int number, const std::optional<std::string>& by) {
    return edit([&](std::string_view text) { return edit::with_line(text, number, by); },
                fmt::format("line {} {}", number, by ? "is changed" : "is removed"));
}

bool Workbench::correct(const Fault& fault) {
    return edit(
        [&](std::string_view text) {
            std::string here = edit::line_of(text, fault.line);
            const std::size_t at = edit::find_word(here, fault.wrong);
            if (at == std::string::npos) throw Error(fmt::format("'{}' is not in line {}", fault.wrong, fault.line));
            return edit::with_line(text, fault.line, here.replace(at, fault.wrong.size(), fault.suggestion));
        },
        fmt::format("'{}' is now '{}'", fault.wrong, fault.suggestion));
}

bool Workbench::cut_at(const Vec3& site) {
    patch::Problems problems;
    // A hundredth of a millimetre: no voxel is smaller.
    const Vec3 site_mm = glm::round(site * 1e5) * 1e-2;
    const auto settings = run::site_settings(patch::read_patch(editor_->text(), editor_->file(), problems), site_mm);
    if (settings.empty()) {
        tell("this patch has no bone to saw: a site needs a workspace or carve node with a bone", true);
        return false;
    }
    // What the command line said about the site does not hold any more.
    const std::vector<std::string> before = choice_.overrides.settings;
    std::erase_if(choice_.overrides.settings, [&](const std::string& given) {
        return std::ranges::any_of(settings,
                                   [&](const auto& s) { return given.starts_with(s.node + "." + s.param + "="); });
    });
    const bool is_made = edit(
        [&](std::string_view text) {
            std::string changed(text);
            for (const run::SiteSetting& s : settings) changed = edit::with_setting(changed, s.node, s.param, s.value);
            return changed;
        },
        fmt::format("the saw works at {:g}, {:g}, {:g} mm", site_mm.x, site_mm.y, site_mm.z));
    if (!is_made) choice_.overrides.settings = before;
    // The text may have named this site already, and the override hid it.
    else if (before.size() != choice_.overrides.settings.size()) adopt_text();
    return is_made;
}

bool Workbench::can_cut() const {
    return plan_ && std::ranges::any_of(plan_->nodes, [](const auto& node) { return node.type->name == "carve"; });
}

bool Workbench::add(const edit::NewNode& node) {
    return edit([&](std::string_view text) { return edit::with_node(text, node); },
                fmt::format("added {} of type {}", node.name, node.type));
}

bool Workbench::remove(const std::string& node) {
    return edit([&](std::string_view text) { return edit::without_node(text, node); }, fmt::format("removed {}", node));
}

bool Workbench::rename(const std::string& from, const std::string& to) {
    return edit([&](std::string_view text) { return edit::with_node_named(text, from, to); },
                fmt::format("{} is now {}", from, to));
}

bool Workbench::undo() {
    if (!editor_->can_undo()) return false;
    editor_->undo();
    adopt_text();
    return true;
}

bool Workbench::redo() {
    if (!editor_->can_redo()) return false;
    editor_->redo();
    adopt_text();
    return true;
}

void Workbench::check_saved() {
    const Judged saved = judge(file::read_whole_file(editor_->file()));
    if (const auto problem = saved.problem()) throw Error(*problem);
    const PatchChange change = plan_ && saved.plan ? change_between(*plan_, *saved.plan) : PatchChange{{}, true};
    if (change.needs_edit || !change.settings.empty())
        throw Error(fmt::format("{}: the saved file compiles to a different plan than the one shown",
                                editor_->file().string()));
}

void Workbench::turn(const std::string& node, const std::string& param, const std::string& value) {
    if (run_) run_->set(node, param, value);
}

void Workbench::run() {
    if (run_ && !run_->is_over()) return;
    if (!plan_ && !is_broken()) return tell("nothing runs yet: add nodes and give them their wires", true);
    try {
        if (const auto asset = asset_for_run && !next_goes_on_ ? asset_for_run() : std::nullopt)
            use_asset(asset->first, asset->second);
    } catch (const Error& error) {
        return tell(fmt::format("the run cannot begin: {}", error.what()), true);
    }
    run_.reset();
    assets_.forget_changed();
    goes_on_ = std::exchange(next_goes_on_, false);
    observer_ = std::make_shared<observe::Observer>();
    ++runs_;
    RunChoice choice = choice_;
    choice.patch = editor_->file().string();
    choice.keeps_journal = true;
    choice.is_further = choice.is_further || runs_ > 1;
    has_take_ = !choice.record.empty();
    // A text that does not compile is reported by the run.
    if (plan_ && !is_broken()) choice.text = running_text_;
    run_ = std::make_unique<ViewedRun>(choice, assets_, *observer_);
    // The next run makes another take.
    choice_.record.clear();
    followed_ = plan_;
}

void Workbench::stop() {
    if (run_) run_->stop();
}

void Workbench::press(const std::string& node) {
    if (run_) run_->press(node);
}

void Workbench::pause(bool wanted) {
    if (run_) run_->pause(wanted);
}

void Workbench::record(bool wanted) {
    const bool runs = run_ && !run_->is_over();
    if (!wanted) {
        if (runs) run_->stop_recording();
        return;
    }
    if (!runs || !has_take_) {
        const std::string stem = editor_->file().stem().string();
        last_take_.clear();
        for (int i = 1; last_take_.empty() || fs::exists(last_take_); ++i)
            last_take_ = choice_.out.parent_path() / fmt::format("{}-take-{}", stem, i);
    }
    has_take_ = true;
    if (runs) return run_->record(last_take_);
    choice_.record = last_take_;
    choice_.record_values = true;
    run();
}

std::shared_ptr<const RunStatus> Workbench::status() const {
    static const auto none = [] {
        auto status = std::make_shared<RunStatus>();
        status->state = RunStatus::State::over;
        return status;
    }();
    return run_ ? run_->status() : none;
}

void Workbench::tend() {
    change_hand();
    if (std::string problem = kept_.tend(edited(), has_unsaved_edits()); !problem.empty())
        tell(fmt::format("unsaved edits cannot be kept for a later window: {}", problem), true);
    if (!run_) return look_at_file();
    for (std::string& text : run_->messages()) {
        const bool is_failure = run_->is_over() && text == status()->failure;
        tell(std::move(text), is_failure);
    }
    go_back();
    if (run_->file_was_saved()) take_over_file();
    else if (run_->is_over()) look_at_file();
}

}  // namespace tactus::window
