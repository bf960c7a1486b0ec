// SPDX-License-Identifier: Apache-2.0
// Checks the outputs on a command line, for all verbs, before a verb runs: their endings, and that no input is lost.
#pragma once

#include "tools/command/declare.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::command {

/// The endings of all outputs of a program, and of formats that it only reads or writes into folders; ascending.
std::vector<std::string> written_formats(const DeclaredVerbs& declared);

/// Beginnings and endings of the files that a verb writes into its folder, as "fragment_*.vdb"; empty: it checks its
/// folder itself, or makes a new one.
std::vector<std::string> files_in_folder(std::string_view verb);

/// `verb`: with its group, as "plan report". Throws Error if an output has an ending that the verb does not write, or
/// would overwrite an input. Devices, pipes and existing folders may have any name.
void check_written(const CLI::App& app, const std::string& verb, const DeclaredVerbs& declared);

}  // namespace tactus::command
