// SPDX-License-Identifier: Apache-2.0
// Checks the outputs on a command line against its inputs, for all verbs, before a verb runs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tactus::command {

/// An option that names a file or a folder that a verb writes. Every other value that names a file is an input.
struct WrittenOption {
    std::string_view verb;  ///< "plan guide"; empty: of every verb
    std::string_view option;
};
const std::vector<WrittenOption>& written_options();

bool is_written(std::string_view verb, const CLI::Option& option);

/// Beginnings and endings of the files that a verb writes into its folder, as "fragment_*.vdb"; empty: it checks its
/// folder itself, or makes a new one.
std::vector<std::string> files_in_folder(std::string_view verb);

/// Names directly in a folder that the verb reads which it may replace, as "report.*": its own results of another time.
std::vector<std::string> own_results(std::string_view verb);

/// `verb`: with its group, as "plan report". Throws Error if an output would overwrite an input.
void check_written(const CLI::App& app, const std::string& verb);

}  // namespace tactus::command
