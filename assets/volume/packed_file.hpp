// SPDX-License-Identifier: Apache-2.0
// A file read from its start to its end, unpacked on the way when it is a gzip file.
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
    /// Begins at byte `start` of the file. Without `may_be_packed` bytes are taken as they are, whatever they look like.
    /// Throws Error when it cannot be opened.
    explicit PackedFile(const std::filesystem::path& path, std::uint64_t start = 0, bool may_be_packed = true);
    ~PackedFile();
    PackedFile(const PackedFile&) = delete;
    PackedFile& operator=(const PackedFile&) = delete;

    /// Fills `out`. Throws Error when the file ends before, or its packing is damaged.
    void read(std::span<char> out);
    /// As many bytes as there are.
    std::size_t read_some(std::span<char> out);
    void skip(std::uint64_t bytes);
    /// Reads what is left of a packed file, so that its checksum is compared. Throws Error when that differs.
    void finish();

    bool is_packed() const;
    /// More bytes than this cannot come out of it; deflate packs at most 1032 to 1.
    double most_bytes() const;

private:
    std::string name_;
    double size_ = 0.0;
    void* file_ = nullptr;  // zlib's gzFile; null for a plain file
    std::ifstream plain_;
};

/// How samples of `type` are stored in a file: "int16" and so on.
struct SampleType {
    enum Kind { uint8, int8, uint16, int16, uint32, int32, uint64, int64, float32, float64 } kind = int16;
    std::size_t bytes() const;
    bool is_integer() const { return kind < float32; }
};

/// Reads `values.size()` samples, turned about from the other byte order when `swapped`.
void read_samples(PackedFile& file, SampleType type, bool swapped, std::span<float> values);

}  // namespace tactus::volume
