// SPDX-License-Identifier: Apache-2.0
// A training task as an asset, for the few nodes that name one; see graph/node/assets.hpp.
#pragma once

#include "assets/training/task_file.hpp"
#include "graph/node/param.hpp"

namespace tactus {

template <>
struct AssetLoader<training::Task> {
    static constexpr std::string_view name = "task";
    static training::Task load(const std::string& path) { return training::load_task(path); }
};

}  // namespace tactus
