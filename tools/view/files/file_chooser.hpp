// SPDX-License-Identifier: Apache-2.0
// The files of a folder to choose from, for the window's file dialog. No user interface.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::view {

class FileChooser {
public:
    enum class For { open, save };
    struct Entry {
        std::string name;
        bool is_folder = false;
        bool is_take = false;  ///< a folder that is opened as one thing
    };

    /// `endings`: of the files to show, in lower case, as ".toml"; empty: all. The first one is added to the name of a
    /// file to save.
    FileChooser(For what, std::filesystem::path folder, std::vector<std::string> endings);

    const std::filesystem::path& folder() const { return folder_; }
    /// Folders first, both in alphabetical order; files that begin with a dot are left out. Only those that suit the
    /// name typed so far, unless it is one of them.
    std::vector<Entry> entries() const;
    /// Shows another folder. False: it cannot be read; `problem` says why.
    bool go_to(const std::filesystem::path& folder);
    void go_up();
    /// Reads the folder again.
    void refresh() { go_to(std::filesystem::path(folder_)); }

    /// What was typed or chosen: a name, or a path from here, from "/" or from "~/".
    std::string name;
    /// Takes the name: a folder is shown and nothing returned; otherwise the file to open or to save. What cannot be
    /// is said in `problem`.
    std::optional<std::filesystem::path> accept();
    /// Chooses the next or the previous entry.
    void step(int by);

    std::string problem;
    bool takes_folders = false;  ///< folders of a scan are opened, by `accept_folder`
    std::optional<std::filesystem::path> accept_folder();

private:
    std::filesystem::path meant() const;

    For what_;
    std::filesystem::path folder_;
    std::vector<std::string> endings_;
    std::vector<Entry> all_;
};

}  // namespace tactus::view
