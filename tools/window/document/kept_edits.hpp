// SPDX-License-Identifier: Apache-2.0
// The file in which a window keeps its unsaved edits: written while it works, so that a window that dies loses little.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <string>

namespace tactus::window {

/// Some window holds this file: its edits are not on offer.
bool is_in_use(const std::filesystem::path& kept);

/// A document as it is edited: a patch or a plan.
struct EditedText {
    std::filesystem::path file;
    std::int64_t version = 0;  ///< differs for every text
    bool is_saved = true;
    std::function<std::string()> text;
};

class KeptEdits {
public:
    /// `wait`: how old edits are when they are written.
    explicit KeptEdits(std::chrono::milliseconds wait = std::chrono::milliseconds(2000)) : after(wait) {}
    ~KeptEdits();
    KeptEdits(const KeptEdits&) = delete;
    KeptEdits& operator=(const KeptEdits&) = delete;

    /// Called once per frame. Edits that are `after` old are written by another thread, as a disk may be slow. A text
    /// that is the saved one again needs no file. Returns why edits could not be written, once; empty otherwise.
    std::string tend(const EditedText& edited, bool has_unsaved_edits);
    /// Writes them at once, and lets other windows have the file. Throws Error.
    std::filesystem::path keep(const EditedText& edited);
    /// Continues with a file whose edits were restored. It stays until the document is saved.
    void continue_with(const std::filesystem::path& file);
    /// The edits are saved, or not wanted.
    void remove();

    std::chrono::milliseconds after;

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
