// SPDX-License-Identifier: Apache-2.0
// A scan as the tracker sees it: values between samples, and which samples do not count.
#pragma once

#include "dsp/volume/grid.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace tactus::vessel {

/// Values of a grid between its samples (trilinear), without those of bone and stent. One thread at a time: excluded
/// samples are found on first use, in blocks.
class Scan {
public:
    /// `grid` must outlive the scan. Throws Error when an axis has fewer than two samples.
    explicit Scan(const volume::Grid& grid);

    /// Samples above `value` are bone, stent or calcification when at least three of their 27 neighbours, themselves
    /// included, are above it. They and all samples closer than two voxels are excluded: there the blur of bone has the
    /// values of a vessel. Infinity: nothing is excluded.
    void exclude_above(double value);
    double excluded_above() const { return limit_; }
    /// Lower values count as `value`: beside lung and air, tissue would look like a vessel.
    void clip_below(double value) { least_ = static_cast<float>(value); }

    const volume::Grid& grid() const { return grid_; }
    double voxel() const { return voxel_; }  ///< m, geometric mean of the spacing
    double voxel_volume() const { return voxel_ * voxel_ * voxel_; }

    /// Position in samples.
    Vec3 index_of(const Vec3& position) const { return (position - grid_.origin) * per_metre_; }
    bool contains(const Vec3& position) const;
    /// Distance to the border of the scan, m; negative outside.
    double inside_by(const Vec3& position) const;
    /// Value at a position; false outside of the scan and where the nearest sample is excluded.
    bool value(const Vec3& position, float& out) const;
    /// Value at a position, excluded or not; outside of the scan that of the nearest place in it.
    double any_value(const Vec3& position) const;
    bool is_excluded(const Vec3& position) const;
    /// Variance of blur along a unit direction, m²: that of the scanner's point spread (a normal distribution of
    /// `psf_voxels` standard deviation) and of trilinear interpolation, a sixth of a voxel squared.
    double blur_variance(const Vec3& direction, double psf_voxels) const;

private:
    static constexpr int side = 16;  // of a block
    using Block = std::array<std::uint8_t, side * side * side>;

    bool is_core(int i, int j, int k) const;
    const Block& block(std::size_t index, int i, int j, int k) const;
    bool is_excluded(int i, int j, int k) const;

    const volume::Grid& grid_;
    Vec3 per_metre_;
    double voxel_;
    double limit_ = std::numeric_limits<double>::infinity();
    float least_ = -std::numeric_limits<float>::infinity();
    std::array<int, 3> blocks_;
    mutable std::vector<std::unique_ptr<Block>> excluded_;
};

}  // namespace tactus::vessel
