// SPDX-License-Identifier: Apache-2.0
// A bone file on disk: the data of OpenVDB, followed by a magic number and a checksum (the seal).
#pragma once

#include "assets/file/part_lock.hpp"
#include "dsp/core/hash.hpp"

#include <filesystem>
#include <fstream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::bone {

/// A stream buffer for OpenVDB that writes to `path` + ".part" in blocks, so that a large bone is not copied in memory.
/// It replaces the identifier (36 characters) and appends the seal. seal() renames the file to `path`; without seal()
/// the part is removed. Throws Error when it cannot be written.
class SealedFile final : public std::streambuf {
public:
    SealedFile(const std::filesystem::path& path, std::string identifier);
    ~SealedFile() override;
    SealedFile(const SealedFile&) = delete;
    SealedFile& operator=(const SealedFile&) = delete;

    void seal();

protected:
    int_type overflow(int_type next) override;
    // OpenVDB asks for the current position, but never seeks in a stream.
    pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override;

private:
    [[noreturn]] void fail() const;
    void flush_block();

    std::filesystem::path path_, part_;
    file::PartLock lock_;
    std::string identifier_;
    std::vector<char> block_;
    std::ofstream file_;
    Hash hash_;
    std::size_t written_ = 0;
    bool sealed_ = false;
};

/// Adds the bytes in chunks and checks for cancellation between chunks.
void add_in_pieces(Hash& hash, std::string_view bytes);

/// Returns the content before the seal. OpenVDB trusts the sizes in a file, so it must only receive verified bytes.
/// Throws Error if the seal is missing or the checksum differs.
std::string read_sealed(const std::filesystem::path& path);

}  // namespace tactus::bone
