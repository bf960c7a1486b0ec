// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_paths.hpp"

#include "graph/edit/toml_spans.hpp"
#include "graph/patch/sub_patch.hpp"

#include <algorithm>
#include <functional>
#include <ranges>

namespace tactus::edit {

namespace {

std::string with_paths(std::string_view text, const std::filesystem::path& folder,
                       const std::function<std::string(const std::filesystem::path&)>& name_of) {
    std::string moved(text);
    TomlSpans spans = toml_spans(text);
    std::ranges::sort(spans.entries, {}, [](const TomlEntry& entry) { return entry.value.begin; });
    // From the end: spans before a replaced one stay where they are.
    for (const TomlEntry& entry : spans.entries | std::views::reverse) {
        const bool is_asset = entry.path.size() == 2 && entry.path[0] == "assets";
        const bool is_type = entry.path.size() == 3 && entry.path[0] == "nodes" && entry.path[2] == "type";
        const std::string_view written = entry.value.of(text);
        if (!(is_asset || is_type) || written.empty() || (written[0] != '"' && written[0] != '\'')) continue;
        std::string said = toml_unquoted(written), prefix;
        if (is_type) {
            if (!said.starts_with(patch::sub_patch_prefix)) continue;
            prefix = patch::sub_patch_prefix;
            said.erase(0, prefix.size());
        }
        if (said.empty() || std::filesystem::path(said).is_absolute()) continue;
        moved.replace(entry.value.begin, entry.value.end - entry.value.begin,
                      toml_quoted(prefix + name_of((folder / said).lexically_normal())));
    }
    return moved;
}

}  // namespace

std::string with_absolute_paths(std::string_view text, const std::filesystem::path& folder) {
    return with_paths(text, folder, [](const std::filesystem::path& file) { return file.string(); });
}

std::string with_paths_moved(std::string_view text, const std::filesystem::path& from,
                             const std::filesystem::path& to) {
    if ((from / "").lexically_normal() == (to / "").lexically_normal()) return std::string(text);
    return with_paths(text, from, [&](const std::filesystem::path& file) { return path_from(to, file); });
}

std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
    const std::filesystem::path near = file.lexically_normal().lexically_relative(folder.lexically_normal());
    if (near.empty() || near == "." || *near.begin() == "..") return file.lexically_normal().string();
    return near.string();
}

}  // namespace tactus::edit
