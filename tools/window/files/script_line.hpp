// SPDX-License-Identifier: Apache-2.0
// A line of a script that stands in for a person at a window: words, or text in quotes; # begins a comment.
#pragma once

#include "dsp/core/error.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

struct ScriptLine {
    SourceLocation where;
    bool is_refused = false;  ///< begins with "!": the command must be refused
    std::vector<std::string> words;  ///< at least one, the command

    /// Throws Error where there are fewer words.
    const std::string& word(std::size_t i) const;
    /// Throws Error also where the word is no number, or no finite one.
    double number(std::size_t i) const;
};

/// The lines of a text that have commands. Throws Error for one that is not among `commands`. `old`: names of before, and
/// those of today.
std::vector<ScriptLine> script_lines(const std::string& text, const std::string& file,
                                     const std::vector<std::string>& commands,
                                     const std::vector<std::pair<std::string, std::string>>& old = {});
/// The same from a file.
std::vector<ScriptLine> read_script(const std::filesystem::path& file, const std::vector<std::string>& commands,
                                    const std::vector<std::pair<std::string, std::string>>& old = {});

}  // namespace tactus::window
