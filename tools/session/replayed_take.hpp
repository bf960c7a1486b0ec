// SPDX-License-Identifier: Apache-2.0
// A take made ready to run again: its plans, edits and parameter changes.
#pragma once

#include "engine/engine.hpp"
#include "engine/take_reader.hpp"
#include "graph/load_assets.hpp"

#include <memory>

namespace tactus::session {

class ReplayedTake {
public:
    /// `options` says what is wanted of the repetition; what repeats the run is filled in. `take` must outlive it. Throws
    /// Error.
    ReplayedTake(const Take& take, EngineOptions options, AssetCache& assets);

    Engine& engine() { return *engine_; }

private:
    std::unique_ptr<Engine> engine_;
};

}  // namespace tactus::session
