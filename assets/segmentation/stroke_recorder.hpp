// SPDX-License-Identifier: Apache-2.0
// Records the strokes of a haptic brush while they are painted.
#pragma once

#include "assets/segmentation/seeds_file.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::segmentation {

/// Records the same points of a path as the painting window would, so that both give the same seeds. Only the
/// constructor and label() allocate.
class StrokeRecorder {
public:
    StrokeRecorder(std::size_t max_strokes, std::size_t max_points);

    /// Reports that the brush is on the bone at `point`, m. Continues the open stroke or starts one; a change of the
    /// radius or of `erases` also starts one. A position or radius that a seeds file cannot store lifts the brush.
    void touch(const Vec3& point, double radius, bool erases) noexcept;
    void lift() noexcept { is_open_ = false; }

    std::size_t strokes() const noexcept { return strokes_.size(); }
    /// Number of points of all strokes.
    std::size_t points() const noexcept { return points_.size(); }
    bool is_open() const noexcept { return is_open_; }
    /// The newest recorded point; requires points.
    const Vec3& newest_point() const noexcept { return points_.back(); }
    double newest_radius() const noexcept { return strokes_.back().radius; }
    bool newest_erases() const noexcept { return strokes_.back().erases; }
    /// True if some points were dropped for lack of room.
    bool is_full() const noexcept { return is_full_; }
    /// Returns the strokes after erasing.
    SeedLabel label(std::string name) const;

private:
    struct Kept {
        std::size_t first;
        double radius;
        bool erases;
    };

    std::vector<Kept> strokes_;
    std::vector<Vec3> points_;
    std::size_t max_strokes_, max_points_;
    bool is_open_ = false, is_full_ = false;
};

}  // namespace tactus::segmentation
