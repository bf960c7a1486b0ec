// SPDX-License-Identifier: Apache-2.0
#include "graph/load_assets.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus {

void AssetCache::load(Plan& plan, Problems& problems) {
    std::vector<std::string> failed;
    for (PlanNode& node : plan.nodes) {
        for (AssetParam* asset : node.assets) {
            if (asset->name.empty()) continue;
            const auto source = std::ranges::find(plan.patch.assets, asset->name, &PatchAsset::name);
            const std::string path = source->path.string();
            auto& entry = loaded_[{asset->load, path}];
            if (!entry && std::ranges::find(failed, path) == failed.end()) {
                try {
                    entry = asset->load(path);
                } catch (const Error& error) {
                    failed.push_back(path);
                    problems.add(source->where, fmt::format("asset '{}': {}", asset->name, error.what()));
                }
            }
            asset->loaded = entry;
        }
    }
}

}  // namespace tactus
