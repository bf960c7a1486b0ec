// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/readers.hpp"

#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

constexpr double most_voxels = 1e9;
constexpr int highest_label = 255;

// Small whole numbers, most of them background. A masked CT also has many zeros, but grey values beyond 255.
bool looks_like_labels(const std::vector<float>& values) {
    std::vector<bool> seen(highest_label + 1, false);
    std::size_t distinct = 0;
    std::size_t background = 0;
    for (const float value : values) {
        if (!(value >= 0.0f && value <= float(highest_label)) || value != std::floor(value)) return false;
        background += value == 0.0f;
        if (const auto label = static_cast<std::size_t>(value); !seen[label]) {
            seen[label] = true;
            ++distinct;
        }
    }
    return distinct >= 2 && distinct <= 128 && background * 2 > values.size();
}

}  // namespace

std::size_t checked_count(const std::array<std::int64_t, 3>& size, const std::string& file) {
    double count = 1.0;
    for (const std::int64_t n : size) {
        if (n < 1 || n > 1'000'000) throw Error(fmt::format("{}: {} samples along an axis cannot be", file, n));
        count *= static_cast<double>(n);
    }
    if (count > most_voxels)
        throw Error(fmt::format("{}: {:.0f} voxels are too many (at most 1e9); crop it first", file, count));
    return static_cast<std::size_t>(count);
}

void check_map(const SampleMap<Frame::lps>& map, const std::string& file) {
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(map.step[axis]);
        if (!(length > 1e-6 && length < 0.1))
            throw Error(
                fmt::format("{}: the voxel spacing along axis {} is missing or not between 0.001 and 100 mm; "
                            "give its spacing and directions in mm",
                            file, axis));
    }
    if (!is_finite(map.origin)) throw Error(fmt::format("{}: the place of its first voxel is not a number", file));
    const Vec3 a = glm::normalize(map.step[0]), b = glm::normalize(map.step[1]), c = glm::normalize(map.step[2]);
    if (!(std::abs(glm::dot(glm::cross(a, b), c)) > 0.3))
        throw Error(
            fmt::format("{}: its axes lean onto each other by more than 70 degrees; the directions in its header "
                        "must be wrong",
                        file));
}

void settle_meaning(ScanVolume& volume, bool integers) {
    for (const float value : volume.values)
        if (!std::isfinite(value)) throw Error(fmt::format("{}: a voxel's value is not a number", volume.source));
    if (!volume.segments.empty() || (integers && looks_like_labels(volume.values))) volume.kind = VolumeKind::labels;
    volume.hu = volume.kind == VolumeKind::labels ? HuKind::none : guess_hu(volume);
}

}  // namespace tactus
