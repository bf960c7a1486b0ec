// SPDX-License-Identifier: Apache-2.0
// A volume of patient data that is read slice by slice, so that it never stands in memory as a whole.
#pragma once

#include "assets/volume/scan_volume.hpp"

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace tactus::volume {

/// What all values together say about a volume.
struct Tally {
    float low = 0.0f, high = 0.0f;
    std::size_t count = 0, zeros = 0, border = 0, border_zeros = 0;
    bool finite = true;
    bool whole = true;          ///< all are whole numbers from 0 to 65535
    std::set<int> labels{};     ///< the different values, as long as `whole`; once there are more than 1000, not all

    /// Slice k of `size`.
    void add(std::span<const float> slice, int k, const std::array<int, 3>& size);
    /// What was counted elsewhere.
    void add(const Tally& other);
};

class SliceReader {
public:
    SliceReader() = default;
    SliceReader(const SliceReader&) = delete;
    SliceReader& operator=(const SliceReader&) = delete;
    virtual ~SliceReader() = default;

    /// All but the values. What they mean is only known after settle().
    ScanVolume about;

    /// The values of slice k along the file's third axis. Throws Error for what is cut short or damaged.
    virtual void read(int k, std::span<float> values) = 0;
    /// Whether slices cost the same in any order; else they are cheap only in ascending order.
    virtual bool in_any_order() const { return true; }
    /// Sets kind and hu, once all slices are in the tally. Throws Error when a value is not a number.
    virtual void settle(const Tally& tally) = 0;

    std::size_t slice_size() const {
        return static_cast<std::size_t>(about.size[0]) * static_cast<std::size_t>(about.size[1]);
    }
};

/// Opens what read_volume reads: checks all that can be checked before the values are. Throws Error as it does.
std::unique_ptr<SliceReader> open_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// The volume with all its values.
ScanVolume read_all(SliceReader& reader);

}  // namespace tactus::volume
