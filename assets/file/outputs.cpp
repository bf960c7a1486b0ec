// SPDX-License-Identifier: Apache-2.0
#include "assets/file/outputs.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace tactus::file {

namespace fs = std::filesystem;

namespace {

/// The name of a file that need not exist yet.
fs::path full_name(const fs::path& path) {
    std::error_code failed;
    const fs::path full = fs::weakly_canonical(fs::absolute(path, failed), failed);
    return failed ? path : full;
}

/// The texts between quotes of a TOML or JSON file, which need not be correct.
std::vector<std::string> quoted_texts(const fs::path& path) {
    constexpr std::uintmax_t largest = 64u << 20;  // bytes
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (failed || size > largest) return {};
    std::ifstream file(path, std::ios::binary);
    const std::string all{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::string> texts;
    for (std::size_t at = all.find_first_of("\"'"); at < all.size(); at = all.find_first_of("\"'", at)) {
        const char quote = all[at++];
        std::string text;
        for (; at < all.size() && all[at] != quote && all[at] != '\n'; ++at) {
            if (all[at] == '\\' && quote == '"' && at + 1 < all.size()) ++at;
            text += all[at];
        }
        if (at < all.size()) ++at;
        if (!text.empty() && text.size() < 4096) texts.push_back(std::move(text));
    }
    return texts;
}

bool is_below(const fs::path& file, const fs::path& folder) {
    const fs::path whole = full_name(file), above = full_name(folder);
    return std::ranges::mismatch(above, whole).in1 == above.end();
}

/// Whether `out`, which exists, is `source`, lies in it, or is named by it or by a file that it names. Pages and
/// figures in a folder are results: no verb reads them.
bool belongs_to(const fs::path& source, const fs::path& out, std::set<fs::path>& seen) {
    std::error_code failed;
    if (fs::equivalent(source, out, failed)) return true;
    if (!seen.insert(full_name(source)).second) return false;
    const std::string ending = out.extension().string();
    if (fs::is_directory(source, failed))
        return ending != ".html" && ending != ".pdf" && ending != ".svg" && ending != ".png" && is_below(out, source);
    const std::string kind = source.extension().string();
    if ((kind != ".toml" && kind != ".json") || !fs::is_regular_file(source, failed)) return false;
    return std::ranges::any_of(quoted_texts(source), [&](const std::string& text) {
        const fs::path named = source.parent_path() / text.substr(0, text.rfind('#'));
        // A folder that a text names by chance, such as ".", protects nothing; one that holds a scan has no results.
        const bool is_there = fs::exists(named, failed) && !failed && !is_below(source, named);
        return is_there && belongs_to(named, out, seen);
    });
}

}  // namespace

bool is_stream(const fs::path& out) {
    const std::string name = out.string();
    // Sent into a file, these are links to it.
    if (name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/") ||
        name.starts_with("/proc/self/fd/"))
        return true;
    std::error_code failed;
    const fs::file_status found = fs::status(out, failed);
    return !failed && fs::exists(found) && !fs::is_regular_file(found) && !fs::is_directory(found);
}

bool is_of_source(const fs::path& source, const fs::path& out) {
    std::error_code failed;
    std::set<fs::path> seen;
    return fs::exists(out, failed) && belongs_to(source, out, seen);
}

void check_outputs(std::span<const fs::path> sources, std::span<const fs::path> outputs) {
    std::error_code ignored;
    for (std::size_t n = 0; n < outputs.size(); ++n) {
        const fs::path& out = outputs[n];
        if (out.empty()) continue;
        for (const fs::path& source : sources)
            if (!source.empty() && is_of_source(source, out))
                throw Error(fmt::format(
                    "{}: this is a source{}, and the result would overwrite it; give another name", out.string(),
                    fs::equivalent(source, out, ignored) ? "" : fmt::format(" (of {})", source.string())));
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
