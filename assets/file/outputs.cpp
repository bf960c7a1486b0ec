// SPDX-License-Identifier: Apache-2.0
#include "assets/file/outputs.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace tactus::file {

namespace fs = std::filesystem;

namespace {

/// The name of a file that need not exist yet.
fs::path full_name(const fs::path& path) {
    std::error_code failed;
    const fs::path full = fs::weakly_canonical(fs::absolute(path, failed), failed);
    return failed ? path : full;
}

}  // namespace

void check_outputs(std::span<const fs::path> sources, std::span<const fs::path> outputs) {
    std::error_code ignored;
    for (std::size_t n = 0; n < outputs.size(); ++n) {
        const fs::path& out = outputs[n];
        if (out.empty()) continue;
        for (const fs::path& source : sources)
            if (!source.empty() && fs::equivalent(source, out, ignored))
                throw Error(fmt::format("{}: this is a source, and the result would overwrite it; give another name",
                                        out.string()));
        for (std::size_t m = 0; m < n; ++m)
            if (!outputs[m].empty() && full_name(outputs[m]) == full_name(out))
                throw Error(
                    fmt::format("{}: two results have this name, and one would overwrite the other", out.string()));
        const fs::path folder = out.has_parent_path() ? out.parent_path() : ".";
        if (!fs::is_directory(folder, ignored))
            throw Error(fmt::format("{}: cannot be written: there is no folder {}", out.string(), folder.string()));
        if (::access(folder.c_str(), W_OK) != 0)
            throw Error(
                fmt::format("{}: cannot be written: the folder {} may not be changed", out.string(), folder.string()));
        if (fs::is_directory(out, ignored))
            throw Error(fmt::format("{}: this is a folder; name a file for the result", out.string()));
    }
}

}  // namespace tactus::file
