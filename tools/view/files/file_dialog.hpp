// SPDX-License-Identifier: Apache-2.0
// The window's own dialog for files to open and to save.
#pragma once

#include "tools/view/files/file_chooser.hpp"
#include "tools/view/painter.hpp"

#include <functional>
#include <optional>
#include <string>

namespace tactus::view {

class FileDialog {
public:
    using Done = std::function<void(const std::filesystem::path&)>;

    /// `done` gets the file. `hint`: shown above the files.
    void open(const std::string& title, FileChooser chooser, Done done);
    void draw(const Fonts& fonts);
    bool is_open() const { return chooser_.has_value(); }
    /// Says why a file is not taken, in the dialog that stays open.
    void refuse(const std::string& why);

private:
    void places();
    void files();
    /// The field of the name. True: entered.
    bool name();

    std::string title_;
    std::optional<FileChooser> chooser_;
    Done done_;
    bool wants_open_ = false, was_opened_ = false, wants_focus_ = false;
};

}  // namespace tactus::view
