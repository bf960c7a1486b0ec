// SPDX-License-Identifier: Apache-2.0
// Connected parts of what lies at or above a value, and the hollows they enclose.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::volume {

/// Neighbouring samples of one row that belong together.
struct SampleRun {
    int begin, end;         ///< along x; end is behind the last
    std::int32_t part = 0;  ///< rank of its component, 0 is the largest
};

/// The samples in question of a volume, row by row: far fewer than all samples.
struct RunRows {
    std::array<int, 3> size{0, 0, 0};
    std::vector<std::size_t> start{0};  ///< of each row's runs (y fastest), and of the row that comes next
    std::vector<SampleRun> runs;

    std::span<const SampleRun> row(int j, int k) const {
        const std::size_t n =
            static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j);
        return std::span(runs).subspan(start[n], start[n + 1] - start[n]);
    }
};

/// Appends the samples ≥ iso of `count` layers of `grey`, from its layer `first` on, to those that `rows` has.
void append_above(RunRows& rows, const Grid& grey, float iso, int first, int count, const RunJobs& run = run_in_turn);

/// Parts of {grey ≥ iso}, joined through faces, edges and corners (26 neighbours), largest first; equal sizes in the
/// order of their first sample.
struct Components {
    RunRows rows;
    std::vector<std::size_t> voxels;  ///< samples of each, descending
    struct Box {
        std::array<int, 3> first, last;
    };
    std::vector<Box> boxes;  ///< samples at the ends of each, inclusive
};
Components components_of(RunRows rows);
Components components_above(const Grid& grey, float iso);

/// Samples that belong to none of the `keep` largest components (0: of all), joined through faces, and cannot be
/// reached from the border.
RunRows hollows_of(const Components& components, std::size_t keep);

/// Takes all components but the `keep` largest out of `grey` by mirroring their samples about iso. Samples below iso
/// stay as they are, so the surface of what is kept does not move. `grey` may be some layers only, from `first` on.
void keep_largest(Grid& grey, float iso, const Components& components, std::size_t keep, int first = 0);

/// Makes hollows solid by mirroring their samples about iso. The outer surface does not move.
void fill_hollows(Grid& grey, float iso, const RunRows& hollows, int first = 0);
/// The same for a whole volume; returns the number of samples changed.
std::size_t fill_hollows(Grid& grey, float iso);

}  // namespace tactus::volume
