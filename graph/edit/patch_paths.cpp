// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_paths.hpp"

#include "graph/edit/toml_spans.hpp"
#include "graph/patch/sub_patch.hpp"

#include <algorithm>
#include <ranges>

namespace tactus::edit {

std::string with_absolute_paths(std::string_view text, const std::filesystem::path& folder) {
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
                      toml_quoted(prefix + (folder / said).lexically_normal().string()));
    }
    return moved;
}

}  // namespace tactus::edit
