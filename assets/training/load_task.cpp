// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"
#include "assets/training/task_file.hpp"
#include "assets/volume/file_hash.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/iso_distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::training {

namespace {

constexpr double margin = 10e-3;  // m of room around a structure, in which its distance is exact
constexpr std::size_t max_samples = 200'000'000;

/// One label of a map as a signed distance on the map's samples, with room around it.
volume::Grid distance_of(const volume::Grid& labels, int label, const std::string& what) {
    std::array<int, 3> low{labels.size}, high{-1, -1, -1};
    const auto wanted = static_cast<float>(label);
    for (int k = 0; k < labels.size[2]; ++k)
        for (int j = 0; j < labels.size[1]; ++j)
            for (int i = 0; i < labels.size[0]; ++i)
                if (labels.at(i, j, k) == wanted)
                    for (std::size_t a = 0; a < 3; ++a) {
                        const int n = std::array{i, j, k}[a];
                        low[a] = std::min(low[a], n);
                        high[a] = std::max(high[a], n);
                    }
    if (high[0] < 0) throw Error(fmt::format("{} has no sample with the label {}", what, label));
    volume::Grid grid{{}, {}, labels.spacing, {}};
    std::array<int, 3> offset{};
    for (std::size_t a = 0; a < 3; ++a) {
        const int room = std::max(2, static_cast<int>(std::ceil(margin / labels.spacing[static_cast<int>(a)])));
        offset[a] = low[a] - room;
        grid.size[a] = high[a] - low[a] + 1 + 2 * room;
        grid.origin[static_cast<int>(a)] =
            labels.origin[static_cast<int>(a)] + offset[a] * labels.spacing[static_cast<int>(a)];
    }
    if (grid.count() > max_samples)
        throw Error(fmt::format("{}: the structure spans {} samples; at most {} are possible", what, grid.count(),
                                max_samples));
    grid.values.assign(grid.count(), 0.0f);
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
            for (int i = low[0]; i <= high[0]; ++i)
                if (labels.at(i, j, k) == wanted) grid.at(i - offset[0], j - offset[1], k - offset[2]) = 1.0f;
    return volume::distance_to_iso(grid, 0.5f);
}

}  // namespace

Task load_task(const std::filesystem::path& path) {
    Task task{load_task_file(path), {}, {}, 0};
    Hash hash;
    file::add_file(hash, path);
    for (const SparedFile& spare : task.spare) {
        try {
            const volume::Grid labels = volume::lps_grid(volume::read_volume(spare.file));
            task.spared.push_back({spare.name, spare.margin, distance_of(labels, spare.label, spare.file.string())});
            // A folder of images is hashed by the samples that were read from it.
            if (std::filesystem::is_regular_file(spare.file)) volume::add_file_with_samples(hash, spare.file);
            else hash.add_bytes(labels.values.data(), labels.values.size() * sizeof(float));
        } catch (const Error& error) {
            throw Error({path.string(), spare.line, 1}, fmt::format("structure '{}': {}", spare.name, error.what()));
        }
    }
    if (task.guide) {
        try {
            task.guide_body = std::make_shared<const bone::Bone>(bone::load_bone(task.guide->bone));
        } catch (const Error& error) {
            throw Error({path.string(), task.guide->line, 1}, fmt::format("guide: {}", error.what()));
        }
        hash.add_bytes(task.guide_body->distance.values.data(),
                       task.guide_body->distance.values.size() * sizeof(float));
    }
    task.hash = hash.value();
    return task;
}

}  // namespace tactus::training
