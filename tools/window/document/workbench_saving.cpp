// SPDX-License-Identifier: Apache-2.0
// Saving, edits that are not saved, and texts that other programs save.
#include "tools/window/document/workbench.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "graph/edit/patch_arrange.hpp"
#include "graph/edit/patch_paths.hpp"
#include "graph/patch/sub_patch.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/document/start_list.hpp"
#include "tools/window/document/unsaved.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <utility>
#include <vector>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

/// Where a new patch would be: in the working folder.
fs::path untitled_file(int number) {
    std::error_code ignored;
    const fs::path folder = fs::current_path(ignored);
    return folder / (number == 1 ? std::string("untitled.toml") : fmt::format("untitled-{}.toml", number));
}

struct GivenPlan {
    std::string asset;
    fs::path file;
};

/// The plans of cases that the patch was opened for.
std::vector<GivenPlan> plans_among(const std::vector<std::string>& assets) {
    std::vector<GivenPlan> plans;
    for (const std::string& given : assets) {
        const std::size_t sign = given.find('=');
        if (sign == std::string::npos) continue;
        const fs::path file = fs::absolute(given.substr(sign + 1));
        if (kind_of_file(file) == FileKind::plan) plans.push_back({given.substr(0, sign), file});
    }
    return plans;
}

}  // namespace

std::unique_ptr<Workbench> Workbench::untitled(RunChoice choice) {
    int number = 1;
    std::error_code ignored;
    while (fs::exists(untitled_file(number), ignored)) ++number;
    choice.patch = untitled_file(number).string();
    choice.text = "";
    choice.overrides = {};
    choice.record.clear();
    auto bench = std::make_unique<Workbench>(choice);
    bench->was_never_saved_ = true;
    return bench;
}

bool Workbench::is_untitled() const {
    std::error_code ignored;
    return was_never_saved_ || !fs::exists(editor_->file(), ignored);
}

bool Workbench::save() {
    try {
        if (run::is_of_library(editor_->file())) {
            wants_name = true;
            tell(fmt::format("{} belongs to the library and cannot be changed; save it under another name",
                             editor_->file().string()),
                 true);
            return false;
        }
        if (is_untitled()) {
            wants_name = true;
            return false;
        }
        if (editor_->is_changed_elsewhere()) {
            take_over_file();
            tell(
                "not saved: another program has saved this file, and its text is shown now; undo to your own text and "
                "save again",
                true);
            return false;
        }
        editor_->save();
        tell(fmt::format("saved {}", editor_->file().string()));
        kept_.remove();
        return true;
    } catch (const Error& error) {
        tell(error.what(), true);
        return false;
    }
}

fs::path Workbench::free_file() const {
    const std::string stem = editor_->file().stem().string();
    std::error_code ignored;
    const fs::path folder = fs::current_path(ignored);
    fs::path file = folder / (stem + ".toml");
    for (int i = 2; fs::exists(file, ignored); ++i) file = folder / fmt::format("{}-{}.toml", stem, i);
    return file;
}

bool Workbench::save_as(const std::string& name, Existing existing) {
    try {
        if (name.empty()) throw Error("a file needs a name");
        fs::path file = fs::absolute(name);
        // Whoever replaces a file has named it whole.
        if (file.extension() != ".toml" && existing == Existing::refuse) file += ".toml";
        if (run::is_of_library(file))
            throw Error(fmt::format("{}: this file belongs to the library; choose another", file.string()));
        if (fs::exists(fs::symlink_status(file)) && existing == Existing::refuse)
            throw Error(fmt::format("{}: the file exists already; choose another name", file.string()));
        // A link stays one.
        if (fs::exists(file)) file = fs::canonical(file);
        if (fs::is_directory(file))
            throw Error(fmt::format("{}: this is a folder; choose another name", file.string()));
        const fs::path from = fs::absolute(editor_->file()), folder = from.parent_path(), to = file.parent_path();
        const bool is_of_library = run::is_of_library(from);
        const std::vector<GivenPlan> plans = plans_among(choice_.overrides.assets);
        editor_->save_as(file, [&](std::string_view text) {
            std::string moved =
                is_of_library ? edit::with_absolute_paths(text, folder) : edit::with_paths_moved(text, folder, to);
            for (const GivenPlan& plan : plans)
                moved = edit::with_asset(moved, plan.asset, edit::path_from(to, plan.file));
            return moved;
        });
        // The text says it now.
        for (const GivenPlan& plan : plans)
            std::erase_if(choice_.overrides.assets,
                          [&](const std::string& given) { return given.starts_with(plan.asset + "="); });
        was_never_saved_ = false;
        if (run_) run_->move_to(file);
        written_at_.clear();
        wants_name = false;
        std::string said = fmt::format("saved {}", file.string());
        for (const GivenPlan& plan : plans) said += fmt::format(", with the plan {}", plan.file.string());
        tell(std::move(said));
        kept_.remove();
        // The same patch in another folder: nothing to apply to the run.
        if (const auto problem = check(editor_->text())) tell(*problem, true);
        adopt();
        if (followed_ && plan_) followed_ = plan_;
        return true;
    } catch (const std::exception& error) {
        tell(error.what(), true);
        return false;
    }
}

bool Workbench::has_unsaved_edits() const { return !editor_->is_saved() && editor_->version() != dropped_version_; }

