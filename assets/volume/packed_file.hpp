// SPDX-License-Identifier: Apache-2.0
// Reads a file sequentially and unpacks gzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace tactus::volume {

class PackedFile {
public:
    /// Starts at byte `start`. Without `may_be_packed` the bytes are never unpacked. Throws Error when it cannot be
    /// opened.
    explicit PackedFile(const std::filesystem::path& path, std::uint64_t start = 0, bool may_be_packed = true);
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
    /// Upper bound of the unpacked size; deflate compresses at most 1032 to 1.
    double most_bytes() const;

private:
    std::string name_;
    double size_ = 0.0;
    void* file_ = nullptr;  // zlib's gzFile; null for a plain file
    std::ifstream plain_;
};

/// The storage type of samples, such as "int16".
struct SampleType {
    enum Kind { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 } kind = int16;
    std::size_t bytes() const;
    bool is_integer() const { return kind < float32; }
};

/// Reads `values.size()` samples; `swapped`: converts the byte order.
void read_samples(PackedFile& file, SampleType type, bool swapped, std::span<float> values);

}  // namespace tactus::volume
