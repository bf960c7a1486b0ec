// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/crop_bone.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tactus::analysis {

namespace {

volume::Grid part_of_grid(const volume::Grid& grid, const std::array<int, 3>& low, const std::array<int, 3>& high) {
    volume::Grid part{{}, grid.position(low[0], low[1], low[2]), grid.spacing, {}};
    for (std::size_t a = 0; a < 3; ++a) part.size[a] = high[a] - low[a] + 1;
    part.values.reserve(part.count());
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j) {
            const float* row = &grid.values[grid.index(low[0], j, k)];
            part.values.insert(part.values.end(), row, row + part.size[0]);
        }
    return part;
}

void close_border(volume::Grid& distance) {
    const Vec3& h = distance.spacing;
    const auto outside = static_cast<float>(0.5 * std::min({h.x, h.y, h.z}));
    const auto& size = distance.size;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i)
                if (i == 0 || j == 0 || k == 0 || i == size[0] - 1 || j == size[1] - 1 || k == size[2] - 1)
                    distance.at(i, j, k) = std::max(distance.at(i, j, k), outside);
}

}  // namespace

BoneBox parse_box(const std::string& text) {
    Vec3 a(0.0), b(0.0);
    int read = 0;
    const int found = std::sscanf(text.c_str(), "%lf:%lf,%lf:%lf,%lf:%lf%n", &a.x, &b.x, &a.y, &b.y, &a.z, &b.z, &read);
    if (found != 6 || read != static_cast<int>(text.size()) || !is_finite(a) || !is_finite(b) || a.x >= b.x ||
        a.y >= b.y || a.z >= b.z)
        throw Error(fmt::format("crop box '{}' is not x0:x1,y0:y1,z0:z1 in mm with x0 < x1, y0 < y1, z0 < z1", text));
    return {a * mm, b * mm};
}

BoneBox box_of_cut(const bone::Bone& cut, const bone::Bone& original, double margin) {
    const volume::Grid &a = cut.distance, &b = original.distance;
    if (a.size != b.size || a.origin != b.origin || a.spacing != b.spacing)
        throw Error(fmt::format("'{}' is not a cut of '{}': their samples lie elsewhere", cut.name, original.name));
    BoneBox box{Vec3(1e30), Vec3(-1e30)};
    for (int k = 0; k < a.size[2]; ++k)
        for (int j = 0; j < a.size[1]; ++j)
            for (int i = 0; i < a.size[0]; ++i) {
                if ((a.at(i, j, k) < 0.0f) == (b.at(i, j, k) < 0.0f)) continue;
                box.low = glm::min(box.low, a.position(i, j, k));
                box.high = glm::max(box.high, a.position(i, j, k));
            }
    if (box.low.x > box.high.x) throw Error(fmt::format("'{}' and '{}' do not differ", cut.name, original.name));
    return {box.low - margin, box.high + margin};
}

bone::Bone part_of_bone(const bone::Bone& bone, const BoneBox& box, bool closed) {
    const volume::Grid& grid = bone.distance;
    std::array<int, 3> low{}, high{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double last = grid.size[a] - 1;
        const double from = std::ceil((box.low[axis] - grid.origin[axis]) / grid.spacing[axis] - 1e-6);
        const double to = std::floor((box.high[axis] - grid.origin[axis]) / grid.spacing[axis] + 1e-6);
        low[a] = static_cast<int>(std::clamp(from, 0.0, last));
        high[a] = static_cast<int>(std::clamp(to, 0.0, last));
        if (from > last || to < 0.0 || high[a] - low[a] < 2)
            throw Error(fmt::format("the box leaves nothing of '{}' along {}: it spans {:.1f} to {:.1f} mm there",
                                    bone.name, "xyz"[axis], grid.origin[axis] / mm,
                                    (grid.origin[axis] + last * grid.spacing[axis]) / mm));
    }
    bone::Bone part;
    part.name = bone.name;
    part.colour = bone.colour;
    part.provenance = bone.provenance;
    part.distance = part_of_grid(bone.distance, low, high);
    part.density = part_of_grid(bone.density, low, high);
    if (closed) close_border(part.distance);
    return part;
}

}  // namespace tactus::analysis
