// SPDX-License-Identifier: Apache-2.0
// A patch while it is edited: every edit compiles or is refused, and any of them can be taken back.
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
    /// Rises with every change of the text, taken back or not.
    std::int64_t version() const { return version_; }

    /// Makes an edit. What it returns, when it is refused, is why; the text is as it was then.
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
    /// Another text, which may not compile, as an edit.
    void replace(std::string text) { keep(std::move(text)); }
    /// Takes over a file that was saved elsewhere, as an edit. False: the file holds nothing new.
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
