// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/nearest_points.hpp"

#include "dsp/core/large_pages.hpp"

#include <algorithm>
#include <limits>

namespace tactus::geometry {

namespace {

constexpr int tile = 16;  // columns that are processed together

struct Pass {
    const volume::Grid& layout;
    std::span<const glm::vec3> points;
    std::vector<std::int32_t>& nearest;
    int axis;
    int first_layer;

    // Offset of the samples along an axis.
    int start(int other) const { return other == 2 ? first_layer : 0; }

    // Offset of columns along an axis that has not been processed yet: the centres of the cells that hold the points.
    double place(int other, int index) const {
        return other > axis ? start(other) + index + 0.5 : start(other) + index;
    }

    struct Envelope {
        std::vector<std::int32_t> in, out, point;
        std::vector<double> apex, height, from;

        explicit Envelope(std::size_t length)
            : in(length * tile), out(length * tile), point(length), apex(length), height(length), from(length) {}
    };

    // For n < length, replaces in[n * tile] (point of cell n) by out[n * tile] (nearest point of sample n).
    void column(Envelope& e, int lane, int length, const glm::dvec3& at, int first, int second) const {
        const double h = layout.spacing[axis], h1 = layout.spacing[first], h2 = layout.spacing[second];
        int count = 0;
        std::int32_t last = -1;
        for (int n = 0; n < length; ++n) {
            const std::int32_t id = e.in[static_cast<std::size_t>(n * tile + lane)];
            if (id < 0 || id == last) continue;
            last = id;
            const glm::vec3& p = points[static_cast<std::size_t>(id)];
            const double cell = n + start(axis), a = h * std::clamp(double(p[axis]), cell, cell + 1.0);
            const double d1 = h1 * (double(p[first]) - at[first]), d2 = h2 * (double(p[second]) - at[second]);
            const double c = d1 * d1 + d2 * d2;
            double from = -std::numeric_limits<double>::infinity();
            while (count > 0) {
                const auto top = static_cast<std::size_t>(count - 1);
                if (a > e.apex[top]) {
                    from = 0.5 * (a + e.apex[top] + (c - e.height[top]) / (a - e.apex[top]));
                    if (from > e.from[top]) break;
                } else if (c >= e.height[top]) {
                    from = std::numeric_limits<double>::infinity();
                    break;
                }
                --count;
                from = -std::numeric_limits<double>::infinity();
            }
            if (from == std::numeric_limits<double>::infinity()) continue;
            const auto slot = static_cast<std::size_t>(count++);
            e.point[slot] = id, e.apex[slot] = a, e.height[slot] = c, e.from[slot] = from;
        }
        int at_parabola = 0;
        for (int n = 0; n < length; ++n) {
            while (at_parabola + 1 < count &&
                   e.from[static_cast<std::size_t>(at_parabola + 1)] <= (n + start(axis)) * h)
                ++at_parabola;
            e.out[static_cast<std::size_t>(n * tile + lane)] =
                count > 0 ? e.point[static_cast<std::size_t>(at_parabola)] : -1;
        }
    }

    // All columns of the slab at this index of the outer axis.
    void slab(int outer_index) const {
        const int outer = axis == 2 ? 1 : 2, inner = axis == 0 ? 1 : 0;
        const int length = layout.size[static_cast<std::size_t>(axis)];
        const int columns = layout.size[static_cast<std::size_t>(inner)];
        std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(layout.size[0]), layout.index(0, 0, 1)};
        const std::size_t along = stride[static_cast<std::size_t>(axis)],
                          aside = stride[static_cast<std::size_t>(inner)];
        Envelope e(static_cast<std::size_t>(length));
        glm::dvec3 at(0.0);
        at[outer] = place(outer, outer_index);
        for (int begin = 0; begin < columns; begin += tile) {
            const int lanes = std::min(tile, columns - begin);
            std::int32_t* base =
                &nearest[static_cast<std::size_t>(outer_index) * stride[static_cast<std::size_t>(outer)] +
                         static_cast<std::size_t>(begin) * aside];
            const auto each = [&](auto visit) {
                for (int n = 0; n < length; ++n)
                    for (int lane = 0; lane < lanes; ++lane)
                        visit(base[static_cast<std::size_t>(n) * along + static_cast<std::size_t>(lane) * aside],
                              static_cast<std::size_t>(n * tile + lane));
            };
            each([&e](std::int32_t value, std::size_t slot) { e.in[slot] = value; });
            for (int lane = 0; lane < lanes; ++lane) {
                at[inner] = place(inner, begin + lane);
                column(e, lane, length, at, inner, outer);
            }
            each([&e](std::int32_t& value, std::size_t slot) { value = e.out[slot]; });
        }
    }
};

}  // namespace

std::vector<std::int32_t> nearest_points(const volume::Grid& layout, std::span<const glm::vec3> points,
                                         const RunJobs& run, int first) {
    std::vector<std::int32_t> nearest = large_vector(layout.count(), std::int32_t{-1});
    for (std::size_t n = 0; n < points.size(); ++n) {
        std::array<int, 3> cell{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const int start = axis == 2 ? first : 0;
            cell[a] = std::clamp(static_cast<int>(points[n][axis]) - start, 0, std::max(layout.size[a] - 2, 0));
        }
        std::int32_t& slot = nearest[layout.index(cell[0], cell[1], cell[2])];
        if (slot < 0) slot = static_cast<std::int32_t>(n);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const Pass pass{layout, points, nearest, axis, first};
        run(layout.size[axis == 2 ? 1 : 2], [&pass](int outer_index) { pass.slab(outer_index); });
    }
    return nearest;
}

}  // namespace tactus::geometry
