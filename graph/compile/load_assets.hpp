// SPDX-License-Identifier: Apache-2.0
// Loading the files that a patch names.
#pragma once

#include "graph/compile/plan.hpp"

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace tactus::compile {

/// Assets loaded so far: two nodes, or two plans, that name one file share it.
class AssetCache {
public:
    /// Loads the file behind every asset parameter of the plan. A file that cannot be loaded is a problem where the
    /// patch names it, said once.
    void load(Plan& plan, patch::Problems& problems);

private:
    using Loader = std::shared_ptr<const void> (*)(const std::string& path);
    std::map<std::pair<Loader, std::string>, std::shared_ptr<const void>> loaded_;
};

}  // namespace tactus::compile
