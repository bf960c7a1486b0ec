// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/surface_distance.hpp"

#include "dsp/distance/closest_point.hpp"

#include <cmath>
#include <limits>

namespace tactus {

namespace {

struct Box {
    std::array<int, 3> low, high;  // inclusive sample indices; empty when low > high
};

Box samples_near(const Grid& layout, const std::array<Vec3, 3>& corner, double margin) {
    Box box{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double low = std::min({corner[0][axis], corner[1][axis], corner[2][axis]}) - layout.origin[axis];
        const double high = std::max({corner[0][axis], corner[1][axis], corner[2][axis]}) - layout.origin[axis];
        const double last = layout.size[a] - 1;
        box.low[a] = static_cast<int>(std::clamp(std::ceil(low / layout.spacing[axis] - margin), 0.0, last + 1.0));
        box.high[a] = static_cast<int>(std::clamp(std::floor(high / layout.spacing[axis] + margin), -1.0, last));
    }
    return box;
}

struct Sweeper {
    const Grid& layout;
    const TriangleSurface& surface;
    NearestTriangles& nearest;
    std::vector<glm::vec3> foot;   // nearest point per sample, m from the layout's origin
    std::vector<float> radius;     // of a circle around each triangle, m
    float cell;                    // largest spacing, m

    std::array<Vec3, 3> corners(std::int32_t triangle) const {
        const auto& t = surface.triangles[static_cast<std::size_t>(triangle)];
        return {surface.vertices[static_cast<std::size_t>(t[0])], surface.vertices[static_cast<std::size_t>(t[1])],
                surface.vertices[static_cast<std::size_t>(t[2])]};
    }

    void offer(std::size_t sample, const Vec3& at, std::int32_t triangle) {
        const auto [a, b, c] = corners(triangle);
        const Vec3 closest = closest_on_triangle(at, a, b, c);
        const auto distance = static_cast<float>(glm::length(closest - at));
        if (distance < nearest.distance[sample]) {
            nearest.distance[sample] = distance;
            foot[sample] = glm::vec3(closest - layout.origin);
            nearest.triangle[sample] = triangle;
        }
    }

    void seed() {
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            const auto triangle = static_cast<std::int32_t>(t);
            const Box box = samples_near(layout, corners(triangle), 1.5);
            for (int k = box.low[2]; k <= box.high[2]; ++k)
                for (int j = box.low[1]; j <= box.high[1]; ++j)
                    for (int i = box.low[0]; i <= box.high[0]; ++i)
                        offer(layout.index(i, j, k), layout.position(i, j, k), triangle);
        }
    }

    // One Gauss-Seidel pass; each sample asks the seven neighbours that this pass has already visited.
    void sweep(int dx, int dy, int dz) {
        std::array<float, 8> reach{};
        for (int bits = 1; bits < 8; ++bits)
            reach[static_cast<std::size_t>(bits)] = static_cast<float>(
                glm::length(layout.spacing * Vec3(bits & 1, bits >> 1 & 1, bits >> 2)) * (1.0 + 1e-6));
        const auto& size = layout.size;
        for (int kk = 0; kk < size[2]; ++kk)
            for (int jj = 0; jj < size[1]; ++jj)
                for (int ii = 0; ii < size[0]; ++ii) {
                    const int i = dx > 0 ? ii : size[0] - 1 - ii, j = dy > 0 ? jj : size[1] - 1 - jj;
                    const int k = dz > 0 ? kk : size[2] - 1 - kk;
                    const std::size_t sample = layout.index(i, j, k);
                    for (int bits = 1; bits < 8; ++bits) {
                        const int x = bits & 1, y = bits >> 1 & 1, z = bits >> 2;
                        if (x > ii || y > jj || z > kk) continue;
                        const std::size_t other = layout.index(i - x * dx, j - y * dy, k - z * dz);
                        const std::int32_t triangle = nearest.triangle[other];
                        // A triangle nearest to the neighbour is at most one step nearer to this sample.
                        if (triangle < 0 || triangle == nearest.triangle[sample] ||
                            nearest.distance[other] - reach[static_cast<std::size_t>(bits)] >= nearest.distance[sample])
                            continue;
                        // Far away a small triangle is as good as its point: they differ by radius² / 2 distance.
                        const float own = nearest.distance[sample];
                        if (own < 1e30f && own > 4.0f * cell &&
                            radius[static_cast<std::size_t>(triangle)] < 2.0f * cell) {
                            const glm::vec3 here(layout.position(i, j, k) - layout.origin);
                            const glm::vec3 apart = foot[other] - here;
                            if (glm::dot(apart, apart) >= own * own) continue;
                        }
                        offer(sample, layout.position(i, j, k), triangle);
                    }
                }
    }
};

// Which side of the projected edge a → b the origin is on: ±1, and exactly opposite for b → a. The origin is thought
// of as shifted by (ε², ε) where it would be on the edge; 0 only when the two ends coincide.
int side(double ay, double az, double by, double bz) {
    const double area = ay * bz - az * by;
    if (area != 0.0) return area > 0.0 ? 1 : -1;
    if (ay != by) return ay < by ? -1 : 1;
    if (az != bz) return az < bz ? 1 : -1;
    return 0;
}

}  // namespace

