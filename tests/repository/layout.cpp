// SPDX-License-Identifier: Apache-2.0
// What the tree promises: rooms include only to the left, files carry their licence, nodes are in the catalogue.
#include "tests/support/places.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = tactus::test::source_folder();
constexpr std::array<std::string_view, 7> rooms{"dsp", "assets", "graph", "devices", "nodes", "engine", "tools"};

std::string read(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> files_under(std::string_view folder, const std::set<std::string>& extensions) {
    std::vector<fs::path> files;
    if (!fs::exists(root / folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
        if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
            files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// The names in `#include "..."` and `#include <...>` lines.
std::vector<std::string> includes_of(const fs::path& file) {
    std::vector<std::string> names;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        const auto hash = line.find_first_not_of(" \t");
        if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) continue;
        const auto open = line.find_first_of("<\"", hash);
        const auto close = line.find_first_of(">\"", open + 1);
        if (open != std::string::npos && close != std::string::npos)
            names.push_back(line.substr(open + 1, close - open - 1));
    }
    return names;
}

/// "blade_contact" → "BladeContact".
std::string struct_name_of(std::string_view file_stem) {
    std::string name;
    bool start = true;
    for (const char c : file_stem) {
        if (c != '_') name += start ? static_cast<char>(std::toupper(c)) : c;
        start = c == '_';
    }
    return name;
}

}  // namespace

TEST_CASE("rooms include only what stands left of them") {
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        for (const fs::path& file : files_under(rooms[room], {".cpp", ".hpp"})) {
            for (const std::string& name : includes_of(file)) {
                const auto first = name.substr(0, name.find('/'));
                CAPTURE(file.string(), name);
                CHECK_FALSE(name.starts_with("../"));
                CHECK(first != "tests");
                const auto included = std::ranges::find(rooms, first);
                if (included != rooms.end() && first != name)
                    CHECK(static_cast<std::size_t>(included - rooms.begin()) <= room);
            }
        }
    }
}

TEST_CASE("every source file says its licence first") {
    std::vector<fs::path> files{root / "CMakeLists.txt", root / "dev", root / ".ci/run"};
    for (const auto folder : {"dsp", "assets", "graph", "devices", "nodes", "engine", "tools", "tests", "cmake"})
        for (const auto& file : files_under(folder, {".cpp", ".hpp", ".cmake", ".py", ".sh"})) files.push_back(file);
    for (const fs::path& file : files) {
        std::ifstream stream(file);
        std::string line;
        std::getline(stream, line);
        if (line.starts_with("#!")) std::getline(stream, line);
        CAPTURE(file.string());
        const bool is_cpp = file.extension() == ".cpp" || file.extension() == ".hpp";
        CHECK(line == (is_cpp ? "// SPDX-License-Identifier: Apache-2.0" : "# SPDX-License-Identifier: Apache-2.0"));
    }
}

TEST_CASE("every node file is in the catalogue") {
    const std::string catalogue = read(root / "nodes/catalogue.cpp");
    for (const fs::path& file : files_under("nodes", {".cpp"})) {
        if (file.parent_path() == root / "nodes") continue;
        if (read(file).find("TACTUS_NODE(") == std::string::npos) continue;  // shared by nodes of the family
        const std::string type = struct_name_of(file.stem().string());
        CAPTURE(file.string());
        CHECK(catalogue.find("X(" + type + ", " + file.parent_path().filename().string() + ")") != std::string::npos);
    }
}

TEST_CASE("heavy libraries stay out of headers") {
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".hpp"}))
            for (const std::string& name : includes_of(file))
                for (const std::string_view heavy : {"openvdb/", "CLI/", "nlohmann/", "toml++", "Eigen/", "gdcm",
                                                     "teem/", "zlib.h", "GL/", "EGL/", "portaudio"}) {
                    CAPTURE(file.string(), name);
                    CHECK_FALSE(name.starts_with(heavy));
                }
}
