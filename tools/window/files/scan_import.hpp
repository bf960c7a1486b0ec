// SPDX-License-Identifier: Apache-2.0
// A scan or a mesh becomes a bone beside the pictures. No user interface.
#pragma once

#include "assets/bone/import.hpp"

#include <atomic>
#include <filesystem>
#include <future>
#include <mutex>
#include <optional>
#include <string>

namespace tactus::window {

class ScanImport {
public:
    ScanImport() = default;
    /// Stops, and waits until the import has noticed it: it writes a file.
    ~ScanImport();
    ScanImport(const ScanImport&) = delete;
    ScanImport& operator=(const ScanImport&) = delete;

    /// Begins on a thread of low priority. `out` must not exist.
    void begin(const bone::ImportOptions& options, const std::filesystem::path& out);
    void stop() { stops_ = true; }
    bool is_busy() const { return work_.valid(); }

    struct Progress {
        double share = 0.0;  ///< 0 to 1
        std::string doing;
    };
    Progress progress() const;

    struct Result {
        std::filesystem::path bone;  ///< empty: none was written
        std::string text;            ///< what was made, or why not
    };
    /// The result, once.
    std::optional<Result> take_result();

private:
    Result import(const bone::ImportOptions& options, const std::filesystem::path& out);

    std::future<Result> work_;
    std::atomic<bool> stops_{false};
    mutable std::mutex mutex_;
    Progress progress_;
};

/// A bone file that is not there: the scan's name with .vdb in that folder, or with a number.
std::filesystem::path free_bone(const std::filesystem::path& scan, const std::filesystem::path& folder);

}  // namespace tactus::window
