// SPDX-License-Identifier: Apache-2.0
// The dialog that makes a bone of a scan or a mesh.
#pragma once

#include "tools/window/files/scan_import.hpp"
#include "tools/window/widgets/painter.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace tactus::window {

class ImportDialog {
public:
    using Done = std::function<void(const std::filesystem::path& bone, const std::string& text)>;

    /// `done` gets the bone that was written, and words about it.
    void open(const std::filesystem::path& scan, const std::filesystem::path& folder, Done done);
    void draw(const Fonts& fonts);
    bool is_open() const { return is_open_; }

private:
    void ask(const Fonts& fonts);
    void show_progress(const Fonts& fonts);
    /// Begins, or sets `problem_`.
    void begin();
    void close();

    std::filesystem::path scan_;
    Done done_;
    std::string threshold_, out_, problem_;
    int unit_ = 0, parts_ = 0;
    bool is_open_ = false, wants_open_ = false, is_mesh_ = false;
    ScanImport import_;
};

}  // namespace tactus::window
