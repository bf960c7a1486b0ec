// SPDX-License-Identifier: Apache-2.0
// How much memory one file may ask for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

namespace tactus::file {

/// A file needs more memory than there is for it: nothing is wrong with the file. It is a bad_alloc, so that whoever
/// handles short memory handles this.
class NoRoom : public std::bad_alloc {
public:
    explicit NoRoom(std::string message) : message_(std::move(message)) {}
    const char* what() const noexcept override { return message_.c_str(); }

private:
    std::string message_;
};

/// Bytes that one file may become in memory; until it is set, half of the machine's memory. Any thread may ask; set it
/// before others read files.
std::uint64_t memory_limit();
void set_memory_limit(std::uint64_t bytes);

/// "2 GB", "500 MB", "1.5 GiB" or a plain number of bytes. Throws Error.
std::uint64_t parse_memory_size(const std::string& text);

/// Throws NoRoom when `what` of `file`, `bytes` in memory, is more than memory_limit().
void require_room(double bytes, const std::filesystem::path& file, std::string_view what);

/// Throws Error when `file` claims more than it can hold: `claimed` against `most`, in the same unit, as in
/// require_possible(frames, 8192.0 * bytes, file, "samples").
void require_possible(double claimed, double most, const std::filesystem::path& file, std::string_view what);

}  // namespace tactus::file
