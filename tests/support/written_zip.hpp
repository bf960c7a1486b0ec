// SPDX-License-Identifier: Apache-2.0
// Zips for tests.
#pragma once

#include "assets/file/whole_file.hpp"

#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test {

/// Packs name and bytes of each file, by deflate.
inline void write_zip(const std::filesystem::path& path, const std::vector<std::pair<std::string, std::string>>& files,
                      const char* password = nullptr) {
    int code = 0;
    zip_t* zip = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (!zip) throw std::runtime_error("cannot write " + path.string());
    for (const auto& [name, bytes] : files) {
        zip_source_t* source = zip_source_buffer(zip, bytes.data(), bytes.size(), 0);
        const zip_int64_t index = zip_file_add(zip, name.c_str(), source, ZIP_FL_ENC_UTF_8);
        if (index < 0) throw std::runtime_error("cannot add " + name);
        zip_set_file_compression(zip, static_cast<zip_uint64_t>(index), ZIP_CM_DEFLATE, 6);
        if (password) zip_file_set_encryption(zip, static_cast<zip_uint64_t>(index), ZIP_EM_AES_128, password);
    }
    if (zip_close(zip) != 0) throw std::runtime_error("cannot close " + path.string());
}

/// Overwrites `size` bytes of a number in the last central record that begins with `mark`.
inline void patch_zip(const std::filesystem::path& path, const std::string& mark, std::size_t offset, std::size_t size,
                      std::uint64_t value) {
    std::string bytes = file::read_whole_file(path);
    const std::size_t at = bytes.rfind(mark);
    if (at == std::string::npos) throw std::runtime_error("no such record");
    for (std::size_t n = 0; n < size; ++n) bytes[at + offset + n] = static_cast<char>(value >> (8 * n) & 0xff);
    file::write_whole_file(path, bytes);
}

inline const std::string central_record("PK\1\2", 4);
inline const std::string end_record("PK\5\6", 4);

}  // namespace tactus::test
