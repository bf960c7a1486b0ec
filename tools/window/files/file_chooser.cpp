// SPDX-License-Identifier: Apache-2.0
#include "tools/window/files/file_chooser.hpp"

#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace tactus::window {

namespace fs = std::filesystem;

FileChooser::FileChooser(For what, fs::path folder, std::vector<std::string> endings)
    : what_(what), endings_(std::move(endings)) {
    if (!go_to(folder)) go_to("/");
    problem.clear();
}

bool FileChooser::go_to(const fs::path& folder) {
    std::error_code failure;
    const fs::path wanted = fs::weakly_canonical(fs::absolute(folder, failure), failure);
    std::vector<Entry> found;
    fs::directory_iterator next(wanted, failure);
    if (failure) {
        problem = fmt::format("{}: {}", wanted.string(), failure.message());
        return false;
    }
    std::error_code ignored;
    for (const fs::directory_iterator end; !failure && next != end; next.increment(failure)) {
        const std::string file = next->path().filename().string();
        if (file.starts_with('.') && !shows_hidden_) continue;
        const fs::file_time_type when = next->last_write_time(ignored);
        if (next->is_directory(ignored)) {
            found.push_back({file, true, fs::exists(next->path() / "take.json", ignored), 0, when});
            continue;
        }
        const bool suits = endings_.empty() || std::ranges::any_of(endings_, [&](const std::string& ending) {
                               return lower(file).ends_with(ending);
                           });
        if (suits && next->is_regular_file(ignored))
            found.push_back({file, false, false, next->file_size(ignored), when});
    }
    folder_ = wanted;
    all_ = std::move(found);
    sort();
    problem.clear();
    replaced.reset();
    return true;
}

void FileChooser::sort() {
    std::ranges::sort(all_, [this](const Entry& a, const Entry& b) {
        if (a.is_folder != b.is_folder) return a.is_folder;
        if (order_ == Order::newest && a.when != b.when) return a.when > b.when;
        return std::pair(lower(a.name), a.name) < std::pair(lower(b.name), b.name);
    });
}

void FileChooser::sort_by(Order order) {
    order_ = order;
    sort();
}

void FileChooser::show_hidden(bool wanted) {
    shows_hidden_ = wanted;
    refresh();
}

bool FileChooser::make_folder(const std::string& folder) {
    std::error_code failure;
    const fs::path made = folder_ / folder;
    if (folder.empty()) problem = "type a name for the folder";
    else if (fs::exists(fs::symlink_status(made, failure))) problem = fmt::format("'{}' is there already", folder);
    else if (!fs::create_directory(made, failure))
        problem = fmt::format("'{}' cannot be made: {}", folder, failure.message());
    else return go_to(made);
    return false;
}

void FileChooser::go_up() {
    if (go_to(folder_.parent_path()) && what_ == For::open) name.clear();
}

std::vector<FileChooser::Entry> FileChooser::entries() const {
    const bool is_one = std::ranges::find(all_, name, &Entry::name) != all_.end();
    if (what_ == For::save || name.empty() || is_one || name.find('/') != std::string::npos) return all_;
    std::vector<Entry> some;
    for (const Entry& entry : all_)
        if (lower(entry.name).find(lower(name)) != std::string::npos) some.push_back(entry);
    return some;
}

void FileChooser::step(int by) {
    const bool is_one = std::ranges::find(all_, name, &Entry::name) != all_.end();
    const std::vector<Entry> shown = is_one ? all_ : entries();
    if (shown.empty()) return;
    const auto here = std::ranges::find(shown, name, &Entry::name);
    const int count = static_cast<int>(shown.size());
    const int now = here == shown.end() ? (by > 0 ? -1 : count) : static_cast<int>(here - shown.begin());
    name = shown[static_cast<std::size_t>(std::clamp(now + by, 0, count - 1))].name;
}

fs::path FileChooser::meant() const {
    const char* const home = std::getenv("HOME");
    if (home && (name == "~" || name.starts_with("~/")))
        return fs::path(home) / name.substr(std::min<std::size_t>(2, name.size()));
    return folder_ / name;
}

std::optional<fs::path> FileChooser::accept() {
    problem.clear();
    replaced.reset();
    if (name.empty()) {
        problem = "type or choose a name";
        return std::nullopt;
    }
    fs::path file = meant().lexically_normal();
    std::error_code ignored;
    // The only one that suits what was typed is meant.
    if (what_ == For::open && !fs::exists(file, ignored))
        if (const auto some = entries(); some.size() == 1) file = folder_ / some.front().name;
    if (fs::is_directory(file, ignored)) {
        if (what_ == For::open && fs::exists(file / "take.json", ignored)) return file;
        if (go_to(file)) name.clear();
        return std::nullopt;
    }
    if (what_ == For::open) {
        if (fs::exists(file, ignored)) return file;
        problem = fmt::format("there is no file '{}'", file.string());
        return std::nullopt;
    }
    // The stem is not empty, and an ending may have two parts: ".plan.json".
    const std::string typed = lower(file.filename().string());
    if (!endings_.empty() && (typed.size() <= endings_.front().size() || !typed.ends_with(endings_.front())))
        file += endings_.front();
    const fs::file_type there = fs::status(file, ignored).type();
    if (there == fs::file_type::regular) replaced = file;
    else if (fs::exists(fs::symlink_status(file, ignored)))
        problem = fmt::format("'{}' is no file; choose another name", file.filename().string());
    else if (!fs::is_directory(file.parent_path(), ignored))
        problem = fmt::format("there is no folder '{}'", file.parent_path().string());
    if (replaced || !problem.empty()) return std::nullopt;
    return file;
}

std::optional<fs::path> FileChooser::accept_folder() {
    std::error_code ignored;
    const fs::path file = name.empty() ? folder_ : meant().lexically_normal();
    if (fs::is_directory(file, ignored)) return file;
    // A slice was clicked: its folder is meant.
    if (fs::is_regular_file(file, ignored)) return file.parent_path();
    problem = "that is no folder";
    return std::nullopt;
}

}  // namespace tactus::window
