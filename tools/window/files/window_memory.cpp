// SPDX-License-Identifier: Apache-2.0
#include "tools/window/files/window_memory.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"

#include <algorithm>
#include <cstdlib>

namespace tactus::window {

namespace fs = std::filesystem;
using file::Json;

namespace {

constexpr std::size_t max_recent = 20, max_layouts = 500, max_scans = 500;

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

WindowMemory::WindowMemory(fs::path file) : file_(std::move(file)) { read(); }

/// What is damaged is as if it were not there; it is no patch.
void WindowMemory::read() noexcept {
    try {
        std::error_code ignored;
        if (file_.empty() || !fs::is_regular_file(file_, ignored)) return;
        const Json root = Json::parse(file::read_whole_file(file_));
        Known known;
        if (const Json* recent = root.find("recent"))
            for (const Json& item : *recent)
                if (known.recent.size() < max_recent) known.recent.push_back(item.as_text());
        if (const Json* layouts = root.find("layouts"))
            for (const auto& [path, name] : layouts->items())
                if (const auto layout = layout_of_name(name.as_text()); layout && known.layouts.size() < max_layouts)
                    known.layouts[path] = *layout;
        if (const Json* scans = root.find("scans"))
            for (const auto& [plan, scan] : scans->items())
                if (known.scans.size() < max_scans) known.scans[plan] = scan.as_text();
        if (const Json* borders = root.find("borders"))
            for (const auto& [path, text] : borders->items())
                if (known.borders.size() < max_layouts) known.borders[path] = text.as_text();
        known_ = std::move(known);
    } catch (const std::exception&) {
        // The memory of this window stays.
    }
}

void WindowMemory::opened(const fs::path& what) {
    const std::string path = name_of_file(what);
    // Another window may have written since.
    read();
    std::erase(known_.recent, path);
    known_.recent.insert(known_.recent.begin(), path);
    if (known_.recent.size() > max_recent) known_.recent.resize(max_recent);
    save();
}

std::optional<Layout> WindowMemory::layout_of(const fs::path& patch) const {
    const auto found = known_.layouts.find(name_of_file(patch));
    if (found == known_.layouts.end()) return std::nullopt;
    return found->second;
}

void WindowMemory::keep_layout(const fs::path& patch, Layout layout) {
    read();
    if (known_.layouts.size() >= max_layouts) known_.layouts.clear();
    known_.layouts[name_of_file(patch)] = layout;
    save();
}

fs::path WindowMemory::scan_of(const fs::path& plan) const {
    const auto found = known_.scans.find(name_of_file(plan));
    return found == known_.scans.end() ? fs::path() : fs::path(found->second);
}

void WindowMemory::keep_scan(const fs::path& plan, const fs::path& scan) {
    read();
    if (known_.scans.size() >= max_scans) known_.scans.clear();
    known_.scans[name_of_file(plan)] = name_of_file(scan);
    save();
}

std::string WindowMemory::borders_of(const fs::path& patch) const {
    const auto found = known_.borders.find(name_of_file(patch));
    return found == known_.borders.end() ? std::string() : found->second;
}

void WindowMemory::keep_borders(const fs::path& patch, const std::string& borders) {
    read();
    if (known_.borders.size() >= max_layouts) known_.borders.clear();
    known_.borders[name_of_file(patch)] = borders;
    save();
}

void WindowMemory::save() const noexcept {
    if (file_.empty()) return;
    try {
        Json root = Json::object(), layouts = Json::object(), scans = Json::object(), borders = Json::object();
        for (const auto& [path, layout] : known_.layouts) layouts[path] = std::string(name_of(layout));
        root["recent"] = Json(known_.recent);
        for (const auto& [plan, scan] : known_.scans) scans[plan] = scan;
        root["layouts"] = layouts;
        root["scans"] = scans;
        for (const auto& [path, text] : known_.borders) borders[path] = text;
        root["borders"] = borders;
        fs::create_directories(file_.parent_path());
        file::write_durable_file(file_, root.dump(2) + "\n");
    } catch (const std::exception&) {
        // A home that cannot be written only has no memory.
    }
}

}  // namespace tactus::window
