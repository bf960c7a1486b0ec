// SPDX-License-Identifier: Apache-2.0
// The samples of a volume, one after the other in one or several files.
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
        std::uint64_t start = 0;  ///< byte of the file where samples, or what is packed, begin
        std::uint64_t skip = 0;   ///< bytes of what comes out of a packed file before its first sample
        std::size_t samples = 0;
    };

    SampleStream(std::vector<Piece> pieces, SampleType type, bool swapped, bool packed)
        : pieces_(std::move(pieces)), type_(type), swapped_(swapped), packed_(packed) {}

    /// Samples from `first` on. Those of packed files are cheap in ascending order; going back unpacks them from their
    /// start. The checksum of a packed file is compared when its last sample is read. Throws Error for what is cut short
    /// or damaged.
    void read(std::size_t first, std::span<float> values);

    bool in_any_order() const { return !packed_; }

private:
    std::vector<Piece> pieces_;
    SampleType type_;
    bool swapped_, packed_;
    std::unique_ptr<PackedFile> file_;  // of pieces_[piece_], its next sample is at_
    std::size_t piece_ = 0, at_ = 0;
};

}  // namespace tactus::volume
