// SPDX-License-Identifier: Apache-2.0
// The summary of a run as JSON and text.
#pragma once

#include "engine/run/engine.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::run {

/// Reasons for exit code 3 after a run, one line each: unrecovered faults of devices, except lateness, and lost sound
/// cards.
std::vector<std::string> unrecovered(const run::Engine& engine);

/// The summary as JSON text. `files`: files written besides the recordings; `losses`: files that could not be
/// completed, and why. Those are not among the "files" of the summary, nor the "signals".
std::string summary_json(const run::Engine& engine, const Report& report, double seconds, bool live,
                         const std::vector<std::string>& files, const std::vector<std::string>& losses);

/// Returns the summary as a few lines of text. `wall_seconds`: duration of an offline run; empty: the run was live.
std::string summary_text(const run::Engine& engine, const Report& report, double seconds,
                         std::optional<double> wall_seconds);

}  // namespace tactus::run
