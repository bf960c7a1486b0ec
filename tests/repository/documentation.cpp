// SPDX-License-Identifier: Apache-2.0
// The documentation agrees with the tree: links lead somewhere, packages are named, generated pages are up to date.
#include "tests/repository/markdown.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace tactus::test;

}  // namespace

TEST_CASE("every link of the documentation leads to a file and a heading that exist") {
    for (const fs::path& page : markdown_files())
        for (const MarkdownLink& link : links_of(page)) {
            if (link.target.find("://") != std::string::npos) continue;
            CAPTURE(page.string(), link.line, link.target);
            const auto hash = link.target.find('#');
            const std::string file = link.target.substr(0, hash);
            const fs::path target = file.empty() ? page : page.parent_path() / file;
            const bool exists = fs::exists(target);
            CHECK(exists);
            if (!exists || hash == std::string::npos || target.extension() != ".md") continue;
            const auto anchors = anchors_of(target);
            CHECK(std::ranges::find(anchors, link.target.substr(hash + 1)) != anchors.end());
        }
}

TEST_CASE("README and the page of dependencies name every package that is installed") {
    const std::string readme = slurp(source_folder() / "README.md");
    const std::string page = slurp(source_folder() / "docs/reference/dependencies.md");
    std::ifstream packages(source_folder() / "cmake/packages.txt");
    for (std::string line; std::getline(packages, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        std::string group, package;
        words >> group >> package;
        CAPTURE(package);
        CHECK(readme.find(package) != std::string::npos);
        CHECK(page.find("| " + package + " |") != std::string::npos);
    }
}

TEST_CASE("the generated pages are what the command says, and docs/generate.sh writes them anew") {
    const Folder folder;
    const std::string script = (source_folder() / "docs/generate.sh").string();
    REQUIRE(std::system(("'" + script + "' '" + command() + "' '" + folder.path.string() + "'").c_str()) == 0);
    for (const char* name : {"nodes.md", "value-types.md", "verbs.md"}) {
        CAPTURE(name);
        // Compared as a flag: a difference is easier to read in 'git diff' after running the script.
        const bool is_same = slurp(folder.path / name) == slurp(source_folder() / "docs/reference" / name);
        CHECK(is_same);
    }
}

TEST_CASE("the ways through the code name files that exist") {
    const std::string page = slurp(source_folder() / "docs/explanation/code.md");
    static const std::regex file("`([a-z]+/[a-z0-9_/.-]+\\.[ch]pp)`");
    int files = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), file), end; at != end; ++at, ++files) {
        CAPTURE((*at)[1].str());
        CHECK(std::filesystem::exists(source_folder() / (*at)[1].str()));
    }
    CHECK(files > 30);
}
