// SPDX-License-Identifier: Apache-2.0
// Scans of tubes with known centre lines: partial volume, blur and noise of a scanner.
#pragma once

#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace tactus::simulate {

/// Adds noise of standard deviation `sigma`. `correlation` 0: white; otherwise the standard deviation, in samples, of
/// the normal filter that it has passed.
void add_noise(volume::Grid& grid, double sigma, double correlation, std::uint64_t seed);

/// Lengths in m. Shapes are sampled three times finer than the grid.
class VesselPhantom {
public:
    VesselPhantom(std::array<int, 3> size, double voxel);

    /// Balls of radius(s) at the points of `line`, s from 0 to 1, at most a sixth of a sample apart; cut flat across the line at
    /// both ends.
    void add_tube(const std::vector<Vec3>& line, const std::function<double(double)>& radius, double value);
    /// Places closer to the line than the radius at its nearest point: a vessel whose radius changes quickly. (Balls of the wide
    /// parts would reach into a short narrowing.) `aside`, not empty: moves the cross-section there. Both ends flat.
    void add_lumen(const std::vector<Vec3>& line, const std::function<double(double)>& radius, double value,
                   const std::function<Vec3(double)>& aside = {});
    /// Every place for which `inside` is true.
    void add_body(const std::function<bool(const Vec3&)>& inside, double value);

    /// The scan: background plus shapes, blurred by a normal point spread of 0.6 samples, plus white noise.
    volume::Grid scan(double background, double noise, std::uint64_t seed) const;

    const volume::Grid& layout() const { return layout_; }

private:
    static constexpr int finer = 3;

    void set(int i, int j, int k, double value);
    Vec3 fine_position(int i, int j, int k) const;

    volume::Grid layout_;
    std::vector<float> fine_;  // above the background
};

/// A helix about the z axis through `centre`, points `spacing` apart.
std::vector<Vec3> helix(const Vec3& centre, double radius, double pitch, double turns, double spacing);
/// From a to b, points `spacing` apart.
std::vector<Vec3> straight(const Vec3& a, const Vec3& b, double spacing);

}  // namespace tactus::simulate
