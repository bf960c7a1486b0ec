// SPDX-License-Identifier: Apache-2.0
// The folder that a run or a render writes to: its own for as long as it lasts, and what was there before is not written
// over unless that is asked for.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::session {

struct OutputChoice {
    std::filesystem::path folder;
    bool overwrite = false;  ///< results that are there may be written over
    bool is_numbered = false;  ///< a folder that is taken is left alone for FOLDER-2, FOLDER-3, …
    bool is_linked = false;  ///< a link FOLDER-latest leads to the folder that was taken
};

class OutputFolder {
public:
    /// Makes and locks the folder, and keeps room for the summary. Throws Error when it is not writable, another run
    /// writes to it, or it holds results.
    explicit OutputFolder(const OutputChoice& choice);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Writes summary.json into the room that was kept for it, so that a disk that is full by now still has it. Throws
    /// Error.
    void write_summary(std::string_view text);

private:
    /// Why it cannot be had; empty: it is ours.
    std::string take(const std::filesystem::path& folder, bool overwrite);
    void let_go();
    void reserve();

    std::filesystem::path path_, part_;
    int lock_ = -1, summary_ = -1;
};

}  // namespace tactus::session
