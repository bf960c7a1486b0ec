// SPDX-License-Identifier: Apache-2.0
// The body swept by a moving edge, and the distance to it.
#pragma once

#include "dsp/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::carve {

/// A segment of the edge between two nodes, before (0) and after (1) a step, m. Frame: x along the edge, y the cutting
/// direction.
struct SweptSpan {
    Vec3 a0, b0, a1, b1;
    bool moved = false;  ///< false: it sweeps nothing new
    bool fresh = false;  ///< the edge was placed here; no path leads to it
};

/// Rounded sheet swept by a row of spans. Where neighbours differ in depth by more than their spacing, the edge between
/// them is raised towards the shallower one, completely from twice the spacing on. The reason: the teeth that cut there
/// pass both positions, and the deeper one is in air.
class SweptEdge {
public:
    SweptEdge() = default;
    SweptEdge(std::size_t spans, double pitch) : spans_(spans), buckets_(spans), pitch_(pitch) {}

    std::span<SweptSpan> spans() noexcept { return spans_; }

    /// Prepares the look-up after the spans were set; their x must ascend. `reach`: m up to which distances must be
    /// exact.
    void arrange(double reach) noexcept {
        std::size_t begin = spans_.size(), end = 0;
        for (std::size_t n = 0; n < spans_.size(); ++n) {
            if (!spans_[n].moved) continue;
            begin = std::min(begin, n);
            end = n + 1;
        }
        if (end == 0) return;
        const double length = spans_[end - 1].b1.x - spans_[begin].a1.x;
        is_point_ = length < 1e-9;
        step_ = std::max(length / static_cast<double>(end - begin), 0.25 * pitch_);
        per_step_ = 1.0 / step_;
        first_ = spans_[begin].a1.x - step_ * static_cast<double>(begin);
        for (SweptSpan& span : spans_) {
            if (!span.moved) continue;
            bound(span.a0, span.b0);
            bound(span.a1, span.b1);
        }
        for (std::size_t b = 0; b < buckets_.size(); ++b) arrange(b, reach);
    }

    /// The edge is a point, as the ball of a burr: it has no order along x, and reaches to both sides of it.
    bool is_point() const noexcept { return is_point_; }

    /// x at the start of span n, m, for spans of equal length.
    double begin_of(std::size_t n) const noexcept { return first_ + step_ * static_cast<double>(n); }

    /// Squared distance of a point in the spans' frame to the sheet, m², if it is less than `limit`, else `limit`.
    double squared_distance(const Vec3& p, double limit) const noexcept {
        const Bucket& bucket = buckets_[bucket_of(p.x)];
        const double y = std::max(std::max(bucket.low_y - p.y, p.y - bucket.high_y), 0.0);
        const double z = std::max(std::max(bucket.low_z - p.z, p.z - bucket.high_z), 0.0);
        if (y * y + z * z >= limit) return limit;
        for (std::size_t n = bucket.begin; n < bucket.end; ++n) {
            if (spans_[n].moved) limit = std::min(limit, squared(spans_[n], p, bucket.level));
        }
        return limit;
    }

private:
    static constexpr double infinite = HUGE_VAL;

    struct Bucket {
        std::size_t begin = 0, end = 0;
        double low_y = 0, high_y = 0, low_z = 0, high_z = 0;
        bool level = true;  ///< the edge is parallel to x, so that one projection finds the closest point
    };

    std::size_t bucket_of(double x) const noexcept {
        const double at = (x - first_) * per_step_;
        return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(buckets_.size()) - 1.0));
    }

    void bound(Vec3& a, Vec3& b) const noexcept {
        const auto rise = [this](double step) { return std::clamp(2.0 * pitch_ - step, 0.0, std::min(step, pitch_)); };
        if (b.y > a.y) b.y = a.y + rise(b.y - a.y);
        else a.y = b.y + rise(a.y - b.y);
    }

    static double slope(const SweptSpan& s) noexcept {
        const auto of = [](const Vec3& a, const Vec3& b) {
            return std::hypot(b.y - a.y, b.z - a.z) / std::max(std::abs(b.x - a.x), 1e-6);
        };
        return std::max(of(s.a0, s.b0), of(s.a1, s.b1));
    }

    void arrange(std::size_t b, double reach) noexcept {
        Bucket& bucket = buckets_[b];
        double steep = 0.0;
        for (std::size_t n = b > 0 ? b - 1 : 0; n < std::min(b + 2, spans_.size()); ++n) {
            if (spans_[n].moved) steep = std::max(steep, slope(spans_[n]));
        }
        bucket.level = steep < 0.1;  // off by at most 0.5 % of the distance
        // The closest point of a sloping edge is offset by the sine of its slope.
        const double margin = bucket.level ? -1e-9 : 1.2 * reach * steep / std::sqrt(1.0 + steep * steep);
        const double low = b == 0 || is_point_ ? -infinite : begin_of(b) - margin;
        const double high = b + 1 == buckets_.size() || is_point_ ? infinite : begin_of(b + 1) + margin;
        bucket.begin = bucket.end = 0;
        bucket.low_y = bucket.low_z = infinite;
        bucket.high_y = bucket.high_z = -infinite;
        for (std::size_t n = 0; n < spans_.size(); ++n) {
            const SweptSpan& s = spans_[n];
            if (!s.moved) continue;
            const auto [left, right] = std::minmax({s.a0.x, s.a1.x, s.b0.x, s.b1.x});
            if (right < low || left > high) continue;
            if (bucket.end == 0) bucket.begin = n;
            bucket.end = n + 1;
            const auto [low_y, high_y] = std::minmax({s.a0.y, s.a1.y, s.b0.y, s.b1.y});
            const auto [low_z, high_z] = std::minmax({s.a0.z, s.a1.z, s.b0.z, s.b1.z});
            bucket.low_y = std::min(bucket.low_y, low_y);
            bucket.high_y = std::max(bucket.high_y, high_y);
            bucket.low_z = std::min(bucket.low_z, low_z);
            bucket.high_z = std::max(bucket.high_z, high_z);
        }
    }

    static double nearest_on(const Vec3& from, const Vec3& displacement, const Vec3& p) noexcept {
        const double squared_length = glm::dot(displacement, displacement);
        return squared_length > 1e-18 ? std::clamp(glm::dot(p - from, displacement) / squared_length, 0.0, 1.0) : 1.0;
    }

    /// Alternating projection onto the two directions of the sheet; each projection reduces the distance or keeps it.
    static double squared(const SweptSpan& s, const Vec3& p, bool level) noexcept {
        const Vec3 along0 = s.b0 - s.a0, along1 = s.b1 - s.a1, forth = s.a1 - s.a0, twist = along1 - along0;
        double u = std::abs(along1.x) > 1e-9 ? std::clamp((p.x - s.a1.x) / along1.x, 0.0, 1.0) : 0.5;
        double t = nearest_on(s.a0 + along0 * u, forth + twist * u, p);
        if (!level) {
            u = nearest_on(s.a0 + forth * t, along0 + twist * t, p);
            t = nearest_on(s.a0 + along0 * u, forth + twist * u, p);
        }
        const Vec3 off = s.a0 + along0 * u + (forth + twist * u) * t - p;
        return glm::dot(off, off);
    }

    std::vector<SweptSpan> spans_;
    std::vector<Bucket> buckets_;
    double pitch_ = 0.0;
    double first_ = 0.0, step_ = 1.0, per_step_ = 1.0;
    bool is_point_ = false;
};

}  // namespace tactus::carve
