// SPDX-License-Identifier: Apache-2.0
#include "assets/segmentation/stroke_recorder.hpp"
#include "assets/segmentation/erase_strokes.hpp"

#include <glm/geometric.hpp>

#include <utility>

namespace tactus::segmentation {

StrokeRecorder::StrokeRecorder(std::size_t max_strokes, std::size_t max_points)
    : max_strokes_(max_strokes), max_points_(max_points) {
    strokes_.reserve(max_strokes);
    points_.reserve(max_points);
}

void StrokeRecorder::touch(const Vec3& point, double radius, bool erases) noexcept {
    const double filed = as_filed(Vec3(radius)).x;
    if (!is_seed_place(point) || !(filed > 0.0 && filed <= widest_brush)) return lift();
    const bool goes_on = is_open_ && strokes_.back().radius == filed && strokes_.back().erases == erases;
    if (goes_on && !is_apart(points_.back(), filed, point)) return;
    if (points_.size() >= max_points_ || (!goes_on && strokes_.size() >= max_strokes_)) {
        is_full_ = true;
        return lift();
    }
    if (!goes_on) strokes_.push_back({points_.size(), filed, erases});
    points_.push_back(as_filed(point));
    is_open_ = true;
}

SeedLabel StrokeRecorder::label(std::string name) const {
    std::vector<SeedLabel> labels{{std::move(name), {}, {}}};
    for (std::size_t n = 0; n < strokes_.size(); ++n) {
        const std::size_t end = n + 1 < strokes_.size() ? strokes_[n + 1].first : points_.size();
        Stroke stroke{strokes_[n].radius,
                      {points_.begin() + static_cast<std::ptrdiff_t>(strokes_[n].first),
                       points_.begin() + static_cast<std::ptrdiff_t>(end)}};
        if (strokes_[n].erases) erase_strokes(labels, stroke);
        else labels[0].strokes.push_back(std::move(stroke));
    }
    return std::move(labels[0]);
}

}  // namespace tactus::segmentation
