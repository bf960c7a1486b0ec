// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "graph/compile/load_assets.hpp"

namespace tactus::run {

/// Assets that stay loaded for the life of the process, without those whose files have changed. A process that renders
/// many times, as a worker of a sweep does, loads a bone once: two of the three seconds of a saw minute. One thread.
inline compile::AssetCache& kept_assets() {
    // Never destroyed: modules that loaded an asset may be gone at exit.
    static auto* const kept = new compile::AssetCache;
    kept->forget_changed();
    return *kept;
}

}  // namespace tactus::run
