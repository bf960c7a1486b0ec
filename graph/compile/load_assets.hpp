// SPDX-License-Identifier: Apache-2.0
// Loads the files that a patch names.
#pragma once

#include "graph/compile/schedule.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace tactus::compile {

/// Assets loaded so far. Nodes and plans that name the same file share one copy.
class AssetCache {
public:
    /// Loads the file of every asset parameter of the plan. A file that cannot be loaded is reported once, at its
    /// location in the patch.
    void load(Schedule& plan, patch::Problems& problems);

    /// Before a new run: removes assets whose files have changed since they were loaded. Plans that use them keep their
    /// copy.
    void forget_changed();

private:
    using Loader = std::shared_ptr<const void> (*)(const std::string& path);
    /// Version of a file; all zero if the file does not exist.
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
