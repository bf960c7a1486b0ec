// SPDX-License-Identifier: Apache-2.0
// Strokes of a brush in the hand, kept while they are painted.
#pragma once

#include "assets/segment/seeds_file.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::segment {

/// Keeps the points that the painting window would keep of the same path, so that both give the same seeds. Allocates in the
/// constructor, and in label() alone.
class StrokeRecorder {
public:
    StrokeRecorder(std::size_t most_strokes, std::size_t most_points);

    /// The brush is on the bone at `point`, m. Continues the open stroke, or begins one: also when the radius changes or when
    /// the brush erases from now on. A place or radius that a seeds file cannot hold lifts the brush.
    void touch(const Vec3& point, double radius, bool erases) noexcept;
    void lift() noexcept { is_open_ = false; }

    std::size_t strokes() const noexcept { return strokes_.size(); }
    /// Of all strokes.
    std::size_t points() const noexcept { return points_.size(); }
    bool is_open() const noexcept { return is_open_; }
    /// What was kept last, once there are points.
    const Vec3& newest_point() const noexcept { return points_.back(); }
    double newest_radius() const noexcept { return strokes_.back().radius; }
    bool newest_erases() const noexcept { return strokes_.back().erases; }
    /// There was no room for everything.
    bool is_full() const noexcept { return is_full_; }
    /// What is left of the strokes where they were erased.
    SeedLabel label(std::string name) const;

private:
    struct Kept {
        std::size_t first;
        double radius;
        bool erases;
    };

    std::vector<Kept> strokes_;
    std::vector<Vec3> points_;
    std::size_t most_strokes_, most_points_;
    bool is_open_ = false, is_full_ = false;
};

}  // namespace tactus::segment
