// SPDX-License-Identifier: Apache-2.0
// Loading the files that a patch names.
#pragma once

#include "graph/compile/plan.hpp"

#include <cstdint>
#include <filesystem>
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

    /// Before a new run: forgets what was loaded from files that were written since. Plans that have it keep it.
    void forget_changed();

private:
    using Loader = std::shared_ptr<const void> (*)(const std::string& path);
    /// Of a file; all zero where there is none.
    struct Stamp {
        std::filesystem::file_time_type written{};
        std::uintmax_t size = 0;
        bool operator==(const Stamp&) const = default;
    };
    static Stamp stamp_of(const std::string& path);

    struct Entry {
        std::shared_ptr<const void> loaded;
        Stamp stamp;
    };
    std::map<std::pair<Loader, std::string>, Entry> loaded_;
};

}  // namespace tactus::compile
