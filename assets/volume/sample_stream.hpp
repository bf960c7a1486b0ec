// SPDX-License-Identifier: Apache-2.0
// Streams the samples of a volume from one or several files.
#pragma once

#include "assets/volume/packed_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace tactus::volume {

class SampleStream {
public:
    struct Piece {
        std::filesystem::path file;
        std::uint64_t start = 0;  ///< offset of the samples or of the packed data in the file, bytes
        std::uint64_t skip = 0;   ///< unpacked bytes before the first sample
        std::size_t samples = 0;
    };

    SampleStream(std::vector<Piece> pieces, SampleType type, bool swapped, Packing packing)
        : pieces_(std::move(pieces)), type_(type), swapped_(swapped), packing_(packing) {}

    /// Reads samples from `first` on. Packed files are fast in ascending order; going back unpacks from the start. The
    /// checksum of a packed file is verified with its last sample. Throws Error for truncated or damaged data.
    void read(std::size_t first, std::span<float> values);

    bool in_any_order() const { return packing_ == Packing::none; }

private:
    std::vector<Piece> pieces_;
    SampleType type_;
    bool swapped_;
    Packing packing_;
    std::unique_ptr<PackedFile> file_;  // open file of pieces_[piece_]; at_ is its next sample
    std::size_t piece_ = 0, at_ = 0;
};

}  // namespace tactus::volume
