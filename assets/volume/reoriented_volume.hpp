// SPDX-License-Identifier: Apache-2.0
// Reorients a volume to LPS axes, a few layers at a time.
#pragma once

#include "assets/volume/slice_reader.hpp"
#include "dsp/core/jobs.hpp"
#include "dsp/volume/compact_slice.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tactus::volume {

/// A volume with axes along LPS. Mirrored and permuted axes are reordered. Rotated and sheared volumes are interpolated
/// onto their bounding box (cubic; labels: nearest sample); samples outside get the lowest value.
///
/// Memory: only the slices needed for the requested layers are cached, with 2 bytes per sample when all values are
/// whole numbers. These are few when the slices are axial and ascending; with a tilted gantry, as many as a layer
/// crosses; all of them when the slices are sagittal or coronal, when the volume is strongly rotated, or when a packed
/// file runs downwards.
class ReorientedVolume {
public:
    /// Throws Error when the bounding box of a rotated volume has more than a billion samples.
    ReorientedVolume(SliceReader& reader, RunJobs run);

    /// Size, origin and spacing; no values.
    const Grid& layout() const { return layout_; }
    bool is_turned() const { return turned_; }
    const std::string& source() const { return reader_.about.source; }

    /// Determines the kind of values (reader.about.kind, .hu); reads all slices that were not read yet.
    void settle();
    const Tally& tally() const { return tally_; }
    /// Least and greatest value of the file, after set_line. Valid after settle().
    std::pair<double, double> range() const;

    /// Applies first · value + second to all values from now on.
    void set_line(std::optional<std::pair<double, double>> line) { line_ = line; }

    /// A range of samples in x and y, low to high inclusive.
    struct Window {
        std::array<int, 2> low, high;
    };
    Window whole_layer() const { return {{0, 0}, {layout_.size[0] - 1, layout_.size[1] - 1}}; }

    /// `count` layers from `first` on, or a window of them; fast in ascending order. A rotated volume needs settle()
    /// first.
    Grid layers(int first, int count) { return layers(first, count, whole_layer()); }
    Grid layers(int first, int count, const Window& window);

private:
    using Axes = std::array<int, 3>;

    void sort_axes();
    void box_around();
    void read(const std::vector<int>& slices, bool keep);
    void hold(int first, int last);
    std::pair<int, int> slices_for(int first, int count) const;
    float value(int i, int j, int k) const {
        return slices_[static_cast<std::size_t>(k)][static_cast<std::size_t>(j) * width_ + static_cast<std::size_t>(i)];
    }
    double cubic_at(const Vec3& u) const;
    double nearest_at(const Vec3& u) const;
    void sorted_row(int first, int j, int k, std::span<float> out) const;

    SliceReader& reader_;
    RunJobs run_;
    Grid layout_;
    bool turned_ = false, settled_ = false, keep_all_ = false;
    Axes file_axis_{0, 1, 2};  // along x, y and z
    std::array<bool, 3> mirrored_{};  // per axis of the layout
    Mat3 back_{1.0};  // maps m to samples of the file
    std::size_t width_ = 0;
    std::vector<CompactSlice> slices_;
    std::vector<char> is_counted_;
    Tally tally_;
    std::optional<std::pair<double, double>> line_;
};

/// Reads the samples from `low` to `high` (inclusive), a few layers at a time.
Grid part_of(ReorientedVolume& layers, const std::array<int, 3>& low, const std::array<int, 3>& high);
/// Reads all samples.
Grid whole_of(ReorientedVolume& layers);

}  // namespace tactus::volume
