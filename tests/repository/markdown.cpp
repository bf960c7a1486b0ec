// SPDX-License-Identifier: Apache-2.0
#include "tests/repository/markdown.hpp"

#include "tests/support/places.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>
#include <regex>

namespace tactus::test {

namespace fs = std::filesystem;

namespace {

/// Calls text(line, number) for each line outside of blocks, and block(…) for each block.
void walk(const fs::path& page, const std::function<void(const std::string&, int)>& text,
          const std::function<void(const MarkdownBlock&)>& block) {
    std::ifstream stream(page);
    std::string before;
    MarkdownBlock open;
    bool is_open = false;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (line.starts_with("```")) {
            if (is_open) block(open);
            else open = {line.substr(3), "", number, before.starts_with("<!--") ? before : ""};
            is_open = !is_open;
        } else if (is_open) open.text += line + "\n";
        else text(line, number);
        before = line;
    }
}

}  // namespace

std::optional<std::string> MarkdownBlock::remark(const std::string& key) const {
    const std::string start = "<!-- " + key + ": ";
    if (!comment.starts_with(start) || !comment.ends_with(" -->")) return std::nullopt;
    return comment.substr(start.size(), comment.size() - start.size() - 4);
}

std::vector<fs::path> markdown_files() {
    const fs::path root = source_folder();
    std::vector<fs::path> pages{root / "README.md", root / "CHANGELOG.md", root / "CONTRIBUTING.md"};
    for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") pages.push_back(entry.path());
    std::ranges::sort(pages);
    return pages;
}

std::vector<MarkdownBlock> blocks_of(const fs::path& page) {
    std::vector<MarkdownBlock> blocks;
    walk(page, [](const std::string&, int) {}, [&](const MarkdownBlock& block) { blocks.push_back(block); });
    return blocks;
}

std::vector<MarkdownLink> links_of(const fs::path& page) {
    static const std::regex pattern("\\]\\(([^)\\s]+)\\)");
    std::vector<MarkdownLink> links;
    const auto look = [&](const std::string& line, int number) {
        for (std::sregex_iterator at(line.begin(), line.end(), pattern), end; at != end; ++at)
            links.push_back({(*at)[1], number});
    };
    walk(page, look, [](const MarkdownBlock&) {});
    return links;
}

std::vector<std::string> anchors_of(const fs::path& page) {
    std::vector<std::string> anchors;
    const auto look = [&](const std::string& line, int) {
        if (!line.starts_with('#')) return;
        std::string anchor;
        for (const char c : line.substr(std::min(line.size(), line.find_first_not_of("# ")))) {
            const auto byte = static_cast<unsigned char>(c);
            if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80)
                anchor += static_cast<char>(std::tolower(byte));
            else if (c == ' ') anchor += '-';
        }
        anchors.push_back(anchor);
    };
    walk(page, look, [](const MarkdownBlock&) {});
    return anchors;
}

}  // namespace tactus::test
