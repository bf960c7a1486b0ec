// SPDX-License-Identifier: Apache-2.0
// One offline run with its results and, on request, its take.
#pragma once

#include "engine/run/engine.hpp"
#include "graph/compile/load_assets.hpp"
#include "tools/run/run_choice.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace tactus::run {

struct RenderedRun {
    double seconds = 0.0;              ///< rendered duration
    std::string summary;               ///< as JSON
    std::vector<std::string> losses;   ///< files that could not be written, with the reason
    std::vector<std::string> faults;   ///< device faults without recovery
};

/// Renders `choice.seconds` (required) into `choice.out`, and `choice.record` if it is given. Ends early when `stop` is
/// set. Throws Error.
RenderedRun render_run(const RunChoice& choice, compile::AssetCache& assets, const std::atomic<bool>& stop,
                       const std::function<void(double done)>& progress);

/// The same in steps of the caller: `drive` calls Engine::advance and Engine::set, and the run ends where it has arrived.
/// `observer` may be null.
RenderedRun render_in_steps(const RunChoice& choice, compile::AssetCache& assets, observe::Observer* observer,
                            const std::function<void(run::Engine&)>& drive);

}  // namespace tactus::run
