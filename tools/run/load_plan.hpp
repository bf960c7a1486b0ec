// SPDX-License-Identifier: Apache-2.0
// Loads a patch as specified on the command line and compiles it to a plan for the engine.
#pragma once

#include "engine/take/take_writer.hpp"
#include "graph/compile/load_assets.hpp"
#include "graph/compile/schedule.hpp"
#include "tools/run/patch_choice.hpp"

#include <filesystem>
#include <memory>

namespace tactus::run {

/// Folder of the bundled library: $TACTUS_LIBRARY, or "library" beside the command, or ../share/tactus/library from it.
std::filesystem::path library_folder();

/// True for paths in the bundled library, of $TACTUS_LIBRARY or of the command; the file need not exist.
bool is_of_library(const std::filesystem::path& file);

/// The patch with this path, or with this name in the library. Throws Error listing the names in the library.
std::filesystem::path find_patch(const std::string& name);

/// The display file with this path, or with this name in the library. Throws Error listing the names in the library.
std::filesystem::path find_display(const std::string& name);

/// The task file with this path, or with this name in the library. Throws Error listing the names in the library.
std::filesystem::path find_task(const std::string& name);

/// The experiment file with this path, or with this name in the library. Throws Error listing the names in the library.
std::filesystem::path find_experiment(const std::string& name);

/// The model of simulated subjects with this path, or with this name in the library. Throws Error like find_experiment().
std::filesystem::path find_observer_model(const std::string& name);

/// Applies overrides and `seed` to a patch and compiles it; loads assets when `assets` is not null. Adds to `problems`,
/// which may already contain those of reading; with problems there may be no plan.
std::optional<compile::Schedule> plan_of(patch::Patch patch, const patch::PatchOverrides& overrides,
                                         std::optional<std::uint64_t> seed, compile::AssetCache* assets,
                                         patch::Problems& problems);

/// Reads and compiles, without assets. Problems are collected.
std::optional<compile::Schedule> read_plan(const PatchChoice& choice, patch::Problems& problems);

/// Reads, compiles and loads assets. Throws if there are problems, as throw_problems() does.
compile::Schedule load_plan(const PatchChoice& choice, compile::AssetCache& assets);

/// The texts of the first twenty problems, and the number of the others.
std::vector<std::string> problem_lines(const patch::Problems& problems);

/// Prints all lines but the last on standard error and throws the last; does nothing without problems.
void throw_problems(const patch::Problems& problems);

/// Starts a take of a run. Throws Error if the folder cannot be created or already has a take.
std::unique_ptr<take::TakeWriter> make_take(const PatchChoice& choice, const std::filesystem::path& folder,
                                            double seconds, bool live);

/// Creates `folder` and checks that it is writable. Throws Error.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace tactus::run
