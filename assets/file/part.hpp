// SPDX-License-Identifier: Apache-2.0
// Where the parts of Tactus are that are files of their own: helper programs, modules, the library of patches and bones.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tactus::file {

/// The program, or the shared library, that contains this function. Inside another program, as Python, the library.
std::filesystem::path this_object();

/// Where `name` may be: beside this_object(), as in a build folder, and in each of the folders `installed`, relative to
/// it and separated by ':'. Programs and libraries are installed at different depths, so there are several.
std::vector<std::filesystem::path> places_of_part(std::string_view name, std::string_view installed);

/// The first of these places that exists. Throws Error "WHAT is neither A nor B; build or install NAME".
std::filesystem::path find_part(std::string_view what, std::string_view name, std::string_view installed);

}  // namespace tactus::file
