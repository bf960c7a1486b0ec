// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/surface_cells.hpp"

#include "dsp/geometry/closest_point.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tactus::volume {

namespace {

struct Piece {
    int cell;  // in its layer
    std::int32_t triangle;
    float apart2;  // squared distance of `at` from the cell's middle
    glm::vec3 at;
};

struct Pieces {
    const Grid& layout;
    const geometry::TriangleSurface& surface;
    const TriangleLayers& near;

    // The pieces in the cells between sample layers k and k + 1.
    std::vector<Piece> layer(int k) const {
        std::vector<Piece> pieces;
        const double half_diagonal = 0.5 * glm::length(layout.spacing);
        const Vec3 to_middle = 0.5 * layout.spacing;
        for (const std::int32_t triangle : near[k]) {
            const auto corners = corners_of(surface, triangle);
            IndexBox box =
                samples_near(layout, corners, std::max({layout.spacing.x, layout.spacing.y, layout.spacing.z}));
            const Vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            const double twice_area = glm::length(across);
            const PlaneRow plane{corners[0], twice_area > 0.0 ? across / twice_area : Vec3(0.0), half_diagonal};
            for (int j = box.low[1]; j <= std::min(box.high[1], layout.size[1] - 2); ++j) {
                int first = box.low[0], last = std::min(box.high[0], layout.size[0] - 2);
                plane.narrow(layout, to_middle, j, k, first, last);
                for (int i = first; i <= last; ++i) {
                    const Vec3 middle = layout.position(i, j, k) + to_middle;
                    const Vec3 closest = geometry::closest_on_triangle(middle, corners[0], corners[1], corners[2]);
                    const Vec3 apart = glm::abs(closest - middle);
                    constexpr double rounding = 0.5 + 1e-6;
                    if (apart.x > rounding * layout.spacing.x || apart.y > rounding * layout.spacing.y ||
                        apart.z > rounding * layout.spacing.z)
                        continue;
                    const Vec3 at = glm::clamp((closest - layout.origin) / layout.spacing, Vec3(i, j, k),
                                               Vec3(i, j, k) + (1.0 - 1e-6));
                    pieces.push_back(
                        {j * layout.size[0] + i, triangle, static_cast<float>(glm::dot(apart, apart)), glm::vec3(at)});
                }
            }
        }
        std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
            return std::tuple(a.cell, a.apart2, a.triangle) < std::tuple(b.cell, b.apart2, b.triangle);
        });
        return pieces;
    }
};

}  // namespace

std::array<Vec3, 3> corners_of(const geometry::TriangleSurface& surface, std::int32_t triangle) {
    const auto& t = surface.triangles[static_cast<std::size_t>(triangle)];
    return {surface.vertices[static_cast<std::size_t>(t[0])], surface.vertices[static_cast<std::size_t>(t[1])],
            surface.vertices[static_cast<std::size_t>(t[2])]};
}

IndexBox samples_near(const Grid& layout, const std::array<Vec3, 3>& corners, double margin) {
    IndexBox box{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double low = std::min({corners[0][axis], corners[1][axis], corners[2][axis]}) - layout.origin[axis];
        const double high = std::max({corners[0][axis], corners[1][axis], corners[2][axis]}) - layout.origin[axis];
        const double last = layout.size[a] - 1;
        box.low[a] = static_cast<int>(std::clamp(std::ceil((low - margin) / layout.spacing[axis]), 0.0, last + 1.0));
        box.high[a] = static_cast<int>(std::clamp(std::floor((high + margin) / layout.spacing[axis]), -1.0, last));
    }
    return box;
}

TriangleLayers::TriangleLayers(const Grid& layout, const geometry::TriangleSurface& surface, double margin)
    : starts_(static_cast<std::size_t>(layout.size[2]) + 1, 0) {
    const auto count = static_cast<std::int32_t>(surface.triangles.size());
    std::vector<std::pair<int, int>> ranges;
    for (std::int32_t t = 0; t < count; ++t) {
        const IndexBox box = samples_near(layout, corners_of(surface, t), margin);
        ranges.push_back({box.low[2], box.high[2]});
        for (int k = ranges.back().first; k <= ranges.back().second; ++k) ++starts_[static_cast<std::size_t>(k) + 1];
    }
    for (std::size_t n = 1; n < starts_.size(); ++n) starts_[n] += starts_[n - 1];
    triangles_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::int32_t t = 0; t < count; ++t) {
        const auto [low, high] = ranges[static_cast<std::size_t>(t)];
        for (int k = low; k <= high; ++k) triangles_[next[static_cast<std::size_t>(k)]++] = t;
    }
}

void PlaneRow::narrow(const Grid& layout, const Vec3& shift, int j, int k, int& first, int& last) const {
    const double start = glm::dot(layout.position(0, j, k) + shift - corner, normal),
                 step = normal.x * layout.spacing.x;
    const double wide = reach * (1.0 + 1e-9) + 1e-12;
    if (std::abs(step) < 1e-9 * wide) {
        if (std::abs(start) > wide) last = first - 1;
        return;
    }
    const double a = (-wide - start) / step, b = (wide - start) / step;
    first = static_cast<int>(std::clamp(std::floor(std::min(a, b)), double(first), last + 1.0));
    last = static_cast<int>(std::clamp(std::ceil(std::max(a, b)), first - 1.0, double(last)));
}

SurfaceCells surface_cells(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run) {
    const TriangleLayers near(layout, surface, layout.spacing.z);
    const Pieces pieces{layout, surface, near};
    std::vector<std::vector<Piece>> layers(static_cast<std::size_t>(std::max(layout.size[2] - 1, 0)));
    run(static_cast<int>(layers.size()), [&](int k) { layers[static_cast<std::size_t>(k)] = pieces.layer(k); });
    SurfaceCells cells;
    for (auto& layer : layers) {
        for (std::size_t n = 0; n < layer.size(); ++n) {
            if (n == 0 || layer[n].cell != layer[n - 1].cell) {
                cells.at.push_back(layer[n].at);
                cells.start.push_back(cells.start.back());
            }
            cells.triangle.push_back(layer[n].triangle);
            ++cells.start.back();
        }
        layer = {};
    }
    return cells;
}

}  // namespace tactus::volume
