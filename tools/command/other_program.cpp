// SPDX-License-Identifier: Apache-2.0
#include "tools/command/other_program.hpp"

#include "assets/file/part.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace tactus::command {

void run_beside(const std::string& name, const std::string& holds, std::vector<std::string> arguments) {
    const std::filesystem::path program = file::this_object().parent_path() / name;
    if (!std::filesystem::exists(program))
        throw Error(
            fmt::format("{} are in a separate program, {}, which does not exist; build it with "
                        "'cmake --build BUILD_FOLDER --target {}', or install it beside tactus",
                        holds, program.string(), name));
    std::string path = program.string();
    std::vector<char*> argv{path.data()};
    for (std::string& word : arguments) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::fflush(nullptr);
    ::execv(path.c_str(), argv.data());
    throw Error(fmt::format("{}: cannot be run: {}", path, std::strerror(errno)));
}

}  // namespace tactus::command
