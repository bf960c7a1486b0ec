// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/start_list.hpp"

#include "dsp/core/lower.hpp"
#include "graph/patch/patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_found = 40;

std::vector<fs::path> sorted_content(const fs::path& folder) {
    std::vector<fs::path> all;
    std::error_code failure;
    fs::directory_iterator next(folder, failure);
    for (const fs::directory_iterator end; !failure && next != end; next.increment(failure))
        if (!next->path().filename().string().starts_with('.')) all.push_back(next->path());
    std::ranges::sort(all);
    return all;
}

std::string title_of(const fs::path& patch) {
    patch::Problems ignored;
    try {
        const std::string title = patch::load_patch(patch, ignored).title;
        if (!title.empty()) return title;
    } catch (const std::exception&) {
        // Listed by its name; opening it says what is wrong.
    }
    return patch.stem().string();
}

bool is_take(const fs::path& folder) {
    std::error_code ignored;
    return fs::exists(folder / "take.json", ignored);
}

void find_nearby(const fs::path& folder, int deep, StartList& into) {
    for (const fs::path& path : sorted_content(folder)) {
        std::error_code ignored;
        // The link names one of the folders beside it.
        const bool is_folder = fs::is_directory(path, ignored) && !fs::is_symlink(path, ignored);
        const std::string name = path.filename().string();
        if (is_folder && is_take(path)) {
            if (into.takes.size() < max_found) into.takes.push_back({name, folder.filename().string(), path, {}});
        } else if (is_folder && deep > 0) find_nearby(path, deep - 1, into);
        else if (name.ends_with(".plan.json") && into.plans.size() < max_found)
            into.plans.push_back({name, folder.filename().string(), path, {}});
    }
}

}  // namespace

StartList start_list(const fs::path& library, const fs::path& folder, const std::vector<std::string>& recent) {
    StartList list;
    std::error_code ignored;
    for (const fs::path& patch : sorted_content(library / "patches")) {
        if (patch.extension() != ".toml") continue;
        const fs::path picture = library / "pictures" / (patch.stem().string() + ".png");
        list.examples.push_back(
            {title_of(patch), patch.stem().string(), patch, fs::exists(picture, ignored) ? picture : fs::path()});
    }
    for (const std::string& path : recent)
        if (fs::exists(path, ignored)) {
            const fs::path file(path);
            list.recent.push_back({file.filename().string(), file.parent_path().string(), file, {}});
        }
    find_nearby(folder, 1, list);
    return list;
}

FileKind kind_of_file(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return is_take(path) ? FileKind::take : FileKind::scan;
    const std::string name = lower(path.filename().string());
    struct Ending {
        std::string_view text;
        FileKind kind;
    };
    static constexpr std::array<Ending, 24> endings{
        {{".plan.json", FileKind::plan}, {".toml", FileKind::patch}, {".vdb", FileKind::bone},
         {".nrrd", FileKind::scan},      {".nhdr", FileKind::scan},  {".nii", FileKind::scan},
         {".nii.gz", FileKind::scan},    {".dcm", FileKind::scan},   {".zip", FileKind::scan},
         {".inv3", FileKind::scan},      {".hdr", FileKind::scan},   {".stl", FileKind::scan},
         {".ply", FileKind::scan},       {".obj", FileKind::scan},   {".wav", FileKind::sound},
         {".flac", FileKind::sound},     {".ogg", FileKind::sound},  {".aiff", FileKind::sound},
         {".aif", FileKind::sound},      {".mp3", FileKind::sound},  {".w64", FileKind::sound},
         {".csv", FileKind::table},      {".txt", FileKind::table},  {".json", FileKind::table}}};
    for (const Ending& ending : endings)
        if (name.ends_with(ending.text)) return ending.kind;
    return FileKind::unknown;
}

bool is_ct(const fs::path& path) {
    const std::string name = lower(path.filename().string());
    return kind_of_file(path) == FileKind::scan && !name.ends_with(".stl") && !name.ends_with(".ply") &&
           !name.ends_with(".obj");
}

std::vector<std::string> endings_of_asset(std::string_view type_name) {
    const std::string type(type_name);
    if (type == "sound") return {".wav", ".flac", ".ogg", ".aiff", ".aif", ".mp3", ".w64"};
    if (type == "bone") return {".vdb"};
    if (type == "plan of a case") return {".plan.json"};
    if (type == "recording set" || type == "equaliser") return {".toml", ".json"};
    if (type == "deflection table") return {".csv"};
    return {};
}

}  // namespace tactus::window
