// SPDX-License-Identifier: Apache-2.0
// The command as scripts call it, in a folder of its own.
#pragma once

#include "tests/support/places.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tactus::test {

namespace fs = std::filesystem;

inline std::string slurp(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Outcome {
    int code = -1;
    std::string out, err;
};

class Folder {
public:
    Folder()
        : path(fs::temp_directory_path() / ("tactus_" + std::to_string(::getpid()) + "_" + std::to_string(next++))) {
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }

    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }
    Outcome tactus(const std::string& arguments) const {
        // Results that are kept for one test must not reach another one.
        const std::string command = "TACTUS_CACHE_LIMIT=4000 XDG_CACHE_HOME=" + (path / ".cache").string() + " " +
                                    tactus::test::command() + " " + arguments + " >" + (path / "stdout").string() +
                                    " 2>" + (path / "stderr").string();
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(path / "stdout"), slurp(path / "stderr")};
    }

    fs::path path;

private:
    static inline int next = 0;
};

}  // namespace tactus::test
