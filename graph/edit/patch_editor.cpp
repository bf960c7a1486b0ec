// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_editor.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::edit {

PatchEditor::PatchEditor(std::string text, std::filesystem::path file, Check check)
    : text_(std::move(text)), saved_(text_), file_(std::move(file)), check_(std::move(check)) {}

/// One step of the history: the part of the text that differs.
void PatchEditor::keep(std::string text) {
    if (text == text_) return;
    const auto begin = std::mismatch(text_.begin(), text_.end(), text.begin(), text.end());
    const auto at = static_cast<std::size_t>(begin.first - text_.begin());
    const std::size_t shorter = std::min(text_.size(), text.size()) - at;
    std::size_t same = 0;
    while (same < shorter && text_[text_.size() - 1 - same] == text[text.size() - 1 - same]) ++same;
    steps_.resize(done_);
    steps_.push_back({at, text_.substr(at, text_.size() - same - at), text.substr(at, text.size() - same - at)});
    ++done_;
    ++version_;
    text_ = std::move(text);
}

std::optional<std::string> PatchEditor::apply(const Edit& edit) {
    try {
        std::string text = edit(text_);
        if (std::optional<std::string> problem = check_(text)) return problem;
        keep(std::move(text));
    } catch (const Error& error) {
        return error.what();
    }
    return std::nullopt;
}

void PatchEditor::undo() {
    if (!can_undo()) return;
    const Step& step = steps_[--done_];
    text_.replace(step.at, step.added.size(), step.removed);
    ++version_;
}

void PatchEditor::redo() {
    if (!can_redo()) return;
    const Step& step = steps_[done_++];
    text_.replace(step.at, step.removed.size(), step.added);
    ++version_;
}

bool PatchEditor::is_changed_elsewhere() const {
    return std::filesystem::exists(file_) && file::read_whole_file(file_) != saved_;
}

void PatchEditor::save() {
    if (is_changed_elsewhere())
        throw Error(fmt::format("{}: somebody else has changed the file; it is taken over before yours can be saved",
                                file_.string()));
    std::error_code failure;
    const std::filesystem::path target = std::filesystem::canonical(file_, failure);
    file::write_durable_file(failure ? file_ : target, text_);
    saved_ = text_;
}

void PatchEditor::save_as(const std::filesystem::path& file, const Edit& moved) {
    PatchEditor old = *this;
    while (old.can_undo()) old.undo();
    PatchEditor fresh(moved(old.text_), file, check_);
    std::size_t here = 0;
    while (old.can_redo()) {
        old.redo();
        fresh.keep(moved(old.text_));
        if (old.done_ == done_) here = fresh.done_;
    }
    while (fresh.done_ > here) fresh.undo();
    file::write_durable_file(file, fresh.text_);
    fresh.saved_ = fresh.text_;
    fresh.version_ = version_ + 1;
    *this = std::move(fresh);
}

bool PatchEditor::reload() {
    std::string text = file::read_whole_file(file_);
    if (text == saved_) return false;
    saved_ = text;
    const bool is_new = text != text_;
    keep(std::move(text));
    return is_new;
}

}  // namespace tactus::edit
