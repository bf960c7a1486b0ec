// SPDX-License-Identifier: Apache-2.0
// The output folder of a run or rendering: locked during the run; existing results are replaced only on request. A run
// that ends before it has written anything removes its folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::run {

struct OutputChoice {
    std::filesystem::path folder;
    bool overwrite = false;  ///< replace existing results
    bool is_numbered = false;  ///< use FOLDER-2, FOLDER-3, … when the folder is in use
    bool is_linked = false;  ///< create a link FOLDER-latest to the folder
};

class OutputFolder {
public:
    /// Creates and locks the folder and reserves disk space for the summary. Throws Error if it is not writable, is in
    /// use by another run, or has results.
    explicit OutputFolder(const OutputChoice& choice);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Writes summary.json into the reserved space, so that it succeeds on a full disk. Throws Error.
    void write_summary(std::string_view text);

private:
    /// Returns the reason why the folder cannot be used; empty: it is locked by this run.
    std::string take(const std::filesystem::path& folder, bool overwrite);
    void let_go();
    void reserve();
    void link();
    /// Removes the folders that this object created if nothing was written to them, and restores the link.
    void drop_if_empty();

    std::filesystem::path path_, part_;
    std::filesystem::path made_;  ///< the first folder of path_ that did not exist
    std::filesystem::path link_, linked_before_;
    int lock_ = -1, summary_ = -1;
};

}  // namespace tactus::run
