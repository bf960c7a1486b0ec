// SPDX-License-Identifier: Apache-2.0
#include "assets/file/cache.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <vector>

namespace tactus::file {

namespace {

namespace fs = std::filesystem;
using Clock = fs::file_time_type::clock;

// A part that nothing was added to for so long was left by a process that died.
constexpr auto abandoned = std::chrono::hours(24);

struct CachedFile {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes = 0;
    bool is_part = false;
};

/// Files may vanish while they are listed: other processes remove some, too.
std::vector<CachedFile> cached_files(const fs::path& root) {
    std::vector<CachedFile> files;
    std::error_code failure;
    if (root.empty()) return files;
    for (fs::recursive_directory_iterator at(root, failure), end; !failure && at != end; at.increment(failure)) {
        std::error_code gone;
        if (!at->is_regular_file(gone) || gone) continue;
        CachedFile one{at->path(), at->last_write_time(gone), 0, at->path().extension() == ".part"};
        if (gone) continue;
        one.bytes = at->file_size(gone);
        if (!gone) files.push_back(std::move(one));
    }
    return files;
}

void trim(const fs::path& root, const fs::path& newest, std::uintmax_t limit) {
    std::vector<CachedFile> files = cached_files(root);
    std::uintmax_t bytes = 0;
    for (const CachedFile& one : files) bytes += one.bytes;
    std::ranges::sort(files, {}, &CachedFile::used);
    const auto now = Clock::now();
    for (const CachedFile& one : files) {
        const bool is_abandoned = one.is_part && now - one.used > abandoned;
        if (!is_abandoned && (bytes <= limit || one.is_part || one.path == newest)) continue;
        std::error_code failure;
        if (fs::remove(one.path, failure)) bytes -= one.bytes;
    }
}

}  // namespace

fs::path root_of_cache() {
    // A relative path is not valid there (XDG base directory specification).
    if (const char* named = std::getenv("XDG_CACHE_HOME"); named && *named == '/') return fs::path(named) / "tactus";
    if (const char* home = std::getenv("HOME"); home && *home == '/') return fs::path(home) / ".cache" / "tactus";
    return {};
}

std::uintmax_t cache_limit() {
    constexpr std::uintmax_t megabyte = 1'000'000;
    std::uintmax_t megabytes = 4000;
    if (const char* given = std::getenv("TACTUS_CACHE_LIMIT")) {
        std::uintmax_t number = 0;
        const char* end = given + std::strlen(given);
        const auto [stop, code] = std::from_chars(given, end, number);
        if (code != std::errc{} || stop != end || number > 1'000'000'000)
            throw Error(fmt::format("TACTUS_CACHE_LIMIT is '{}'; give the cache's size in MB, or 0 for none", given));
        megabytes = number;
    }
    return megabytes * megabyte;
}

fs::path cache_folder() { return cache_limit() > 0 ? root_of_cache() : fs::path(); }

void write_cached(const fs::path& path, std::string_view bytes) noexcept {
    try {
        const std::uintmax_t limit = cache_limit();
        const fs::path root = cache_folder();
        if (root.empty() || bytes.size() > limit) return;
        fs::create_directories(path.parent_path());
        fs::permissions(root, fs::perms::owner_all);
        write_whole_file(path, bytes);
        trim(root, path, limit);
    } catch (const std::exception&) {
        // A result that is missing from the cache is computed again.
    }
}

void touch_cached(const fs::path& path) noexcept {
    std::error_code ignored;
    fs::last_write_time(path, Clock::now(), ignored);
}

std::string checksum(std::string_view bytes) {
    Hash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return fmt::format("{:016x}", hash.value());
}

CacheContent cache_content() {
    CacheContent content;
    for (const CachedFile& one : cached_files(root_of_cache())) ++content.files, content.bytes += one.bytes;
    return content;
}

CacheContent clear_cache() {
    CacheContent removed;
    for (const CachedFile& one : cached_files(root_of_cache())) {
        if (one.is_part && Clock::now() - one.used < abandoned) continue;
        std::error_code failure;
        if (fs::remove(one.path, failure)) ++removed.files, removed.bytes += one.bytes;
        else if (failure) throw Error(fmt::format("{}: cannot be removed: {}", one.path.string(), failure.message()));
    }
    return removed;
}

}  // namespace tactus::file
