// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <fstream>
#include <unordered_set>

namespace tactus::patch {

namespace {

/// Text of a patch file. Throws Error.
std::string patch_text(const std::filesystem::path& file) {
    const SourceLocation where{file.string(), 0, 0};
    std::error_code failure;
    if (std::filesystem::is_directory(file, failure)) throw Error(where, "is a folder, not a patch");
    if (std::filesystem::exists(file, failure) && !std::filesystem::is_regular_file(file, failure))
        throw Error(where, "is a pipe, a socket or a device; write the patch to a file first");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw Error(where, std::filesystem::exists(file, failure) ? "the patch cannot be read; look at its permissions"
                                                                  : "there is no such patch");
    constexpr std::uintmax_t largest = 16u << 20;
    const std::uintmax_t size = std::filesystem::file_size(file, failure);
    if (failure || size > largest)
        throw Error(where, fmt::format("larger than {} MB; that is no patch", largest >> 20));
    std::string text(static_cast<std::size_t>(size), '\0');
    stream.read(text.data(), static_cast<std::streamsize>(size));
    if (stream.bad()) throw Error(where, "the patch cannot be read to its end");
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

}  // namespace

Patch load_patch(const std::filesystem::path& file, Problems& problems) {
    Patch patch = read_patch(patch_text(file), file, problems);
    read_parts(patch);
    return patch;
}

void read_parts(Patch& patch) {
    std::unordered_set<std::string> known;
    for (const PatchPart& part : patch.parts) known.insert(part.path);
    const auto read_named = [&patch, &known](const std::vector<PatchNode>& nodes, const std::string& from) {
        for (const PatchNode& node : nodes) {
            if (!is_sub_patch(node)) continue;
            const std::string path = part_path(from, node.type);
            if (known.contains(path)) continue;
            try {
                patch.parts.push_back({path, patch_text(file_of_part(patch, path))});
                known.insert(path);
            } catch (const Error&) {
                // flatten() reports the error at the node that names the file.
            }
        }
    };
    read_named(patch.nodes, "");
    for (std::size_t p = 0; p < patch.parts.size(); ++p) {
        const std::string path = patch.parts[p].path;
        Problems told_later;
        read_named(read_patch(patch.parts[p].text, file_of_part(patch, path), told_later).nodes, path);
    }
}

}  // namespace tactus::patch
