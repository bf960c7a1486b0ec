// SPDX-License-Identifier: Apache-2.0
// The documentation as tests read it: fenced blocks with the remark before them, links, headings.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::test {

/// A fenced block: ```sh … ```. A remark is an HTML comment on the line before: <!-- file: ball.toml -->.
struct MarkdownBlock {
    std::string language, text;
    int line = 0;  ///< of the opening fence, from 1
    std::string comment;

    /// What follows "key:" in the remark; empty when there is no such remark.
    std::optional<std::string> remark(const std::string& key) const;
};

struct MarkdownLink {
    std::string target;  ///< as written, "takes.md#streams"
    int line = 0;
};

/// README.md, CHANGELOG.md, CONTRIBUTING.md and all pages under docs/, in order of names.
std::vector<std::filesystem::path> markdown_files();

std::vector<MarkdownBlock> blocks_of(const std::filesystem::path& page);
/// Links and pictures outside of fenced blocks.
std::vector<MarkdownLink> links_of(const std::filesystem::path& page);
/// What "#…" of a link may name: headings in lower case, blanks as '-', without punctuation, as GitHub does it.
std::vector<std::string> anchors_of(const std::filesystem::path& page);

}  // namespace tactus::test
