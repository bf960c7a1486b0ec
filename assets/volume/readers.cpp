// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/readers.hpp"

#include "assets/volume/voxel_limit.hpp"
#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tactus::volume {

namespace {

constexpr int highest_label = 255;

// Labels are small whole numbers, most of them 0. A masked CT also has many zeros, but grey values above 255.
bool looks_like_labels(const Tally& tally) {
    return tally.whole && tally.high <= float(highest_label) && tally.labels.size() >= 2 &&
           tally.labels.size() <= 128 && tally.zeros * 2 > tally.count;
}

HuKind guess_hu(const Tally& tally) {
    if (tally.count > 0 && tally.low <= -500.0f) return HuKind::calibrated;
    // Eight bits hold no HU: a window of a scan, in which air is 0 and soft tissue is not.
    if (tally.whole && tally.high <= float(highest_label)) return HuKind::scanner;
    return tally.zeros * 2 > tally.count && tally.border_zeros * 100 >= tally.border * 99 ? HuKind::masked
                                                                                          : HuKind::scanner;
}

}  // namespace

std::optional<double> parse_surface_hu(std::string_view text) {
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::size_t checked_count(const std::array<std::int64_t, 3>& size, const std::string& file) {
    double count = 1.0;
    for (const std::int64_t n : size) {
        if (n < 1 || n > 1'000'000) throw Error(fmt::format("{}: {} samples along an axis are not possible", file, n));
        count *= static_cast<double>(n);
    }
    if (count > max_voxels)
        throw Error(fmt::format("{}: too many voxels: {:.0f} (at most 1e9); crop the file first", file, count));
    return static_cast<std::size_t>(count);
}

void check_map(const SampleMap<Frame::lps>& map, const std::string& file) {
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(map.step[axis]);
        if (!(length > 1e-8 && length < 0.1))
            throw Error(
                fmt::format("{}: the voxel spacing along axis {} is missing or not between 0.00001 and 100 mm; "
                            "give its spacing and directions in mm",
                            file, axis));
    }
    if (!is_finite(map.origin)) throw Error(fmt::format("{}: the position of the first voxel is not a number", file));
    const Vec3 a = glm::normalize(map.step[0]), b = glm::normalize(map.step[1]), c = glm::normalize(map.step[2]);
    if (!(std::abs(glm::dot(glm::cross(a, b), c)) > 0.3))
        throw Error(fmt::format(
            "{}: its axes are sheared by more than 70 degrees; the directions in the header must be wrong", file));
}

void settle_meaning(ScanVolume& volume, const Tally& tally, bool integers) {
    if (tally.not_numbers > 0 && tally.not_numbers == tally.count)
        throw Error(fmt::format("{}: no voxel's value is a number", volume.source));
    if (tally.not_numbers > 0)
        volume.notes.push_back(
            fmt::format("{} of {} voxels are not numbers; they were read as air, the least value of "
                        "their slice",
                        tally.not_numbers, tally.count));
    if (!volume.segments.empty() || (integers && looks_like_labels(tally))) volume.kind = VolumeKind::labels;
    else if (!integers && volume.kind == VolumeKind::ct && looks_like_labels(tally)) {
        volume.kind = VolumeKind::maybe_labels;
        volume.notes.push_back(
            "the values are few whole numbers, most of them 0, as of a label map: --label imports it as one");
    }
    volume.hu = volume.kind == VolumeKind::labels ? HuKind::none : guess_hu(tally);
}

}  // namespace tactus::volume
