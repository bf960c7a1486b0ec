// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/vessel_ray.hpp"

#include "dsp/vessel/scan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus::window {

namespace {

constexpr double contrast_hu = 150.0, soft_hu = 40.0, cortex_hu = 700.0;

/// Where the ray is inside of a grid, m from its start.
struct Span {
    double enter = 0.0, leave = 0.0;
};
std::optional<Span> span_in(const volume::Grid& grid, const Vec3& from, const Vec3& direction) {
    const Vec3 high = grid.position(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
    Span span{0.0, 1e9};
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-12) {
            if (from[axis] < grid.origin[axis] || from[axis] > high[axis]) return std::nullopt;
            continue;
        }
        const double a = (grid.origin[axis] - from[axis]) / direction[axis];
        const double b = (high[axis] - from[axis]) / direction[axis];
        span.enter = std::max(span.enter, std::min(a, b));
        span.leave = std::min(span.leave, std::max(a, b));
    }
    if (span.enter > span.leave) return std::nullopt;
    return span;
}

/// Of scanner numbers: what three quarters of the samples below the threshold are below.
double soft_tissue(const analysis::ScanGraph& scan) {
    if (scan.hu == volume::HuKind::calibrated) return soft_hu;
    std::vector<float> values;
    const std::size_t step = std::max<std::size_t>(1, scan.scan.count() / 100'000);
    for (std::size_t n = 0; n < scan.scan.count(); n += step)
        if (double(scan.scan.values[n]) < scan.threshold) values.push_back(scan.scan.values[n]);
    if (values.empty()) return scan.threshold;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(3 * values.size() / 4);
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
}

}  // namespace

RayMeets first_on_ray(const analysis::ScanGraph& scan, const Vec3& from, const Vec3& direction) {
    const volume::Grid& grid = scan.scan;
    const auto span = span_in(grid, from, direction);
    if (!span) return {};
    const bool is_hu = scan.hu == volume::HuKind::calibrated;
    const double half_way = 0.5 * (soft_tissue(scan) + scan.threshold);
    const double bright = is_hu ? std::min(contrast_hu, half_way) : half_way;
    const double cortex = is_hu ? std::max(cortex_hu, scan.threshold) : scan.threshold;
    const vessel::Scan values(grid);
    const Vec3& h = grid.spacing;
    const auto mean = [&](const Vec3& p) {
        double sum = values.any_value(p);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 off(0.0);
            off[axis] = h[axis];
            sum += values.any_value(p + off) + values.any_value(p - off);
        }
        return sum / 7.0;
    };
    const double voxel = std::min({h.x, h.y, h.z}), step = 0.5 * voxel;
    double begin = -1.0, brightest = 0.0;
    for (double t = span->enter;; t += step) {
        const bool is_end = t > span->leave;
        const double value = is_end ? 0.0 : mean(from + t * direction);
        if (!is_end && value >= bright) {
            if (begin < 0.0) begin = t, brightest = value;
            // A single sample of cortex is enough: its mean with the tissue beside it is less.
            brightest = std::max({brightest, value, values.any_value(from + t * direction)});
            if (brightest >= cortex) return {RayMeets::What::bone, from + t * direction, true};
            continue;
        }
        if (begin >= 0.0 && t - begin >= 2.0 * voxel) {
            constexpr double widest = 40e-3, deepest = 6e-3;  // of a vessel; into it
            if (t - begin > widest) return {RayMeets::What::bone, from + begin * direction, true};
            const double middle = begin + std::min(0.5 * (t - step - begin), deepest);
            return {RayMeets::What::vessel, from + middle * direction, brightest >= scan.threshold};
        }
        begin = -1.0;
        if (is_end) return {};
    }
}

}  // namespace tactus::window
