// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/median.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"
#include "dsp/training/removed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tactus::training {

namespace {

constexpr std::size_t min_points = 20, max_columns = 400;
constexpr double widest = 20e-3;  // m across the cut that is looked at, to each side

/// The removed volume as samples, and its main axes.
struct Removed {
    std::vector<Vec3> points;
    Vec3 middle{0.0};
    geometry::SymmetricEigen<3> spread;
};

Removed removed_of(const CutBone& bone) {
    Removed removed;
    const volume::Grid& grid = bone.before;
    std::size_t n = 0;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i, ++n)
                if (grid.values[n] < 0.0f && bone.after.values[n] > 0.0f)
                    removed.points.push_back(grid.position(i, j, k));
    if (removed.points.empty()) return removed;
    const double share = 1.0 / static_cast<double>(removed.points.size());
    for (const Vec3& p : removed.points) removed.middle += share * p;
    std::array<double, 9> m{};
    for (const Vec3& p : removed.points) {
        const Vec3 d = p - removed.middle;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) m[static_cast<std::size_t>(3 * r + c)] += share * d[r] * d[c];
    }
    removed.spread = geometry::symmetric_eigen<3>(m);
    return removed;
}

/// Axes in which the cut is measured: two within its plane and one across.
struct Frame {
    Vec3 point, u, v, normal;

    Frame(const Vec3& point_, const Vec3& normal_, const PlannedCut& cut) : point(point_), normal(normal_) {
        u = cut.stroke - glm::dot(cut.stroke, normal) * normal;
        if (!(glm::length(u) > 0.1)) u = cut.feed - glm::dot(cut.feed, normal) * normal;
        u = glm::normalize(u);
        v = glm::cross(normal, u);
    }
};

/// The two walls of the kerf along the normal at one place, or nothing where one of them is the bone's own surface.
std::optional<CutPoint> walls_at(const CutBone& bone, const Frame& frame, double u, double v, double reach, double h) {
    const double step = 0.25 * h;
    const Vec3 start = frame.point + u * frame.u + v * frame.v;
    const auto at = [&](double t) { return start + t * frame.normal; };
    // A wall counts when the bone was there before: this deep below its old surface.
    const double margin = 0.5 * h;
    std::optional<CutPoint> best;
    double begin = 0.0, last = bone.after_at(at(-reach));
    bool is_open = false;
    for (double t = -reach + step; t <= reach; t += step) {
        const double now = bone.after_at(at(t));
        const double wall = t - step + (now == last ? 0.0 : step * last / (last - now));
        if (last <= 0.0 && now > 0.0) {
            begin = wall;
            is_open = bone.before_at(at(wall)) < -margin;
        } else if (last > 0.0 && now <= 0.0) {
            const bool is_wall = is_open && bone.before_at(at(wall)) < -margin;
            // Bone all the way between the walls: not two cuts from both sides of a hollow.
            if (is_wall && bone.before_at(at(0.5 * (begin + wall))) < 0.0 && (!best || wall - begin > best->width))
                best = CutPoint{at(0.5 * (begin + wall)), 0.0, wall - begin};
            is_open = false;
        }
        last = now;
    }
    return best;
}

std::vector<CutPoint> middle_surface(const CutBone& bone, const Frame& frame, const std::vector<Vec3>& removed,
                                     double reach, double h) {
    double low_u = 1e9, high_u = -1e9, low_v = 1e9, high_v = -1e9;
    for (const Vec3& p : removed) {
        const double u = glm::dot(p - frame.point, frame.u), v = glm::dot(p - frame.point, frame.v);
        low_u = std::min(low_u, u);
        high_u = std::max(high_u, u);
        low_v = std::min(low_v, v);
        high_v = std::max(high_v, v);
    }
    const double pitch = std::max({h, (high_u - low_u) / max_columns, (high_v - low_v) / max_columns});
    std::vector<CutPoint> points;
    for (double u = low_u; u <= high_u; u += pitch)
        for (double v = low_v; v <= high_v; v += pitch)
            if (const auto point = walls_at(bone, frame, u, v, reach, h)) points.push_back(*point);
    return points;
}

