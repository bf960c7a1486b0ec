// SPDX-License-Identifier: Apache-2.0
// The files of a folder to choose from, for the window's file dialog. No user interface.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class FileChooser {
public:
    enum class For { open, save };
    struct Entry {
        std::string name;
        bool is_folder = false;
        bool is_take = false;  ///< a folder that is opened as one thing
        std::uintmax_t size = 0;  ///< of a file, bytes
        std::filesystem::file_time_type when{};  ///< last written
    };

    /// `endings`: of the files to show, in lower case, as ".toml"; empty: all. The first one is added to the name of a
    /// file to save.
    FileChooser(For what, std::filesystem::path folder, std::vector<std::string> endings);

    const std::filesystem::path& folder() const { return folder_; }
    /// Folders first, both in the order wanted. Only those that suit the name typed so far, unless it is one of them.
    std::vector<Entry> entries() const;
    /// Shows another folder. False: it cannot be read; `problem` says why.
    bool go_to(const std::filesystem::path& folder);
    void go_up();
    /// Reads the folder again.
    void refresh() { go_to(std::filesystem::path(folder_)); }

    /// What was typed or chosen: a name, or a path from here, from "/" or from "~/".
    std::string name;
    /// Takes the name: a folder is shown and nothing returned; otherwise the file to open or to save. What cannot be
    /// is said in `problem`. A file to save that exists is returned as `replaced` instead.
    std::optional<std::filesystem::path> accept();
    /// Chooses the next or the previous entry.
    void step(int by);

    enum class Order { name, newest };
    Order order() const { return order_; }
    void sort_by(Order order);
    /// Whether files and folders that begin with a dot are listed.
    bool shows_hidden() const { return shows_hidden_; }
    void show_hidden(bool wanted);
    /// Makes a folder here and shows it. False: `problem` says why not.
    bool make_folder(const std::string& folder);

    /// A file to save that is there already: the person is asked first.
    std::optional<std::filesystem::path> replaced;

    std::string problem;
    bool takes_folders = false;  ///< folders of a scan are opened, by `accept_folder`
    std::optional<std::filesystem::path> accept_folder();

private:
    std::filesystem::path meant() const;
    void sort();

    For what_;
    std::filesystem::path folder_;
    std::vector<std::string> endings_;
    std::vector<Entry> all_;
    Order order_ = Order::name;
    bool shows_hidden_ = false;
};

}  // namespace tactus::window
