// SPDX-License-Identifier: Apache-2.0
// Notices that a patch file was saved, however the editor does it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

namespace tactus {

/// Watches the folder, not the file: editors write beside and rename.
class PatchWatch {
public:
    /// Never throws; a folder that cannot be watched is never seen to change.
    explicit PatchWatch(const std::filesystem::path& file);
    ~PatchWatch();
    PatchWatch(const PatchWatch&) = delete;
    PatchWatch& operator=(const PatchWatch&) = delete;

    bool is_working() const { return descriptor_ >= 0; }
    /// True once per save: the file was closed or renamed, and then left alone for 100 ms. Never waits.
    bool was_saved();

private:
    std::filesystem::path name_;
    int descriptor_ = -1;
    std::optional<std::chrono::steady_clock::time_point> touched_;
};

}  // namespace tactus
