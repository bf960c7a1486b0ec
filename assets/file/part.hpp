// SPDX-License-Identifier: Apache-2.0
// Locates separate files of Tactus: helper programs, modules, the library of patches and bones.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tactus::file {

/// Returns the program or the shared library that contains this function. Inside another program, such as Python, it is
/// the library.
std::filesystem::path this_object();

/// Returns the candidate locations of `name`: beside this_object(), as in a build folder, and in each of the folders
/// `installed`, relative to it and separated by ':'. There are several, because programs and libraries are installed at
/// different depths.
std::vector<std::filesystem::path> places_of_part(std::string_view name, std::string_view installed);

/// Returns the first of these locations that exists. Throws Error "WHAT is neither A nor B; build or install NAME".
std::filesystem::path find_part(std::string_view what, std::string_view name, std::string_view installed);

}  // namespace tactus::file
