// SPDX-License-Identifier: Apache-2.0
// The verbs of the tactus command. Each takes what the command line said and returns the exit code; input that cannot
// be used is thrown as Error and ends as exit code 2.
#pragma once

#include "assets/bone/import.hpp"
#include "graph/patch.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus {

enum ExitCode : int { done = 0, answer_is_no = 1, bad_input = 2 };

/// What every verb that takes a patch knows about it.
struct PatchChoice {
    std::string patch;  ///< a path, or a name in the library
    PatchOverrides overrides;
    std::optional<std::uint64_t> seed;
    bool json = false;
};

struct RenderChoice : PatchChoice {
    double seconds = 10.0;
    std::filesystem::path out;
    int threads = 0;      ///< 0: one per core
    std::string block;    ///< "", a number, or "random"
    std::filesystem::path log;
};

struct RunChoice : PatchChoice {
    std::optional<double> seconds;
    double dilate = 1.0;
    std::filesystem::path out, log;
};

struct ImportChoice : ImportOptions {
    std::filesystem::path out;
    bool json = false;
};

int render_verb(const RenderChoice& choice);
int run_verb(const RunChoice& choice);
int check_verb(const PatchChoice& choice);
int draw_verb(const PatchChoice& choice, const std::filesystem::path& out);
int nodes_verb(const std::string& type, bool json);
int devices_verb(bool json);
int import_verb(const ImportChoice& choice);

/// Parses the command line and runs the verb.
int command_line(int argc, char** argv);

}  // namespace tactus
