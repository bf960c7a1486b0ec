// SPDX-License-Identifier: Apache-2.0
// What `check` found, as rows of JSON.
#pragma once

#include "assets/file/json.hpp"
#include "engine/build/generation.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/analysis/passivity/z_width.hpp"
#include "tools/analysis/patch_stiffness.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace tactus::command {

/// Errors, groups, paths and processes of devices. Without a plan the errors alone.
file::Json check_json(const std::optional<compile::Schedule>& plan, const patch::Problems& problems);

/// One row per path; loops through a hand also have a stiffness.
file::Json paths_json(const compile::Schedule& plan, const std::vector<analyse::ForceLoop>& loops);

/// What a sound card adds to the latency of paths that end there; null when nothing is played.
file::Json sound_json(const compile::Schedule& plan);

/// The position loops of admittance controllers: gain and stability limit.
file::Json loops_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes);

/// The outputs to a hand, with the energy that a contact may give beyond what it took, at the declared stiffness of
/// `loops`. Those without an energy cap are among the `warnings`.
file::Json outputs_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes,
                        const std::vector<analyse::ForceLoop>& loops, file::Json& warnings);

/// By which law each node's bodies touch.
file::Json contact_json(const std::vector<analysis::NodeContactLaw>& laws);

file::Json classes_json(const std::vector<analysis::ClassVerdict>& verdicts);

file::Json z_width_json(const std::vector<analysis::ZWidthCurve>& curves);

/// True when no path exceeds its stiffness limit and no loop is unstable.
bool is_stable(const file::Json& found);

/// A stiffness could not be judged.
bool is_unknown(const file::Json& found);

}  // namespace tactus::command
