// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"

#include "assets/file/outputs.hpp"
#include "assets/file/part_lock.hpp"
#include "assets/file/room.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace tactus::file {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// A file and its size in bytes.
std::pair<File, std::uintmax_t> open_regular(const std::filesystem::path& path) {
    const std::uintmax_t size = require_file(path);
    File file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    return {std::move(file), size};
}

}  // namespace

std::uintmax_t require_file(const std::filesystem::path& path) {
    std::error_code failure;
    const auto refuse = [&path](const std::string& why) { throw Error(fmt::format("{}: {}", path.string(), why)); };
    const std::filesystem::file_status status = std::filesystem::status(path, failure);
    switch (status.type()) {
        case std::filesystem::file_type::regular: break;
        case std::filesystem::file_type::not_found: refuse("no such file"); break;
        case std::filesystem::file_type::directory: refuse("this is a folder, not a file"); break;
        case std::filesystem::file_type::none: refuse(fmt::format("cannot be read: {}", failure.message())); break;
        default:
            refuse(
                "this is a pipe, a socket or a device; only regular files can be read. Write the data to a file first");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure) refuse(fmt::format("cannot be read: {}", failure.message()));
    return size;
}

std::string read_whole_file(const std::filesystem::path& path) {
    const auto [file, size] = open_regular(path);
    require_room(static_cast<double>(size), path, "its bytes");
    std::string bytes(size, '\0');
    constexpr std::size_t at_once = std::size_t{1} << 24;
    for (std::size_t at = 0; at < size; at += at_once) {
        leave_if_stopped();
        const std::size_t wanted = std::min(at_once, static_cast<std::size_t>(size) - at);
        if (std::fread(&bytes[at], 1, wanted, file.get()) != wanted)
            throw Error(fmt::format("{}: cannot be read to its end", path.string()));
    }
    return bytes;
}

void add_file(Hash& hash, const std::filesystem::path& path) {
    const auto [file, size] = open_regular(path);
    // A multiple of the hash's word size: only the last block may end within a word.
    std::vector<char> block(std::size_t{1} << 16);
    for (std::uintmax_t left = size; left > 0;) {
        leave_if_stopped();
        const auto wanted = static_cast<std::size_t>(std::min<std::uintmax_t>(left, block.size()));
        if (std::fread(block.data(), 1, wanted, file.get()) != wanted)
            throw Error(fmt::format("{}: cannot be read to its end", path.string()));
        hash.add_bytes(block.data(), wanted);
        left -= wanted;
    }
}

namespace {

enum class Disk { whenever, now };

/// Syncs the directory entry to disk. Failures of file systems that do not support this are ignored.
void sync_folder(const std::filesystem::path& folder) {
    const int handle = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0) return;
    ::fsync(handle);
    ::close(handle);
}

/// A stream cannot be replaced: /dev/stdout is a link, and a pipe has a reader.
void write_into(const std::filesystem::path& path, std::string_view bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    const bool is_written = file && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    const bool is_closed = file && std::fclose(file) == 0;
    if (!is_written || !is_closed)
        throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

void write_beside(const std::filesystem::path& path, std::string_view bytes, Disk disk) {
    if (is_stream(path)) return write_into(path, bytes);
    const std::filesystem::path part = path.string() + ".part";
    const PartLock lock(part, path);
    const auto fail = [&](int code) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(code)));
    };
    std::FILE* file = std::fopen(part.c_str(), "wb");
    if (!file) fail(errno);
    // The new file keeps the permissions of the file that it replaces.
    struct stat old{};
    if (::stat(path.c_str(), &old) == 0 && S_ISREG(old.st_mode))
        std::ignore = ::fchmod(::fileno(file), old.st_mode & 07777);
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0 &&
                         (disk == Disk::whenever || ::fsync(::fileno(file)) == 0);
    const int write_code = errno;
    const bool closed = std::fclose(file) == 0;
    if (!written) fail(write_code);
    if (!closed) fail(errno);
    if (std::rename(part.c_str(), path.c_str()) != 0) fail(errno);
    if (disk == Disk::now) sync_folder(path.parent_path());
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, std::string_view bytes) {
    write_beside(path, bytes, Disk::whenever);
}

void write_durable_file(const std::filesystem::path& path, std::string_view bytes) {
    write_beside(path, bytes, Disk::now);
}

}  // namespace tactus::file