/// Least squares of t over (1, u, v) with weights; false when the points do not span a plane.
bool weighted_plane(const std::vector<Vec3>& uvt, const std::vector<double>& weights, Vec3& coefficients) {
    double sum = 0.0;
    Vec3 mean(0.0);
    for (std::size_t n = 0; n < uvt.size(); ++n) {
        sum += weights[n];
        mean += weights[n] * uvt[n];
    }
    if (!(sum > 0.0)) return false;
    mean /= sum;
    double uu = 0.0, uv = 0.0, vv = 0.0, ut = 0.0, vt = 0.0;
    for (std::size_t n = 0; n < uvt.size(); ++n) {
        const Vec3 d = uvt[n] - mean;
        uu += weights[n] * d.x * d.x;
        uv += weights[n] * d.x * d.y;
        vv += weights[n] * d.y * d.y;
        ut += weights[n] * d.x * d.z;
        vt += weights[n] * d.y * d.z;
    }
    const double det = uu * vv - uv * uv;
    if (!(det > 1e-9 * uu * vv)) return false;
    coefficients.y = (ut * vv - vt * uv) / det;
    coefficients.z = (vt * uu - ut * uv) / det;
    coefficients.x = mean.z - coefficients.y * mean.x - coefficients.z * mean.y;
    return true;
}

/// Moves the frame into the robust plane of the points.
bool settle(Frame& frame, const std::vector<CutPoint>& points, const PlannedCut& cut, double h) {
    constexpr double tukey = 4.685, to_deviation = 1.4826;
    std::vector<Vec3> uvt;
    for (const CutPoint& p : points) {
        const Vec3 d = p.position - frame.point;
        uvt.emplace_back(glm::dot(d, frame.u), glm::dot(d, frame.v), glm::dot(d, frame.normal));
    }
    std::vector<double> weights(uvt.size(), 1.0), residuals(uvt.size());
    Vec3 c(0.0);
    for (int round = 0; round < 20; ++round) {
        if (!weighted_plane(uvt, weights, c)) return false;
        for (std::size_t n = 0; n < uvt.size(); ++n)
            residuals[n] = std::abs(uvt[n].z - c.x - c.y * uvt[n].x - c.z * uvt[n].y);
        const double scale = std::max(to_deviation * median(residuals), 0.01 * h);
        for (std::size_t n = 0; n < uvt.size(); ++n) {
            const double r = residuals[n] / (tukey * scale);
            weights[n] = r < 1.0 ? (1.0 - r * r) * (1.0 - r * r) : 0.0;
        }
    }
    Vec3 normal = glm::normalize(frame.normal - c.y * frame.u - c.z * frame.v);
    if (glm::dot(normal, cut.normal) < 0.0) normal = -normal;
    frame = Frame(frame.point + c.x * frame.normal, normal, cut);
    return true;
}

}  // namespace

std::optional<CutPlane> fit_cut_plane(const CutBone& bone, const PlannedCut& cut, double kerf) {
    const Removed removed = removed_of(bone);
    if (removed.points.size() < min_points) return std::nullopt;
    const double h = bone.smallest_spacing();
    const auto& axis = removed.spread.vector[0];
    Vec3 normal(axis[0], axis[1], axis[2]);
    if (glm::dot(normal, cut.normal) < 0.0) normal = -normal;
    // A hole that is as wide as long has no plane of its own; the search then starts from the plan.
    if (glm::dot(normal, cut.normal) < 0.7) normal = cut.normal;
    Frame frame(removed.middle, normal, cut);
    const double reach =
        std::min(widest, 2.0 * kerf + 4.0 * std::sqrt(std::max(0.0, removed.spread.value[0])) + 2.0 * h);
    CutPlane plane;
    for (int round = 0; round < 3; ++round) {
        plane.points = middle_surface(bone, frame, removed.points, reach, h);
        if (plane.points.size() < min_points) return std::nullopt;
        if (!settle(frame, plane.points, cut, h)) break;
    }
    plane.point = frame.point;
    plane.normal = frame.normal;
    double sum = 0.0;
    Vec3 mean(0.0);
    for (CutPoint& p : plane.points) {
        p.offset = cut.coordinates(p.position).z;
        sum += p.offset * p.offset;
        plane.max = std::max(plane.max, std::abs(p.offset));
        mean += p.position / static_cast<double>(plane.points.size());
    }
    plane.rms = std::sqrt(sum / static_cast<double>(plane.points.size()));
    // The narrower extent of the middle surface, as a standard deviation: a groove no deeper than the kerf is wide
    // does not determine an angle.
    double uu = 0.0, uv = 0.0, vv = 0.0;
    for (const CutPoint& p : plane.points) {
        const double u = glm::dot(p.position - mean, frame.u), v = glm::dot(p.position - mean, frame.v);
        uu += u * u;
        uv += u * v;
        vv += v * v;
    }
    const auto count = static_cast<double>(plane.points.size());
    const double half = 0.5 * (uu + vv), apart = std::hypot(0.5 * (uu - vv), uv);
    if (std::sqrt(std::max(0.0, half - apart) / count) > 0.5 * kerf)
        plane.angle = angle_between_planes(plane.normal, cut.normal);
    return plane;
}

}  // namespace tactus::training
