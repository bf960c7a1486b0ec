// SPDX-License-Identifier: Apache-2.0
// Options of the verbs that read a scan or a mesh.
#pragma once

#include "tools/command/options.hpp"

#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace tactus::command {

/// HU = first · value + second.
using Rescale = std::optional<std::pair<double, double>>;

/// Adds --hu-calibration and --rescale; `choice` stays valid while the verb runs.
void add_rescale(VerbOptions& verb, std::function<void(const Rescale&)> choose);
/// Adds --unit.
void add_unit(VerbOptions& verb, std::optional<std::string>& unit);

}  // namespace tactus::command
