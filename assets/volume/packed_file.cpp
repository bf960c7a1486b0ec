// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/packed_file.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <bzlib.h>
#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <optional>
#include <vector>

namespace tactus::volume {

namespace {

gzFile handle(void* file) { return static_cast<gzFile>(file); }

template <typename T>
void unpack(std::span<const char> bytes, bool swapped, std::span<float> values) {
    for (std::size_t n = 0; n < values.size(); ++n) {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes.data() + n * sizeof(T), sizeof(T));
        if (swapped) std::reverse(raw.begin(), raw.end());
        T value;
        std::memcpy(&value, raw.data(), sizeof(T));
        values[n] = static_cast<float>(value);
    }
}

}  // namespace

class PackedFile::Bzip2 {
public:
    explicit Bzip2(std::ifstream& file) : file_(file) { open(); }
    ~Bzip2() { BZ2_bzDecompressEnd(&stream_); }

    /// Fills `out` as far as there are data; none when they are damaged.
    std::optional<std::size_t> read(std::span<char> out) {
        std::size_t done = 0;
        while (done < out.size()) {
            if (stream_.avail_in == 0) {
                file_.read(packed_.data(), static_cast<std::streamsize>(packed_.size()));
                stream_.next_in = packed_.data();
                stream_.avail_in = static_cast<unsigned>(file_.gcount());
                if (stream_.avail_in == 0) break;
            }
            if (has_ended_) {
                // Parallel compressors write several streams in sequence. Anything else after a stream is ignored.
                if (*stream_.next_in != 'B') break;
                BZ2_bzDecompressEnd(&stream_);
                open();
            }
            const auto part = static_cast<unsigned>(std::min<std::size_t>(out.size() - done, 1u << 26));
            stream_.next_out = out.data() + done;
            stream_.avail_out = part;
            const int code = BZ2_bzDecompress(&stream_);
            if (code != BZ_OK && code != BZ_STREAM_END) return std::nullopt;
            has_ended_ = code == BZ_STREAM_END;
            done += part - stream_.avail_out;
        }
        return done;
    }
    /// The last stream that was read is whole.
    bool has_ended() const { return has_ended_; }

private:
    void open() {
        char* const next = stream_.next_in;
        const unsigned left = stream_.avail_in;
        stream_ = {};
        if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
        stream_.next_in = next;
        stream_.avail_in = left;
        has_ended_ = false;
    }

    std::ifstream& file_;
    bz_stream stream_{};
    std::vector<char> packed_ = std::vector<char>(1 << 18);
    bool has_ended_ = false;
};

PackedFile::PackedFile(const std::filesystem::path& path, std::uint64_t start, Packing packing) : name_(path.string()) {
    const std::uintmax_t size = file::require_file(path);
    if (start > size) throw Error(fmt::format("{}: cut short; copy the file again", name_));
    size_ = static_cast<double>(size - start);
    if (packing != Packing::gzip) {
        plain_.open(path, std::ios::binary);
        plain_.seekg(static_cast<std::streamoff>(start));
        if (!plain_) throw Error(fmt::format("{}: cannot be read", name_));
        if (packing == Packing::bzip2) bzip2_ = std::make_unique<Bzip2>(plain_);
        return;
    }
    const int descriptor = open(name_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor >= 0 && lseek(descriptor, static_cast<off_t>(start), SEEK_SET) >= 0)
        file_ = gzdopen(descriptor, "rb");
    if (!file_) {
        if (descriptor >= 0 && !file_) close(descriptor);
        throw Error(fmt::format("{}: cannot be read", name_));
    }
    gzbuffer(handle(file_), 1u << 18);
    gzdirect(handle(file_));  // detects gzip from the first bytes
}

PackedFile::~PackedFile() {
    if (file_) gzclose_r(handle(file_));
}

bool PackedFile::is_packed() const { return bzip2_ || (file_ && gzdirect(handle(file_)) == 0); }

double PackedFile::max_bytes() const { return bzip2_ ? size_ * 1e6 : is_packed() ? size_ * 1032.0 : size_; }

std::size_t PackedFile::read_some(std::span<char> out) {
    if (bzip2_) {
        const std::optional<std::size_t> count = bzip2_->read(out);
        if (!count) throw Error(fmt::format("{}: its compressed data are damaged; copy the file again", name_));
        return *count;
    }
    if (!file_) {
        plain_.read(out.data(), static_cast<std::streamsize>(out.size()));
        return static_cast<std::size_t>(plain_.gcount());
    }
    std::size_t done = 0;
    while (done < out.size()) {
        const auto part = static_cast<unsigned>(std::min<std::size_t>(out.size() - done, 1u << 26));
        const int got = gzread(handle(file_), out.data() + done, part);
        if (got < 0) throw Error(fmt::format("{}: its compressed data are damaged; copy the file again", name_));
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

void PackedFile::read(std::span<char> out) {
    if (read_some(out) != out.size()) throw Error(fmt::format("{}: cut short; copy the file again", name_));
}

void PackedFile::skip(std::uint64_t bytes) {
    std::array<char, 1 << 16> rest;
    while (bytes > 0) {
        leave_if_stopped();
        const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, rest.size()));
        read(std::span(rest).first(part));
        bytes -= part;
    }
}

void PackedFile::finish() {
    if (!file_ && !bzip2_) return;
    std::array<char, 1 << 16> rest;
    while (is_packed() && read_some(rest) > 0) leave_if_stopped();
    int code = Z_OK;
    if (file_) gzerror(handle(file_), &code);
    if ((bzip2_ && !bzip2_->has_ended()) || (code != Z_OK && code != Z_STREAM_END))
        throw Error(fmt::format("{}: cut short; copy the file again", name_));
}

std::size_t SampleType::bytes() const {
    constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(kind)];
}

void unpack_samples(std::span<const char> bytes, SampleType type, bool swapped, std::span<float> values) {
    switch (type.kind) {
        case SampleType::uint8: return unpack<std::uint8_t>(bytes, swapped, values);
        case SampleType::int8: return unpack<std::int8_t>(bytes, swapped, values);
        case SampleType::uint16: return unpack<std::uint16_t>(bytes, swapped, values);
        case SampleType::int16: return unpack<std::int16_t>(bytes, swapped, values);
        case SampleType::uint32: return unpack<std::uint32_t>(bytes, swapped, values);
        case SampleType::int32: return unpack<std::int32_t>(bytes, swapped, values);
        case SampleType::uint64: return unpack<std::uint64_t>(bytes, swapped, values);
        case SampleType::int64: return unpack<std::int64_t>(bytes, swapped, values);
        case SampleType::float32: return unpack<float>(bytes, swapped, values);
        case SampleType::float64: return unpack<double>(bytes, swapped, values);
    }
}

void read_samples(PackedFile& file, SampleType type, bool swapped, std::span<float> values) {
    constexpr std::size_t at_once = 1 << 16;
    std::vector<char> bytes(at_once * type.bytes());
    for (std::size_t done = 0; done < values.size(); done += at_once) {
        leave_if_stopped();
        const std::size_t count = std::min(at_once, values.size() - done);
        const auto part = std::span(bytes).first(count * type.bytes());
        file.read(part);
        unpack_samples(part, type, swapped, values.subspan(done, count));
    }
}

}  // namespace tactus::volume
