// SPDX-License-Identifier: Apache-2.0
// The verbs of a program as declarations of CLI11, for reading a command line and for writing manuals.
#pragma once

#include "tools/command/options.hpp"

#include <map>

namespace tactus::command {

/// What was declared for a verb: what runs with it, and what it still understands.
struct DeclaredVerb {
    const Verb* verb = nullptr;
    Action run;
    OldSpellings old;
};
using DeclaredVerbs = std::map<const CLI::App*, DeclaredVerb>;

/// Adds the program's own options and all verbs to `app`. `declared` must live as long as `app`.
void declare(CLI::App& app, const Program& program, DeclaredVerbs& declared);

}  // namespace tactus::command
