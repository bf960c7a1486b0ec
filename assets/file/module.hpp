// SPDX-License-Identifier: Apache-2.0
// Modules of the program that are loaded on first use, because the libraries that they need are slow to load.
#pragma once

namespace tactus::file {

/// Returns the address of `symbol` in a module of this program. Modules stay loaded. Searches the same folders as
/// find_part(), not those of the system's loader, because a module belongs to one build of the program. Throws Error if
/// the module is missing or cannot be loaded.
void* load_module(const char* name, const char* symbol);

}  // namespace tactus::file
