// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/load_assets.hpp"

#include <fmt/format.h>

#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace tactus::compile {

void AssetCache::load(Plan& plan, patch::Problems& problems) {
    std::unordered_map<std::string_view, const patch::PatchAsset*> sources;
    for (const patch::PatchAsset& asset : plan.patch.assets) sources.emplace(asset.name, &asset);
    std::unordered_set<std::string> failed;
    for (PlanNode& node : plan.nodes) {
        for (AssetParam* asset : node.assets) {
            if (asset->name.empty()) continue;
            const patch::PatchAsset* source = sources.at(asset->name);
            const std::string path = source->path.string();
            auto& entry = loaded_[{asset->load, path}];
            if (!entry && !failed.contains(path)) {
                try {
                    entry = asset->load(path);
                } catch (const Error& error) {
                    failed.insert(path);
                    problems.add(source->where, fmt::format("asset '{}': {}", asset->name, error.what()));
                }
            }
            asset->loaded = entry;
        }
    }
}

}  // namespace tactus::compile
