// SPDX-License-Identifier: Apache-2.0
// The size of a sound's file by its own header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tactus::sound {

/// Bytes that an AIFF, AIFC or AU states up to the end of its samples, a W64 for its whole file; none for other formats
/// and where the header leaves it open. libsndfile reads such files to their end without an error, however short they are.
/// For waves see repaired_wave_header.
std::optional<std::uint64_t> stated_size(const std::filesystem::path& path);

/// Bytes of a file of `size` behind that, which are no chunk: samples that the header does not count. 0 below eight bytes.
std::uint64_t unread_bytes(const std::filesystem::path& path, std::uint64_t size);

}  // namespace tactus::sound
