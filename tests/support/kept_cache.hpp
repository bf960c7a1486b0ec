// SPDX-License-Identifier: Apache-2.0
// A cache folder of its own, for as long as this lives. Without one, tests keep nothing (tests/support/main.cpp).
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tactus::test {

class KeptCache {
public:
    explicit KeptCache(const char* limit = "4000")
        : path(std::filesystem::temp_directory_path() /
               ("tactus_cache_" + std::to_string(::getpid()) + "_" + std::to_string(next++))) {
        std::filesystem::create_directories(path);
        ::setenv("XDG_CACHE_HOME", path.c_str(), 1);
        ::setenv("TACTUS_CACHE_LIMIT", limit, 1);
    }
    ~KeptCache() {
        ::unsetenv("XDG_CACHE_HOME");
        ::setenv("TACTUS_CACHE_LIMIT", "0", 1);
        std::filesystem::remove_all(path);
    }
    KeptCache(const KeptCache&) = delete;
    KeptCache& operator=(const KeptCache&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }
    static std::string read(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        std::ostringstream text;
        text << stream.rdbuf();
        return text.str();
    }

    std::filesystem::path path;

private:
    static inline int next = 0;
};

}  // namespace tactus::test
