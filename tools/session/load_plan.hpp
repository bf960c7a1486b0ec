// SPDX-License-Identifier: Apache-2.0
// From what the command line says to a plan that is ready for an engine.
#pragma once

#include "engine/take/take_writer.hpp"
#include "graph/compile/load_assets.hpp"
#include "graph/compile/plan.hpp"
#include "tools/session/patch_choice.hpp"

#include <filesystem>
#include <memory>

namespace tactus::session {

/// Folder of the bundled library: $TACTUS_LIBRARY, or "library" beside the command, or ../share/tactus/library from it.
std::filesystem::path library_folder();

/// The file is in the bundled library, that of $TACTUS_LIBRARY or that of the command, or would be.
bool is_of_library(const std::filesystem::path& file);

/// File of a patch given by path, or by name in the library. Throws Error listing what the library has.
std::filesystem::path find_patch(const std::string& name);

/// File of a display rig given by path, or by name in the library. Throws Error listing what the library has.
std::filesystem::path find_rig(const std::string& name);

/// The plan of a patch: what the command line overrides, `seed` when given, compiled; with its assets when there is a
/// cache. Problems are collected, those of reading among them; with any, there may be no plan.
std::optional<compile::Plan> plan_of(patch::Patch patch, const patch::PatchOverrides& overrides,
                                     std::optional<std::uint64_t> seed, compile::AssetCache* assets,
                                     patch::Problems& problems);

/// Reads and compiles, without assets. Problems are collected.
std::optional<compile::Plan> read_plan(const PatchChoice& choice, patch::Problems& problems);

/// Reads, compiles and loads assets. Throws when there are problems, as throw_problems() does.
compile::Plan load_plan(const PatchChoice& choice, compile::AssetCache& assets);

/// The text of each problem, of the first twenty when there are more, and then how many are left out.
std::vector<std::string> problem_lines(const patch::Problems& problems);

/// Prints these lines but the last on standard error and throws the last; nothing when there are none.
void throw_problems(const patch::Problems& problems);

/// A take of a run of that patch. Throws Error when the folder cannot be made or holds a take already.
std::unique_ptr<take::TakeWriter> make_take(const PatchChoice& choice, const std::filesystem::path& folder,
                                            double seconds, bool live);

/// Makes `folder` and checks that files can be written to it. Throws Error.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace tactus::session
