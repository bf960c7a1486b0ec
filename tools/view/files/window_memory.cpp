// SPDX-License-Identifier: Apache-2.0
#include "tools/view/files/window_memory.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"

#include <algorithm>
#include <cstdlib>

namespace tactus::view {

namespace fs = std::filesystem;
using file::Json;

namespace {

constexpr std::size_t most_recent = 20, most_layouts = 500, most_scans = 500;

std::string name_of_file(const fs::path& path) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored).string();
}

}  // namespace

fs::path WindowMemory::place() {
    const char *state = std::getenv("XDG_STATE_HOME"), *home = std::getenv("HOME");
    if (state && *state) return fs::path(state) / "tactus/window.json";
    if (home && *home) return fs::path(home) / ".local/state/tactus/window.json";
    return {};
}

WindowMemory::WindowMemory(fs::path file) : file_(std::move(file)) {
    std::error_code ignored;
    if (file_.empty() || !fs::is_regular_file(file_, ignored)) return;
    try {
        const Json root = Json::parse(file::read_whole_file(file_));
        if (const Json* recent = root.find("recent"))
            for (const Json& item : *recent)
                if (recent_.size() < most_recent) recent_.push_back(item.as_text());
        if (const Json* layouts = root.find("layouts"))
            for (const auto& [path, name] : layouts->items())
                if (const auto layout = layout_of_name(name.as_text()); layout && layouts_.size() < most_layouts)
                    layouts_[path] = *layout;
        if (const Json* scans = root.find("scans"))
            for (const auto& [plan, scan] : scans->items())
                if (scans_.size() < most_scans) scans_[plan] = scan.as_text();
    } catch (const std::exception&) {
        // What is damaged is forgotten; it is no patch.
        recent_.clear();
        layouts_.clear();
        scans_.clear();
    }
}

void WindowMemory::opened(const fs::path& what) {
    const std::string path = name_of_file(what);
    std::erase(recent_, path);
    recent_.insert(recent_.begin(), path);
    if (recent_.size() > most_recent) recent_.resize(most_recent);
    save();
}

std::optional<Layout> WindowMemory::layout_of(const fs::path& patch) const {
    const auto found = layouts_.find(name_of_file(patch));
    if (found == layouts_.end()) return std::nullopt;
    return found->second;
}

void WindowMemory::keep_layout(const fs::path& patch, Layout layout) {
    if (layouts_.size() >= most_layouts) layouts_.clear();
    layouts_[name_of_file(patch)] = layout;
    save();
}

fs::path WindowMemory::scan_of(const fs::path& plan) const {
    const auto found = scans_.find(name_of_file(plan));
    return found == scans_.end() ? fs::path() : fs::path(found->second);
}

void WindowMemory::keep_scan(const fs::path& plan, const fs::path& scan) {
    if (scans_.size() >= most_scans) scans_.clear();
    scans_[name_of_file(plan)] = name_of_file(scan);
    save();
}

void WindowMemory::save() const noexcept {
    if (file_.empty()) return;
    try {
        Json root = Json::object(), layouts = Json::object(), scans = Json::object();
        for (const auto& [path, layout] : layouts_) layouts[path] = std::string(name_of(layout));
        root["recent"] = Json(recent_);
        for (const auto& [plan, scan] : scans_) scans[plan] = scan;
        root["layouts"] = layouts;
        root["scans"] = scans;
        fs::create_directories(file_.parent_path());
        file::write_durable_file(file_, root.dump(2) + "\n");
    } catch (const std::exception&) {
        // A home that cannot be written only has no memory.
    }
}

}  // namespace tactus::view