void Workbench::drop_edits() {
    dropped_version_ = editor_->version();
    kept_.remove();
}

EditedText Workbench::edited() const {
    return {editor_->file(), editor_->version(), editor_->is_saved(), [this] { return editor_->text(); }};
}

void Workbench::keep_edits() noexcept {
    if (!has_unsaved_edits()) return;
    try {
        const fs::path kept = kept_.keep(edited());
        dropped_version_ = editor_->version();
        fmt::print(stderr, "tactus: unsaved edits of {} are kept in {}; the next window offers to restore them\n",
                   editor_->file().string(), kept.string());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tactus: unsaved edits are lost: %s\n", error.what());
    }
}

void Workbench::find_kept_edits() {
    std::vector<fs::path> all = find_unsaved(editor_->file());
    // An earlier new patch may have had another number.
    constexpr int max_untitled = 9;
    for (int i = 1; is_untitled() && i <= max_untitled; ++i) {
        const fs::path other = untitled_file(i);
        std::error_code ignored;
        if (other == editor_->file() || fs::exists(other, ignored)) continue;
        for (fs::path& file : find_unsaved(other)) all.push_back(std::move(file));
    }
    for (const fs::path& file : all) try {
            if (is_in_use(file)) continue;
            // Saved in the meantime by another program.
            if (file::read_whole_file(file) == editor_->text()) fs::remove(file);
            else offers_.push_back(file);
        } catch (const std::exception& error) {
            tell(error.what(), true);
        }
}

std::optional<fs::path> Workbench::offer() const {
    if (offers_.empty()) return std::nullopt;
    return offers_.back();
}

bool Workbench::restore_edits() {
    if (offers_.empty()) return false;
    try {
        const fs::path file = offers_.back();
        std::string text = file::read_whole_file(file);
        offers_.pop_back();
        // Edits restored earlier keep their file.
        kept_.continue_with(file);
        editor_->replace(std::move(text));
        tell(fmt::format("the edits of {} are restored; undo reverts them", file.string()));
        adopt_text();
        return true;
    } catch (const Error& error) {
        offers_.pop_back();
        tell(error.what(), true);
        return false;
    }
}

void Workbench::discard_offer() {
    if (offers_.empty()) return;
    std::error_code failure;
    fs::remove(offers_.back(), failure);
    if (failure) tell(fmt::format("{}: cannot be removed: {}", offers_.back().string(), failure.message()), true);
    offers_.pop_back();
}

void Workbench::postpone_offer() {
    if (!offers_.empty()) offers_.pop_back();
}

/// A run watches the file; without one it is looked at twice a second.
void Workbench::look_at_file() {
    constexpr auto between = std::chrono::milliseconds(500);
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < between) return;
    looked_ = now;
    std::vector<fs::path> files;
    if (!was_never_saved_) files.push_back(editor_->file());
    if (plan_ && !is_broken()) {
        for (const fs::path& part : patch::part_files(plan_->patch)) files.push_back(part);
    } else {
        // A sub-patch that is wrong may be mended.
        for (const auto& [file, when] : written_at_) files.push_back(file);
        for (const patch::PatchNode& node : written_.nodes)
            if (patch::is_sub_patch(node))
                files.push_back(patch::file_of_part(written_, patch::part_path("", node.type)));
    }
    WrittenAt now_written;
    bool is_saved = written_at_.empty(), is_part_saved = false;
    for (const fs::path& file : files) {
        std::error_code none;
        const auto known = written_at_.find(file);
        const auto when = fs::last_write_time(file, none);
        if (none && known != written_at_.end()) now_written.insert(*known);
        if (none) continue;
        now_written[file] = when;
        if (known == written_at_.end() || known->second == when) continue;
        (file == editor_->file() ? is_saved : is_part_saved) = true;
    }
    written_at_ = std::move(now_written);
    try {
        if (is_part_saved || (is_saved && editor_->is_changed_elsewhere())) take_over_file();
    } catch (const Error& error) {
        tell(error.what(), true);
    }
}

bool Workbench::has_same_parts() {
    check(editor_->text());
    return checked_.plan && checked_.plan->patch.parts == plan_->patch.parts;
}

void Workbench::keep_beside(const std::string& text) {
    try {
        tell(fmt::format("your edits that were not saved are kept in {}; undo shows them again",
                         keep_unsaved(editor_->file(), text).string()));
    } catch (const Error& error) {
        tell(fmt::format("{}; undo shows your edits that were not saved", error.message()), true);
    }
}

/// Applied as an edit, which can be undone. Edits that are not saved are kept beside the patch as well: who saves what
/// was taken over, or closes the window, still has them.
void Workbench::take_over_file() {
    try {
        const std::string mine = editor_->is_saved() ? std::string() : editor_->text();
        const bool is_new = !was_never_saved_ && editor_->reload();
        if (is_new && !mine.empty()) keep_beside(mine);
        // A sub-patch may have been saved instead.
        const bool is_known = !is_new && plan_ && !is_broken() && (plan_->patch.parts.empty() || has_same_parts());
        if (is_known) return;
        tell(is_new ? "the file was saved by another program; its text is used now"
                    : "a sub-patch was saved by another program; it is used now");
        adopt_text();
    } catch (const Error& error) {
        tell(error.what(), true);
    }
}

}  // namespace tactus::window
