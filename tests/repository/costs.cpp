// SPDX-License-Identifier: Apache-2.0
// Processor time of test cases: a costly case runs on landing only for a stated reason.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr double max_landing_seconds = 3;

struct CaseSource {
    std::string file, tags;
    bool has_reason = false;
};

/// The text between the quotes from `from` on, with adjacent literals joined; `from` moves behind it.
std::string literal_at(const std::string& text, std::size_t& from) {
    std::string value;
    while (from < text.size() && text[from] == '"') {
        for (++from; from < text.size() && text[from] != '"'; ++from) {
            if (text[from] == '\\') ++from;
            value += text[from];
        }
        ++from;
        while (from < text.size() && std::string(" \n").find(text[from]) != std::string::npos) ++from;
    }
    return value;
}

/// Every TEST_CASE of the tree by "room:name".
std::map<std::string, CaseSource> cases_of_tree() {
    std::map<std::string, CaseSource> cases;
    const fs::path tests = tactus::test::source_folder() / "tests";
    for (const auto& entry : fs::recursive_directory_iterator(tests)) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream stream(entry.path());
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        const std::string room = fs::relative(entry.path(), tests).begin()->string();
        for (auto at = text.find("\nTEST_CASE(\""); at != std::string::npos; at = text.find("\nTEST_CASE(\"", at + 1)) {
            std::size_t next = at + 11;
            CaseSource source{.file = entry.path().string(), .tags = {}};
            const std::string name = literal_at(text, next);
            if (text.compare(next, 2, ", ") == 0 || text.compare(next, 2, ",\n") == 0) {
                next = text.find('"', next);
                source.tags = literal_at(text, next);
            }
            // Comment lines directly above.
            for (std::size_t end = at; end != std::string::npos && end > 0;) {
                const std::size_t start = text.rfind('\n', end - 1);
                const std::string line = text.substr(start + 1, end - start - 1);
                if (!line.starts_with("//")) break;
                source.has_reason = source.has_reason || line.starts_with("// Costly: ");
                end = start;
            }
            cases[room + ":" + name] = source;
        }
    }
    return cases;
}

}  // namespace

TEST_CASE("a case that needs more than 3 s of processor time on landing states its reason") {
    const std::map<std::string, CaseSource> cases = cases_of_tree();
    REQUIRE(cases.size() > 2000);
    std::ifstream table(tactus::test::source_folder() / "tests/costs.tsv");
    REQUIRE(table);
    for (std::string line; std::getline(table, line);) {
        if (line.empty() || line[0] == '#') continue;
        const auto tab = line.find('\t');
        REQUIRE(tab != std::string::npos);
        const double seconds = std::stod(line.substr(0, tab));
        const auto found = cases.find(line.substr(tab + 1));
        // A case that was renamed or removed since the table was measured.
        if (found == cases.end() || seconds <= max_landing_seconds) continue;
        CAPTURE(line, found->second.file);
        CHECK((found->second.tags.find("[long]") != std::string::npos || found->second.has_reason));
    }
}
