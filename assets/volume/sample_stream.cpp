// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/sample_stream.hpp"

#include <algorithm>

namespace tactus::volume {

void SampleStream::read(std::size_t first, std::span<float> values) {
    const bool is_packed = packing_ != Packing::none;
    std::size_t piece = 0, at = first;
    while (!values.empty()) {
        while (at >= pieces_.at(piece).samples) at -= pieces_[piece++].samples;
        const Piece& from = pieces_[piece];
        if (!file_ || piece != piece_ || (at != at_ && (!is_packed || at < at_))) {
            const std::uint64_t begin = is_packed ? 0 : at * type_.bytes();
            file_ = std::make_unique<PackedFile>(from.file, from.start + begin, packing_);
            piece_ = piece;
            at_ = is_packed ? 0 : at;
            if (is_packed) file_->skip(from.skip);
        }
        if (at > at_) file_->skip((at - at_) * type_.bytes());
        const std::size_t count = std::min(values.size(), from.samples - at);
        read_samples(*file_, type_, swapped_, values.first(count));
        values = values.subspan(count);
        at_ = at += count;
        if (at == from.samples) file_->finish();
    }
}

}  // namespace tactus::volume
