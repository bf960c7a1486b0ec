// SPDX-License-Identifier: Apache-2.0
// A bone file on disk: what OpenVDB writes, with a mark and a checksum behind it.
#pragma once

#include "assets/file/part_lock.hpp"
#include "dsp/core/hash.hpp"

#include <filesystem>
#include <fstream>
#include <streambuf>
#include <string>
#include <vector>

namespace tactus::bone {

/// Takes what OpenVDB writes to `path` + ".part" in blocks, so that a large bone is not in memory once more, with
/// another identifier (36 characters) and with the seal behind it. The file appears under its name by seal(); without
/// it nothing is left. Throws Error when it cannot be written.
class SealedFile final : public std::streambuf {
public:
    SealedFile(const std::filesystem::path& path, std::string identifier);
    ~SealedFile() override;
    SealedFile(const SealedFile&) = delete;
    SealedFile& operator=(const SealedFile&) = delete;

    void seal();

protected:
    int_type overflow(int_type next) override;
    // OpenVDB asks where it is; it goes nowhere else in a stream.
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

/// What stands before the seal: OpenVDB trusts the sizes it reads, so only bytes that are known to be whole reach it.
/// Throws Error for a file without seal or with another checksum.
std::string read_sealed(const std::filesystem::path& path);

}  // namespace tactus::bone
