// SPDX-License-Identifier: Apache-2.0
// From what the command line says to a plan that is ready for an engine.
#pragma once

#include "engine/take_writer.hpp"
#include "graph/load_assets.hpp"
#include "graph/plan.hpp"
#include "tools/session/patch_choice.hpp"

#include <filesystem>
#include <memory>

namespace tactus::session {

/// Folder of the bundled library: $TACTUS_LIBRARY, or "library" beside the command.
std::filesystem::path library_folder();

/// The file is in the bundled library, that of $TACTUS_LIBRARY or that beside the command, or would be.
bool is_of_library(const std::filesystem::path& file);

/// File of a patch given by path, or by name in the library. Throws Error listing what the library has.
std::filesystem::path find_patch(const std::string& name);

/// File of a display rig given by path, or by name in the library. Throws Error listing what the library has.
std::filesystem::path find_rig(const std::string& name);

/// The plan of a patch: what the command line overrides, `seed` when given, compiled; with its assets when there is a
/// cache. Problems are collected, those of reading among them; with any, there may be no plan.
std::optional<Plan> plan_of(Patch patch, const PatchOverrides& overrides, std::optional<std::uint64_t> seed,
                            AssetCache* assets, Problems& problems);

/// Reads and compiles, without assets. Problems are collected.
std::optional<Plan> read_plan(const PatchChoice& choice, Problems& problems);

/// Reads, compiles and loads assets. Throws when there are problems, as throw_problems() does.
Plan load_plan(const PatchChoice& choice, AssetCache& assets);

/// The text of each problem, of the first twenty when there are more, and then how many are left out.
std::vector<std::string> problem_lines(const Problems& problems);

/// Prints these lines but the last on standard error and throws the last; nothing when there are none.
void throw_problems(const Problems& problems);

/// A take of a run of that patch. Throws Error when the folder cannot be made or holds a take already.
std::unique_ptr<TakeWriter> make_take(const PatchChoice& choice, const std::filesystem::path& folder, double seconds,
                                      bool live);

/// Makes `folder` and checks that files can be written to it. Throws Error.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace tactus::session
