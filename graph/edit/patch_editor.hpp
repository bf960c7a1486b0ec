// SPDX-License-Identifier: Apache-2.0
// A patch that is being edited: edits that do not compile are rejected, and each edit can be undone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::edit {

class PatchEditor {
public:
    /// Returns the error of a text, or nothing if it is valid.
    using Check = std::function<std::optional<std::string>(std::string_view text)>;
    using Edit = std::function<std::string(std::string_view text)>;

    /// `file` is the file from which `text` was read.
    PatchEditor(std::string text, std::filesystem::path file, Check check);

    const std::string& text() const { return text_; }
    const std::filesystem::path& file() const { return file_; }
    /// Increases with every change of the text, including undo.
    std::int64_t version() const { return version_; }

    /// Applies an edit. Returns the reason if it was rejected, or nothing; a rejected edit does not change the text.
    std::optional<std::string> apply(const Edit& edit);
    bool can_undo() const { return done_ > 0; }
    bool can_redo() const { return done_ < steps_.size(); }
    void undo();
    void redo();

    /// True if the file holds the current text.
    bool is_saved() const { return text_ == saved_; }
    /// True if another program has changed the file since it was read or saved. Throws Error if it cannot be read.
    bool is_changed_elsewhere() const;
    /// Saves atomically and durably: writes a temporary file beside the target and renames it. A symbolic link stays
    /// one. Throws Error if another program has changed the file since it was read or saved.
    void save();
    /// Saves to another file, durably, and continues with it. `moved` adapts every text of the history, including the
    /// current one, to the new folder. On Error nothing has changed.
    void save_as(const std::filesystem::path& file, const Edit& moved);
    /// Replaces the text as one edit; it need not compile.
    void replace(std::string text) { keep(std::move(text)); }
    /// Reloads a file that another program saved, as one edit. Returns false if the text is the same.
    bool reload();

private:
    /// A replacement of `removed` by `added` at offset `at`.
    struct Step {
        std::size_t at;
        std::string removed, added;
    };
    void keep(std::string text);

    std::string text_, saved_;
    std::filesystem::path file_;
    Check check_;
    std::vector<Step> steps_;
    std::size_t done_ = 0;
    std::int64_t version_ = 0;
};

}  // namespace tactus::edit
