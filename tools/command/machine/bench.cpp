// SPDX-License-Identifier: Apache-2.0
// tactus bench: runs the program tactus-bench.
#include "assets/file/part.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace tactus::command {

namespace {

/// Replaces the process; throws Error on failure.
int run_tactus_bench(const std::vector<std::string>& arguments) {
    const std::filesystem::path program = file::this_object().parent_path() / "tactus-bench";
    if (!std::filesystem::exists(program))
        throw Error(
            fmt::format("the benchmarks are in a separate program, {}, which does not exist; build it with "
                        "'cmake --build BUILD_FOLDER --target tactus-bench', or install it beside tactus",
                        program.string()));
    std::string name = program.string();
    std::vector<std::string> words = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::fflush(nullptr);
    ::execv(name.c_str(), argv.data());
    throw Error(fmt::format("{}: cannot be run: {}", name, std::strerror(errno)));
}

}  // namespace

Verb bench_verb() {
    return {"bench", "benchmarks of this machine, compared with other programs if they are installed", nullptr, nullptr,
            run_tactus_bench};
}

}  // namespace tactus::command
