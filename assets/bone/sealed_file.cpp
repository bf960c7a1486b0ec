// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/sealed_file.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>

namespace tactus::bone {

namespace {

constexpr std::string_view seal_mark = "TACTUSBONE000001";
constexpr std::size_t seal_size = seal_mark.size() + 8;
// OpenVDB's identifier follows the magic (8 bytes), file version (4), library version (8) and one flag.
constexpr std::size_t identifier_offset = 21, identifier_size = 36;
constexpr std::size_t block_size =
    1 << 20;  // a multiple of the hash's word size, so that the block size does not change the hash

}  // namespace

SealedFile::SealedFile(const std::filesystem::path& path, std::string identifier)
    : path_(path),
      part_(path.string() + ".part"),
      lock_(part_, path_),
      identifier_(std::move(identifier)),
      block_(block_size, 0) {
    errno = 0;
    file_.open(part_, std::ios::binary | std::ios::trunc);
    if (!file_) throw Error(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
    setp(block_.data(), block_.data() + block_.size());
}

SealedFile::~SealedFile() {
    std::error_code ignored;
    if (!sealed_) std::filesystem::remove(part_, ignored);
}

void SealedFile::seal() {
    flush_block();
    const std::uint64_t hash = hash_.value();
    file_ << seal_mark;
    file_.write(reinterpret_cast<const char*>(&hash), sizeof hash);
    file_.close();
    if (!file_) fail();
    if (std::rename(part_.c_str(), path_.c_str()) != 0) fail();
    sealed_ = true;
}

SealedFile::int_type SealedFile::overflow(int_type next) {
    flush_block();
    if (!traits_type::eq_int_type(next, traits_type::eof())) sputc(traits_type::to_char_type(next));
    return traits_type::not_eof(next);
}

SealedFile::pos_type SealedFile::seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) {
    if (by != 0 || from != std::ios_base::cur) return pos_type(off_type(-1));
    return pos_type(static_cast<off_type>(written_ + static_cast<std::size_t>(pptr() - pbase())));
}

void SealedFile::fail() const {
    throw Error(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

void SealedFile::flush_block() {
    leave_if_stopped();
    const auto count = static_cast<std::size_t>(pptr() - pbase());
    if (written_ == 0) {
        if (count < identifier_offset + identifier_size) throw Error("OpenVDB wrote no header");
        std::copy(identifier_.begin(), identifier_.end(), block_.begin() + identifier_offset);
    }
    hash_.add_bytes(block_.data(), count);
    errno = 0;
    file_.write(block_.data(), static_cast<std::streamsize>(count));
    if (!file_.flush()) fail();
    written_ += count;
    setp(block_.data(), block_.data() + block_.size());
}

void add_in_pieces(Hash& hash, std::string_view bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += block_size) {
        leave_if_stopped();
        const std::string_view piece = bytes.substr(at, block_size);
        hash.add_bytes(piece.data(), piece.size());
    }
}

std::string read_sealed(const std::filesystem::path& path) {
    std::string bytes = file::read_whole_file(path);
    if (bytes.size() < seal_size || bytes.compare(bytes.size() - seal_size, seal_mark.size(), seal_mark) != 0)
        throw Error(
            fmt::format("{}: the bone file is incomplete, or another program wrote it; make it with 'tactus import'",
                        path.string()));
    std::uint64_t stated = 0;
    std::memcpy(&stated, bytes.data() + bytes.size() - sizeof stated, sizeof stated);
    bytes.resize(bytes.size() - seal_size);
    Hash hash;
    add_in_pieces(hash, bytes);
    if (hash.value() != stated)
        throw Error(
            fmt::format("{}: damaged (its checksum differs); make it again with 'tactus import'", path.string()));
    return bytes;
}

}  // namespace tactus::bone
