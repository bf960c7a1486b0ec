// SPDX-License-Identifier: Apache-2.0
// Reads a scan slice by slice, so that it never has to be in memory as a whole.
#pragma once

#include "assets/volume/scan_volume.hpp"

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace tactus::volume {

/// Statistics over all values of a volume.
struct Tally {
    float low = 0.0f, high = 0.0f;
    std::size_t count = 0, zeros = 0, border = 0, border_zeros = 0;
    std::size_t not_numbers = 0;  ///< NaN and infinite values, which SliceReader::read_finite replaced
    bool whole = true;          ///< all are whole numbers from 0 to 65535
    std::set<int> labels{};     ///< distinct values while `whole` is true; incomplete above 1000

    /// Counts slice k.
    void add(std::span<const float> slice, int k, const std::array<int, 3>& size);
    /// Merges another tally.
    void add(const Tally& other);
};

class SliceReader {
public:
    SliceReader() = default;
    SliceReader(const SliceReader&) = delete;
    SliceReader& operator=(const SliceReader&) = delete;
    virtual ~SliceReader() = default;

    /// All properties but the values. Kind and hu are valid after settle().
    ScanVolume about;

    /// The values of slice k along the file's third axis. Throws Error for truncated or damaged data.
    virtual void read(int k, std::span<float> values) = 0;
    /// The same with finite values only: NaN and infinity, as programs write outside of the field of view, become the least
    /// value of the slice. Returns how many were replaced.
    std::size_t read_finite(int k, std::span<float> values);
    /// Layers of a label map whose segments overlap; 1: none do. `show_layer` selects the one that `read` returns, with the
    /// numbers of `about.segments`; −1: all, later segments over earlier ones.
    virtual int layer_count() const { return 1; }
    virtual void show_layer(int) {}
    /// True when slices can be read in any order at the same cost; false: only ascending order is fast.
    virtual bool in_any_order() const { return true; }
    /// Sets kind and hu from the tally of all slices. Throws Error when a value is not a number.
    virtual void settle(const Tally& tally) = 0;

    std::size_t slice_size() const {
        return static_cast<std::size_t>(about.size[0]) * static_cast<std::size_t>(about.size[1]);
    }
};

/// Opens the formats of read_volume and checks everything but the values. Throws Error like read_volume.
std::unique_ptr<SliceReader> open_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads the whole volume.
ScanVolume read_all(SliceReader& reader);

}  // namespace tactus::volume
