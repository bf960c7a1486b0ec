// SPDX-License-Identifier: Apache-2.0
// Notices that a patch file was saved, however the editor does it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::session {

/// Watches the folder, not the file: editors write beside and rename.
class PatchWatch {
public:
    /// Never throws; a folder that cannot be watched is never seen to change.
    explicit PatchWatch(const std::filesystem::path& file);
    ~PatchWatch();
    PatchWatch(const PatchWatch&) = delete;
    PatchWatch& operator=(const PatchWatch&) = delete;

    bool is_working() const { return !files_.empty(); }
    /// From now on these count as well, and no others that were told before: the patches within.
    void follow(const std::vector<std::filesystem::path>& files);
    /// True once per save: a file was closed or renamed, and then left alone for 100 ms. Never waits.
    bool was_saved();

private:
    struct Watched {
        int folder;  ///< as inotify numbers it
        std::string name;
    };
    void watch(const std::filesystem::path& file);

    int descriptor_ = -1;
    std::vector<Watched> files_;  ///< the patch first
    std::optional<std::chrono::steady_clock::time_point> touched_;
};

}  // namespace tactus::session
