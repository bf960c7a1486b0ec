// SPDX-License-Identifier: Apache-2.0
// The file in which a window keeps its unsaved edits: written while it works, so that a window that dies loses little.
#pragma once

#include "graph/edit/patch_editor.hpp"

#include <chrono>
#include <filesystem>
#include <future>
#include <string>

namespace tactus::window {

/// Some window holds this file: its edits are not on offer.
bool is_in_use(const std::filesystem::path& kept);

class KeptEdits {
public:
    KeptEdits() = default;
    ~KeptEdits();
    KeptEdits(const KeptEdits&) = delete;
    KeptEdits& operator=(const KeptEdits&) = delete;

    /// Called once per frame. Edits that are `after` old are written by another thread, as a disk may be slow. A text
    /// that is the saved one again needs no file. Returns why edits could not be written, once; empty otherwise.
    std::string tend(const edit::PatchEditor& editor, bool has_unsaved_edits);
    /// Writes them at once, and lets other windows have the file. Throws Error.
    std::filesystem::path keep(const edit::PatchEditor& editor);
    /// Continues with a file whose edits were restored. It stays until the patch is saved.
    void continue_with(const std::filesystem::path& file);
    /// The edits are saved, or not wanted.
    void remove();

    std::chrono::milliseconds after{2000};

private:
    void finish();
    void hold();
    void let_go();

    std::filesystem::path file_;
    int lock_ = -1;  // held while this window lives
    bool was_restored_ = false;
    std::int64_t kept_version_ = -1, new_version_ = -1;
    std::chrono::steady_clock::time_point new_since_{};
    std::future<std::filesystem::path> written_;
    std::string problem_, told_;
};

}  // namespace tactus::window
