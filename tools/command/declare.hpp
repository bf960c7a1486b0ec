// SPDX-License-Identifier: Apache-2.0
// Declares the verbs of a program in CLI11, for parsing command lines and for writing manuals.
#pragma once

#include "tools/command/options.hpp"

#include <map>
#include <vector>

namespace tactus::command {

/// The declaration of a verb: its action, its old spellings and its outputs.
struct DeclaredVerb {
    const Verb* verb = nullptr;
    Action run;
    OldSpellings old;
    std::vector<DeclaredOutput> outputs;
};
using DeclaredVerbs = std::map<const CLI::App*, DeclaredVerb>;

/// Adds the program's own options and all verbs to `app`. `declared` must live as long as `app`.
void declare(CLI::App& app, const Program& program, DeclaredVerbs& declared);

}  // namespace tactus::command
