// SPDX-License-Identifier: Apache-2.0
// The formats whose files are damaged: where they come from, how they are sealed, and what reads them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::campaign {

struct Format {
    std::string name;
    /// Files, or folders of files one of which is damaged at a time.
    std::vector<std::filesystem::path> seeds;
    /// Words behind `tactus`; "FILE" stands for the damaged file or its folder.
    std::vector<std::vector<std::string>> verbs;
    /// What is damaged of a file's bytes, and the file of what was damaged: without and with packing, checksums and seals.
    std::function<std::string(const std::string&)> open = [](const std::string& bytes) { return bytes; };
    std::function<std::string(std::string, std::uint64_t)> close = [](std::string bytes, std::uint64_t) {
        return bytes;
    };
};

/// Makes seeds in `folder`, some with the command.
std::vector<Format> make_formats(const std::filesystem::path& folder);

}  // namespace tactus::campaign
