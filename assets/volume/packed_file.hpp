// SPDX-License-Identifier: Apache-2.0
// Reads a file sequentially and unpacks gzip or bzip2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

namespace tactus::volume {

enum class Packing {
    none,   ///< bytes are never unpacked
    gzip,   ///< unpacked if they begin with the mark of gzip
    bzip2,  ///< one stream or several in a row
};

class PackedFile {
public:
    /// Starts at byte `start`. Throws Error when it cannot be opened.
    explicit PackedFile(const std::filesystem::path& path, std::uint64_t start = 0, Packing packing = Packing::gzip);
    ~PackedFile();
    PackedFile(const PackedFile&) = delete;
    PackedFile& operator=(const PackedFile&) = delete;

    /// Fills `out`. Throws Error when the file ends early or the compressed data are damaged.
    void read(std::span<char> out);
    /// Reads up to `out.size()` bytes; returns their number.
    std::size_t read_some(std::span<char> out);
    void skip(std::uint64_t bytes);
    /// Reads the rest of a packed file to verify its checksum. Throws Error when it differs.
    void finish();

    bool is_packed() const;
    /// Upper bound of the unpacked size; deflate compresses at most 1032 to 1, bzip2 46 bytes to 45 million.
    double max_bytes() const;

private:
    std::string name_;
    double size_ = 0.0;
    void* file_ = nullptr;  // zlib's gzFile; null for a plain file
    std::ifstream plain_;
    class Bzip2;
    std::unique_ptr<Bzip2> bzip2_;
};

/// The storage type of samples, such as "int16".
struct SampleType {
    enum Kind { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 } kind = int16;
    std::size_t bytes() const;
    bool is_integer() const { return kind < float32; }
};

/// Converts `values.size()` samples; `swapped`: in the other byte order.
void unpack_samples(std::span<const char> bytes, SampleType type, bool swapped, std::span<float> values);
/// Reads `values.size()` samples; `swapped`: converts the byte order.
void read_samples(PackedFile& file, SampleType type, bool swapped, std::span<float> values);

}  // namespace tactus::volume
