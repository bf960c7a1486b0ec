// SPDX-License-Identifier: Apache-2.0
#include "graph/patch.hpp"

#include <fmt/format.h>

#include <fstream>

namespace tactus {

Patch load_patch(const std::filesystem::path& file, Problems& problems) {
    const SourceLocation where{file.string(), 0, 0};
    std::error_code failure;
    if (std::filesystem::is_directory(file, failure)) throw Error(where, "is a folder, not a patch");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw Error(where, std::filesystem::exists(file, failure) ? "the patch cannot be read; look at its permissions"
                                                                  : "there is no such patch");
    // A pipe or a device has no size to ask for, so what is read is bounded instead.
    constexpr std::size_t largest = 16u << 20;
    std::string text(64u << 10, '\0');
    std::size_t used = 0;
    while (stream.read(text.data() + used, static_cast<std::streamsize>(text.size() - used)), stream.gcount() > 0) {
        used += static_cast<std::size_t>(stream.gcount());
        if (used > largest) throw Error(where, fmt::format("larger than {} MB; that is no patch", largest >> 20));
        if (used == text.size()) text.resize(2 * used);
    }
    if (stream.bad()) throw Error(where, "the patch cannot be read to its end");
    text.resize(used);
    return read_patch(text, file, problems);
}

}  // namespace tactus