NearestTriangles nearest_triangles(const Grid& layout, const TriangleSurface& surface) {
    NearestTriangles nearest{std::vector<std::int32_t>(layout.count(), -1),
                             std::vector<float>(layout.count(), std::numeric_limits<float>::infinity())};
    if (surface.triangles.empty()) return nearest;
    Sweeper sweeper{layout,  surface,
                    nearest, std::vector<glm::vec3>(layout.count()),
                    {},      static_cast<float>(std::max({layout.spacing.x, layout.spacing.y, layout.spacing.z}))};
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto [a, b, c] = sweeper.corners(static_cast<std::int32_t>(t));
        const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
        sweeper.radius.push_back(static_cast<float>(longest / std::sqrt(3.0)));
    }
    sweeper.seed();
    for (int direction = 0; direction < 4; ++direction) {
        const int dx = direction & 1 ? -1 : 1, dy = direction & 2 ? -1 : 1;
        sweeper.sweep(dx, dy, 1);
        sweeper.sweep(-dx, -dy, -1);
    }
    return nearest;
}

std::vector<std::int16_t> winding_numbers(const Grid& layout, const TriangleSurface& surface) {
    std::vector<std::int16_t> crossings(layout.count(), 0);
    for (const auto& t : surface.triangles) {
        std::array<Vec3, 3> corner{};
        for (std::size_t c = 0; c < 3; ++c) corner[c] = surface.vertices[static_cast<std::size_t>(t[c])];
        const Box box = samples_near(layout, corner, 0.5);
        for (int k = box.low[2]; k <= box.high[2]; ++k)
            for (int j = box.low[1]; j <= box.high[1]; ++j) {
                const Vec3 ray = layout.position(0, j, k);
                std::array<double, 3> y{}, z{};
                for (std::size_t c = 0; c < 3; ++c) y[c] = corner[c].y - ray.y, z[c] = corner[c].z - ray.z;
                const int s0 = side(y[1], z[1], y[2], z[2]), s1 = side(y[2], z[2], y[0], z[0]);
                const int s2 = side(y[0], z[0], y[1], z[1]);
                if (s0 == 0 || s0 != s1 || s1 != s2) continue;
                const double w0 = y[1] * z[2] - z[1] * y[2], w1 = y[2] * z[0] - z[2] * y[0];
                const double w2 = y[0] * z[1] - z[0] * y[1], sum = w0 + w1 + w2;
                if (sum == 0.0) continue;
                const double x = (w0 * corner[0].x + w1 * corner[1].x + w2 * corner[2].x) / sum;
                const double first = std::ceil((x - layout.origin.x) / layout.spacing.x);
                if (first >= layout.size[0]) continue;
                // Entering through a triangle that looks towards -x (negative area in y, z) counts up.
                crossings[layout.index(first < 0.0 ? 0 : static_cast<int>(first), j, k)] +=
                    static_cast<std::int16_t>(-s0);
            }
    }
    for (int k = 0; k < layout.size[2]; ++k)
        for (int j = 0; j < layout.size[1]; ++j)
            for (int i = 1; i < layout.size[0]; ++i)
                crossings[layout.index(i, j, k)] =
                    static_cast<std::int16_t>(crossings[layout.index(i, j, k)] + crossings[layout.index(i - 1, j, k)]);
    return crossings;
}

Grid signed_distance(const Grid& layout, const TriangleSurface& surface) {
    Grid grid{layout.size, layout.origin, layout.spacing, nearest_triangles(layout, surface).distance};
    const auto winding = winding_numbers(layout, surface);
    for (std::size_t n = 0; n < winding.size(); ++n)
        if (winding[n] != 0) grid.values[n] = -grid.values[n];
    return grid;
}

}  // namespace tactus
