// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/load_assets.hpp"

#include <fmt/format.h>

#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace tactus::compile {

AssetCache::Stamp AssetCache::stamp_of(const std::string& path) {
    std::error_code none;
    // A name may lead into a file, as to a bone: "two.vdb#label_2".
    const std::filesystem::path file = path.substr(0, path.find('#'));
    if (!std::filesystem::is_regular_file(file, none)) return {};
    const auto written = std::filesystem::last_write_time(file, none);
    const auto size = std::filesystem::file_size(file, none);
    return none ? Stamp{} : Stamp{written, size};
}

void AssetCache::forget_changed() {
    std::erase_if(loaded_, [](const auto& one) { return one.second.stamp != stamp_of(one.first.second); });
}

void AssetCache::load(Schedule& plan, patch::Problems& problems) {
    std::unordered_map<std::string_view, const patch::PatchAsset*> sources;
    for (const patch::PatchAsset& asset : plan.patch.assets) sources.emplace(asset.name, &asset);
    std::unordered_set<std::string> failed;
    for (ScheduleNode& node : plan.nodes) {
        for (AssetParam* asset : node.assets) {
            if (asset->name.empty()) continue;
            const patch::PatchAsset* source = sources.at(asset->name);
            const std::string path = source->path.string();
            Entry& entry = loaded_[{asset->load, path}];
            if (!entry.loaded && !failed.contains(path)) {
                try {
                    // A file that is written meanwhile counts as changed.
                    entry.stamp = stamp_of(path);
                    entry.loaded = asset->load(path);
                } catch (const Error& error) {
                    failed.insert(path);
                    problems.add(source->where, fmt::format("asset '{}': {}", asset->name, error.what()));
                }
            }
            asset->loaded = entry.loaded;
        }
    }
}

}  // namespace tactus::compile
