// SPDX-License-Identifier: Apache-2.0
// Prepares a take for replay: its plans, edits and parameter changes.
#pragma once

#include "engine/run/engine.hpp"
#include "engine/take/take_reader.hpp"
#include "graph/compile/load_assets.hpp"

#include <memory>

namespace tactus::run {

class ReplayedTake {
public:
    /// Completes `options` of the replay with the data of the take, which must outlive it. Throws Error.
    ReplayedTake(const take::Take& take, run::EngineOptions options, compile::AssetCache& assets);

    run::Engine& engine() { return *engine_; }

private:
    std::unique_ptr<run::Engine> engine_;
};

}  // namespace tactus::run
