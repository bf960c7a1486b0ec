// SPDX-License-Identifier: Apache-2.0
// The window's own dialog for files to open and to save.
#pragma once

#include "tools/window/files/file_chooser.hpp"
#include "tools/window/widgets/painter.hpp"

#include <functional>
#include <optional>
#include <string>

namespace tactus::window {

class FileDialog {
public:
    using Done = std::function<void(const std::filesystem::path&)>;

    /// `done` gets the file; where it calls `refuse`, the dialog stays open. `replace`, of a file to save that exists
    /// and that the person agreed to replace; without it such a file is as any other.
    void open(const std::string& title, FileChooser chooser, Done done, Done replace = nullptr);
    void draw(const Fonts& fonts);
    bool is_open() const { return chooser_.has_value(); }
    /// Says why a file is not taken, in the dialog that stays open.
    void refuse(const std::string& why);

private:
    void places();
    void files();
    void tools();
    void finish(const Done& done, const std::filesystem::path& file);
    void ask_to_replace();
    /// The field of the name. True: entered.
    bool name();

    std::string title_;
    std::optional<FileChooser> chooser_;
    Done done_, replace_;
    int opened_ = 0;
    bool was_refused_ = false, makes_folder_ = false;
    std::string new_folder_;
    bool wants_open_ = false, was_opened_ = false, wants_focus_ = false;
};

}  // namespace tactus::window
