// SPDX-License-Identifier: Apache-2.0
// A volume on axes of LPS, a few layers at a time.
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

/// The volume of a reader with its axes along those of LPS: mirrored and permuted axes are sorted, turned and sheared ones
/// interpolated onto the box around them (cubic; labels: the nearest sample), the outside being its lowest value.
///
/// Only those slices are held that the layers asked for are made of, two bytes per sample where all values are whole
/// numbers. These are few where slices of the file lie across the patient and follow each other upwards; with a tilted
/// gantry as many as a layer cuts; all where slices lie along the patient, where the volume is turned by much, or where a
/// packed file runs downwards.
class ReorientedVolume {
public:
    /// Throws Error when the box around a turned volume has more than a billion samples.
    ReorientedVolume(SliceReader& reader, RunJobs run);

    /// Size, origin and spacing; no values.
    const Grid& layout() const { return layout_; }
    bool is_turned() const { return turned_; }
    const std::string& source() const { return reader_.about.source; }

    /// Sets what the values mean (reader.about.kind, .hu): reads all slices that nobody asked for yet.
    void settle();
    const Tally& tally() const { return tally_; }

    /// From now on values are first · value + second.
    void set_line(std::optional<std::pair<double, double>> line) { line_ = line; }

    /// Samples along x and y, from low to high (inclusive).
    struct Window {
        std::array<int, 2> low, high;
    };
    Window whole_layer() const { return {{0, 0}, {layout_.size[0] - 1, layout_.size[1] - 1}}; }

    /// `count` layers from `first` on, or what a window shows of them; cheap in ascending order. Layers of a turned volume
    /// need settle() before.
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
    Axes file_axis_{0, 1, 2};  // that runs along x, y and z
    std::array<bool, 3> mirrored_{};  // by axes of the layout
    Mat3 back_{1.0};  // from m to samples of the file
    std::size_t width_ = 0;
    std::vector<CompactSlice> slices_;
    std::vector<char> is_counted_;
    Tally tally_;
    std::optional<std::pair<double, double>> line_;
};

/// The samples from `low` to `high` (inclusive), read a few layers at a time.
Grid part_of(ReorientedVolume& layers, const std::array<int, 3>& low, const std::array<int, 3>& high);
/// All samples.
Grid whole_of(ReorientedVolume& layers);

}  // namespace tactus::volume
