// SPDX-License-Identifier: Apache-2.0
// A scan as input of the tracker: interpolated values, and excluded samples.
#pragma once

#include "dsp/volume/grid.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace tactus::vessel {

/// Trilinear values of a grid, except at samples of bone and stents. Not thread-safe: excluded samples are determined
/// on first use, in blocks.
class Scan {
public:
    /// `grid` must outlive the scan. Throws Error when an axis has fewer than two samples.
    explicit Scan(const volume::Grid& grid);

    /// Excludes bone, stents and calcifications: samples above `value` of whose 27 neighbours, themselves included, at
    /// least three are above it, and all samples closer than two voxels to them, because there the blur of bone has the
    /// values of a vessel. Infinity: excludes nothing.
    void exclude_above(double value);
    double excluded_above() const { return limit_; }
    /// Replaces lower values by `value`: next to lung and air, tissue would resemble a vessel.
    void clip_below(double value) { least_ = static_cast<float>(value); }

    const volume::Grid& grid() const { return grid_; }
    double voxel() const { return voxel_; }  ///< m, geometric mean of the spacing
    double voxel_volume() const { return voxel_ * voxel_ * voxel_; }

    /// Returns a position in units of samples.
    Vec3 index_of(const Vec3& position) const { return (position - grid_.origin) * per_metre_; }
    bool contains(const Vec3& position) const;
    /// Distance to the border of the scan, m; negative outside.
    double inside_by(const Vec3& position) const;
    /// Interpolates at a position; returns false outside of the scan and where the nearest sample is excluded.
    bool value(const Vec3& position, float& out) const;
    /// Interpolates at a position, excluded or not; outside of the scan at the nearest position inside.
    double any_value(const Vec3& position) const;
    bool is_excluded(const Vec3& position) const;
    /// Returns the variance of blur along a unit direction, m²: the sum of the scanner's point spread (a normal
    /// distribution of `psf_voxels` standard deviation) and of trilinear interpolation (a sixth of a voxel squared).
    double blur_variance(const Vec3& direction, double psf_voxels) const;

private:
    static constexpr int side = 16;  // of a block, samples
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
