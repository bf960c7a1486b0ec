// SPDX-License-Identifier: Apache-2.0
// The memory limit for one file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

namespace tactus::file {

/// Thrown when a valid file needs more memory than the limit. Derives from bad_alloc, so that handlers of memory
/// shortage catch it.
class NoRoom : public std::bad_alloc {
public:
    explicit NoRoom(std::string message) : message_(std::move(message)) {}
    const char* what() const noexcept override { return message_.c_str(); }

private:
    std::string message_;
};

/// Maximum size of one file in memory, bytes; default: half of the machine's memory. Any thread may read it; set it
/// before other threads read files.
std::uint64_t memory_limit();
void set_memory_limit(std::uint64_t bytes);

/// "2 GB", "500 MB", "1.5 GiB" or a plain number of bytes. Throws Error.
std::uint64_t parse_memory_size(const std::string& text);

/// Throws NoRoom when `what` of `file` needs more than memory_limit() bytes.
void require_room(double bytes, const std::filesystem::path& file, std::string_view what);

/// Throws Error if the header of `file` states more than the file can contain: `claimed` > `most`, in the same unit, as
/// in require_possible(frames, 8192.0 * bytes, file, "samples").
void require_possible(double claimed, double most, const std::filesystem::path& file, std::string_view what);

}  // namespace tactus::file
