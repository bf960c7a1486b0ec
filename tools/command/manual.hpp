// SPDX-License-Identifier: Apache-2.0
// The declarations of a program as plain data, and generators of manuals and completions.
#pragma once

#include "tools/command/options.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tactus::command {

struct OptionPage {
    std::vector<std::string> names;    ///< with dashes; without dashes for a positional argument
    std::string value;                 ///< "TIME:0.001 to 1000000"; "": a flag
    std::string shown_default, about;
    std::vector<std::string> choices;  ///< allowed values, if limited
    bool is_positional = false, is_required = false, is_file = false;
};

/// A program or a verb, without hidden parts.
struct VerbPage {
    std::string name, about, job;  ///< name: one word, "tactus" or "render"
    std::vector<OptionPage> options;
    std::vector<VerbPage> verbs;
};

VerbPage pages_of(const Program& program);

/// Manual pages, section 1: file name and troff text. One for the program, one per verb.
std::vector<std::pair<std::string, std::string>> man_pages(const VerbPage& program);
std::string bash_completion(const VerbPage& program);
std::string zsh_completion(const VerbPage& program);
std::string fish_completion(const VerbPage& program);

}  // namespace tactus::command
