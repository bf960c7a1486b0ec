// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/label_map.hpp"

#include "dsp/volume/outer_shell.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tactus::segmentation {

namespace {

struct Strides {
    std::size_t x = 1, y, z;

    explicit Strides(const std::array<int, 3>& size)
        : y(static_cast<std::size_t>(size[0])), z(y * static_cast<std::size_t>(size[1])) {}
};

/// Calls visit(voxel) for the neighbours of a voxel across faces.
template <class Visit>
void across_faces(const std::array<int, 3>& size, std::size_t v, const Visit& visit) {
    const Strides stride(size);
    const std::array<std::size_t, 3> step{stride.x, stride.y, stride.z};
    const std::array<std::size_t, 3> at{v % stride.y, v / stride.y % static_cast<std::size_t>(size[1]), v / stride.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (at[axis] > 0) visit(v - step[axis]);
        if (at[axis] + 1 < static_cast<std::size_t>(size[axis])) visit(v + step[axis]);
    }
}

struct Box {
    std::array<int, 3> low{0, 0, 0}, high{-1, -1, -1};  // inclusive
};

Box box_of(const LabelMap& map, std::uint8_t label) {
    Box box{map.size, {-1, -1, -1}};
    std::size_t v = 0;
    for (int k = 0; k < map.size[2]; ++k)
        for (int j = 0; j < map.size[1]; ++j)
            for (int i = 0; i < map.size[0]; ++i, ++v) {
                if (map.label[v] != label) continue;
                const std::array<int, 3> at{i, j, k};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    box.low[axis] = std::min(box.low[axis], at[axis]);
                    box.high[axis] = std::max(box.high[axis], at[axis]);
                }
            }
    return box;
}

}  // namespace

std::size_t spread(LabelMap& map, std::span<const std::uint8_t> open) {
    // Labels as given come first; those taken follow, nearer ones before farther ones.
    std::vector<std::size_t> queue;
    for (std::size_t v = 0; v < map.label.size(); ++v)
        if (map.label[v] != 0) queue.push_back(v);
    const std::size_t given = queue.size();
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const std::size_t from = queue[head];
        across_faces(map.size, from, [&](std::size_t v) {
            if (open[v] == 0 || map.label[v] != 0) return;
            map.label[v] = map.label[from];
            queue.push_back(v);
        });
    }
    return queue.size() - given;
}

std::vector<std::uint8_t> marrow_of(const LabelMap& map, const Vec3& spacing, double radius) {
    std::vector<std::uint8_t> marrow(map.label.size(), 0);
    const std::uint8_t last =
        map.label.empty() ? std::uint8_t{0} : *std::max_element(map.label.begin(), map.label.end());
    for (int label = 1; label <= last; ++label) {
        const Box box = box_of(map, static_cast<std::uint8_t>(label));
        if (box.high[0] < 0) continue;
        // A margin around the label, beyond the volume, too: there is air.
        std::array<int, 3> margin{};
        volume::Grid distance;
        distance.spacing = spacing;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            margin[axis] = static_cast<int>(std::ceil(radius / spacing[static_cast<int>(axis)])) + 2;
            distance.size[axis] = box.high[axis] - box.low[axis] + 1 + 2 * margin[axis];
        }
        const auto voxel = [&](int i, int j, int k) -> std::ptrdiff_t {
            const std::array<int, 3> at{i + box.low[0] - margin[0], j + box.low[1] - margin[1],
                                        k + box.low[2] - margin[2]};
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (at[axis] < 0 || at[axis] >= map.size[axis]) return -1;
            return (static_cast<std::ptrdiff_t>(at[2]) * map.size[1] + at[1]) * map.size[0] + at[0];
        };
        const auto each = [&](const auto& visit) {
            std::size_t n = 0;
            for (int k = 0; k < distance.size[2]; ++k)
                for (int j = 0; j < distance.size[1]; ++j)
                    for (int i = 0; i < distance.size[0]; ++i, ++n) visit(n, voxel(i, j, k));
        };
        const auto unit = static_cast<float>(std::min({spacing.x, spacing.y, spacing.z}));
        distance.values.assign(distance.count(), unit);
        each([&](std::size_t n, std::ptrdiff_t v) {
            if (v >= 0 && map.label[static_cast<std::size_t>(v)] == label) distance.values[n] = -unit;
        });
        const volume::Grid shell = volume::outer_shell(distance, radius);
        each([&](std::size_t n, std::ptrdiff_t v) {
            if (v >= 0 && shell.values[n] < 0.0f && map.label[static_cast<std::size_t>(v)] == 0)
                marrow[static_cast<std::size_t>(v)] = 1;
        });
    }
    return marrow;
}

std::vector<TouchingLabels> touching_labels(const LabelMap& map, const Vec3& spacing) {
    std::map<std::pair<std::uint8_t, std::uint8_t>, TouchingLabels> found;
    const Strides stride(map.size);
    const std::array<std::size_t, 3> step{stride.x, stride.y, stride.z};
    const std::array<double, 3> area{spacing.y * spacing.z, spacing.x * spacing.z, spacing.x * spacing.y};
    std::size_t v = 0;
    for (int k = 0; k < map.size[2]; ++k)
        for (int j = 0; j < map.size[1]; ++j)
            for (int i = 0; i < map.size[0]; ++i, ++v) {
                if (map.label[v] == 0) continue;
                const std::array<int, 3> at{i, j, k};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    if (at[axis] + 1 >= map.size[axis]) continue;
                    const auto [a, b] = std::minmax(map.label[v], map.label[v + step[axis]]);
                    if (a == 0 || a == b) continue;
                    TouchingLabels& touching = found[{a, b}];
                    touching.a = a, touching.b = b;
                    ++touching.faces;
                    touching.area += area[axis];
                }
            }
    std::vector<TouchingLabels> list;
    for (const auto& [pair, touching] : found) list.push_back(touching);
    return list;
}

}  // namespace tactus::segmentation
