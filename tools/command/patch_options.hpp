// SPDX-License-Identifier: Apache-2.0
// Options of every verb that compiles a patch.
#pragma once

#include "tools/command/options.hpp"
#include "tools/run/patch_choice.hpp"
#include "tools/run/saw_choice.hpp"
#include "tools/run/site_choice.hpp"

#include <filesystem>
#include <optional>

namespace tactus::command {

/// The patch, its changed parameters and assets, and the seed.
void add_patch_options(VerbOptions& verb, run::PatchChoice& choice);
/// The same without the patch.
void add_override_options(VerbOptions& verb, run::PatchChoice& choice);
/// --device-scale, for run::choose_device_scale.
void add_device_scale(VerbOptions& verb, std::optional<double>& scale);
/// --saw and --rate.
void add_saw_options(VerbOptions& verb, run::SawChoice& saw);
/// run::choose_saw, with what it returns on standard error.
void use_saw(run::PatchChoice& choice, const run::SawChoice& saw);
/// --site, --approach and --along, for run::choose_site.
void add_site_options(VerbOptions& verb, run::SiteText& text);

/// --record and --values.
void add_record_options(VerbOptions& verb, std::filesystem::path& folder, bool& values);

}  // namespace tactus::command
