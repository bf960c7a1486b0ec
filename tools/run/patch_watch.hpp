// SPDX-License-Identifier: Apache-2.0
// Detects that a patch file was saved, by any method of editors.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::run {

/// Watches the folder, because editors write a temporary file and rename it.
class PatchWatch {
public:
    /// Never throws; changes in a folder that cannot be watched are not detected.
    explicit PatchWatch(const std::filesystem::path& file);
    ~PatchWatch();
    PatchWatch(const PatchWatch&) = delete;
    PatchWatch& operator=(const PatchWatch&) = delete;

    bool is_working() const { return !files_.empty(); }
    /// Watches another patch file instead.
    void move_to(const std::filesystem::path& file);
    /// Replaces the list of additional files, the sub-patches.
    void follow(const std::vector<std::filesystem::path>& files);
    /// True once per save: a file was closed or renamed and then not changed for 100 ms. Does not block.
    bool was_saved();

private:
    struct Watched {
        int folder;  ///< inotify watch descriptor
        std::string name;
    };
    void watch(const std::filesystem::path& file);

    int descriptor_ = -1;
    std::vector<Watched> files_;  ///< the patch first
    std::optional<std::chrono::steady_clock::time_point> touched_;
};

}  // namespace tactus::run
