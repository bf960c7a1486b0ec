// SPDX-License-Identifier: Apache-2.0
// A patch that is being edited: an edit that does not compile is refused, and each edit can be undone.
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
    /// What is wrong with a text, or nothing.
    using Check = std::function<std::optional<std::string>(std::string_view text)>;
    using Edit = std::function<std::string(std::string_view text)>;

    /// `file` is where `text` was read from.
    PatchEditor(std::string text, std::filesystem::path file, Check check);

    const std::string& text() const { return text_; }
    const std::filesystem::path& file() const { return file_; }
    /// Rises with every change of the text, also when one is undone.
    std::int64_t version() const { return version_; }

    /// Makes an edit. Returns why it was refused, or nothing; a refused edit does not change the text.
    std::optional<std::string> apply(const Edit& edit);
    bool can_undo() const { return done_ > 0; }
    bool can_redo() const { return done_ < steps_.size(); }
    void undo();
    void redo();

    /// The file holds the text.
    bool is_saved() const { return text_ == saved_; }
    /// Somebody else has changed the file since it was read or saved. Throws Error when it cannot be read.
    bool is_changed_elsewhere() const;
    /// Writes beside the file and renames, durably; a link stays one. Throws Error when somebody else changed the file
    /// since.
    void save();
    /// Another file, which is written durably, is the patch's from now on. `moved` makes every text of the history, the
    /// present one among them, one for that place. Throws Error; then all is as it was.
    void save_as(const std::filesystem::path& file, const Edit& moved);
    /// Replaces the text as one edit; it need not compile.
    void replace(std::string text) { keep(std::move(text)); }
    /// Reads a file that another program saved, as one edit. False: the text is the same.
    bool reload();

private:
    /// `removed` stood at `at` before and `added` stands there after.
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
