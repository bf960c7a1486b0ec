// SPDX-License-Identifier: Apache-2.0
// What `check` found, as rows of JSON.
#pragma once

#include "engine/build/generation.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/study/passivity/z_width.hpp"
#include "tools/study/patch_stiffness.hpp"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace tactus::command {

/// Errors, groups, paths and processes of devices. Without a plan the errors alone.
nlohmann::ordered_json check_json(const std::optional<compile::Plan>& plan, const patch::Problems& problems);

/// One row per path; loops through a hand also have a stiffness.
nlohmann::ordered_json paths_json(const compile::Plan& plan, const std::vector<analyse::ForceLoop>& loops);

/// The position loops of admittance controllers: gain and stability limit.
nlohmann::ordered_json loops_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes);

/// The outputs to a hand. Those that may return more energy than the hand has put in are among the `warnings`.
nlohmann::ordered_json outputs_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes,
                                    nlohmann::ordered_json& warnings);

/// By which law each node's bodies touch.
nlohmann::ordered_json contact_json(const std::vector<study::NodeContactLaw>& laws);

nlohmann::ordered_json classes_json(const std::vector<study::ClassVerdict>& verdicts);

nlohmann::ordered_json z_width_json(const std::vector<study::ZWidthCurve>& curves);

/// True when no path exceeds its stiffness limit and no loop is unstable.
bool is_stable(const nlohmann::ordered_json& found);

/// A stiffness could not be judged.
bool is_unknown(const nlohmann::ordered_json& found);

}  // namespace tactus::command
