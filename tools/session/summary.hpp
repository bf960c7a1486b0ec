// SPDX-License-Identifier: Apache-2.0
// What a run was, for programs and for people.
#pragma once

#include "engine/run/engine.hpp"

#include <string>
#include <vector>

namespace tactus::session {

/// What a run ended with that makes it fail: devices whose fault was not recovered, lateness left out, and sound cards
/// that were lost. A line each; after the run.
std::vector<std::string> unrecovered(const run::Engine& engine);

/// The summary as JSON text. `files` are those written besides the recordings; `losses`: what could not be written to
/// its end, and why.
std::string summary_json(const run::Engine& engine, const Report& report, double seconds, bool live,
                         const std::vector<std::string>& files, const std::vector<std::string>& losses);

/// The same in a few lines.
std::string summary_text(const run::Engine& engine, const Report& report, double seconds, double wall_seconds);

}  // namespace tactus::session
