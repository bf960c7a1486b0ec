// SPDX-License-Identifier: Apache-2.0
// make_library OUT_DIR: computes the bundled bones and the bundled saw, which are not kept in the repository.
#include "assets/library/fragments.hpp"
#include "assets/library/mandible.hpp"
#include "assets/library/saw_recordings.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>

namespace fs = std::filesystem;

namespace {

void make_library(const fs::path& folder) {
    const fs::path bone = folder / "bones" / "mandible.vdb", saw = folder / "saw";
    std::error_code failure;
    fs::create_directories(bone.parent_path(), failure);
    if (failure)
        throw tactus::Error(fmt::format("{}: cannot be made: {}", bone.parent_path().string(), failure.message()));
    tactus::save_bone(tactus::make_mandible(), bone);
    fmt::print("{}\n", bone.string());
    const fs::path fragments = folder / "bones" / "fragments.vdb";
    tactus::save_bones(tactus::make_fragments(), fragments);
    fmt::print("{}\n", fragments.string());
    tactus::make_saw_recordings(saw);
    std::set<std::string> written;
    for (const auto& entry : fs::directory_iterator(saw)) written.insert(entry.path().string());
    for (const std::string& path : written) fmt::print("{}\n", path);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: make_library OUT_DIR\n");
        return 2;
    }
    try {
        make_library(argv[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_library: {}\n", error.what());
        return 1;
    }
    return 0;
}
