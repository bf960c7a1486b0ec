// SPDX-License-Identifier: Apache-2.0
// Parts of the program that are loaded on first use, because the libraries that they need are slow to load.
#pragma once

namespace tactus::file {

/// Address of `symbol` in a module of this program. Modules stay loaded. Looks where find_part() does, not in the folders
/// of the system's loader: a module belongs to one build of the program. Throws Error when the module is missing or cannot be
/// loaded.
void* load_module(const char* name, const char* symbol);

}  // namespace tactus::file
