// SPDX-License-Identifier: Apache-2.0
// What a folder promises: it includes another in one direction only, it runs in a tick or offline, and a subject has one
// name in every room.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path tree = tactus::test::source_folder();
constexpr std::array<std::string_view, 7> all_rooms{"dsp", "assets", "graph", "devices", "nodes", "engine", "tools"};

/// "dsp/contact"; of tools one level more, "tools/window/plan". A file that stands in a room itself has none.
std::string folder_of(const std::string& file) {
    std::vector<std::string> parts;
    std::istringstream stream(file);
    for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
    parts.pop_back();
    const std::size_t depth = !parts.empty() && parts[0] == "tools" ? 3 : 2;
    std::string folder;
    for (std::size_t n = 0; n < std::min(depth, parts.size()); ++n) folder += (n ? "/" : "") + parts[n];
    return parts.size() < 2 ? "" : folder;
}

/// Folder → folders that its files include → the first such pair of files.
std::map<std::string, std::map<std::string, std::string>> included_folders() {
    static const std::regex include("^#include \"([a-z_0-9/]+\\.hpp)\"");
    std::map<std::string, std::map<std::string, std::string>> all;
    for (const std::string_view room : all_rooms)
        for (const auto& entry : fs::recursive_directory_iterator(tree / room)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".cpp" && extension != ".hpp") continue;
            const std::string file = fs::relative(entry.path(), tree).generic_string(), from = folder_of(file);
            std::ifstream stream(entry.path());
            std::smatch found;
            for (std::string line; std::getline(stream, line);) {
                if (!std::regex_search(line, found, include)) continue;
                const std::string to = folder_of(found[1].str());
                if (!from.empty() && !to.empty() && to != from && fs::exists(tree / found[1].str()))
                    all[from].emplace(to, file + " includes " + found[1].str());
            }
        }
    return all;
}

}  // namespace

TEST_CASE("two folders include each other in one direction only") {
    // Still to be taken apart; a pair that no longer does so must leave this list.
    const std::set<std::pair<std::string, std::string>> known{
        {"devices/driver", "devices/haptic"},   {"devices/driver", "devices/hosted"},
        {"devices/gripper", "devices/haptic"},  {"devices/haptic", "devices/hosted"},
        {"devices/haptic", "devices/spacenav"}, {"dsp/geometry", "dsp/volume"},
        {"engine/build", "engine/run"},         {"engine/run", "engine/take"}};
    const auto all = included_folders();
    REQUIRE(all.size() > 40);
    std::set<std::pair<std::string, std::string>> found;
    for (const auto& [from, others] : all)
        for (const auto& [to, files] : others) {
            const auto back = all.find(to);
            if (from > to || back == all.end() || !back->second.contains(from)) continue;
            found.emplace(from, to);
            CAPTURE(files, back->second.at(from));
            CHECK(known.contains({from, to}));
        }
    for (const auto& pair : known) {
        CAPTURE(pair.first, pair.second);
        CHECK(found.contains(pair));
    }
}

TEST_CASE("what runs in a tick includes nothing that only runs offline") {
    // CONTRIBUTING.md has the same list for readers.
    const std::set<std::string> offline{"dsp/fit",        "dsp/reconstruction", "dsp/segmentation", "dsp/skin",
                                        "dsp/vessel",     "dsp/training",       "dsp/simulate",     "dsp/psychophysics",
                                        "dsp/statistics", "dsp/cutting_guide"};
    const std::string guide = [] {
        std::ifstream stream(tree / "CONTRIBUTING.md");
        return std::string{std::istreambuf_iterator<char>(stream), {}};
    }();
    const auto all = included_folders();
    for (const std::string& folder : offline) {
        CAPTURE(folder);
        CHECK(fs::is_directory(tree / folder));
        CHECK(guide.find("`" + folder.substr(4) + "`") != std::string::npos);
    }
    for (const auto& [from, others] : all) {
        if (!from.starts_with("dsp/") || offline.contains(from)) continue;
        for (const auto& [to, files] : others) {
            CAPTURE(files);
            CHECK_FALSE(offline.contains(to));
        }
    }
}

TEST_CASE("the table of subjects agrees with the tree") {
    const std::array<std::string_view, 9> columns{"dsp",           "assets",         "devices",
                                                  "nodes",         "tools/analysis", "tools/report",
                                                  "tools/command", "tools/window",   "tools/bench"};
    std::ifstream stream(tree / "docs/explanation/code.md");
    int rows = 0;
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with("| `") || line.find("•") == std::string::npos) continue;
        ++rows;
        std::vector<std::string> cells;
        std::istringstream parts(line.substr(2));
        for (std::string cell; std::getline(parts, cell, '|');) cells.push_back(cell);
        REQUIRE(cells.size() == columns.size() + 1);
        const std::string subject =
            cells[0].substr(cells[0].find('`') + 1, cells[0].rfind('`') - cells[0].find('`') - 1);
        for (std::size_t n = 0; n < columns.size(); ++n) {
            CAPTURE(subject, columns[n]);
            const bool is_there = fs::is_directory(tree / columns[n] / subject);
            CHECK((cells[n + 1].find("•") != std::string::npos) == is_there);
        }
    }
    CHECK(rows >= 10);
}
