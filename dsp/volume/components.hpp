// SPDX-License-Identifier: Apache-2.0
// Connected components of a thresholded volume, and the hollows that they enclose.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::volume {

/// A run of connected samples in one row.
struct SampleRun {
    int begin, end;  ///< along x; end is exclusive
    std::int32_t part = 0;  ///< rank of its component; 0 is the largest
};

/// Run-length encoding of a set of samples, row by row.
struct RunRows {
    std::array<int, 3> size{0, 0, 0};
    std::vector<std::size_t> start{0};  ///< first run of each row (y fastest), and of the next row
    std::vector<SampleRun> runs;

    std::span<const SampleRun> row(int j, int k) const {
        const std::size_t n =
            static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j);
        return std::span(runs).subspan(start[n], start[n + 1] - start[n]);
    }
};

/// Appends the samples ≥ iso of `count` layers of `grey`, from its layer `first` on, to `rows`.
void append_above(RunRows& rows, const Grid& grey, float iso, int first, int count, const RunJobs& run = run_in_turn);

/// Components of {grey ≥ iso}, 26-connected (faces, edges and corners), largest first; equal sizes in the order of
/// their first sample.
struct Components {
    RunRows rows;
    std::vector<std::size_t> voxels;  ///< number of samples of each, descending
    struct Box {
        std::array<int, 3> first, last;
    };
    std::vector<Box> boxes;  ///< bounding box of each in samples, inclusive
};
Components components_of(RunRows rows);
Components components_above(const Grid& grey, float iso);

/// Returns the hollows: samples outside of the `keep` largest components (0: of all) that are not 6-connected to the
/// border.
RunRows hollows_of(const Components& components, std::size_t keep);

/// Removes all components but the `keep` largest from `grey` by mirroring their samples about iso. Samples below iso
/// stay, so that the surface of the kept components does not move. `grey` may be some layers only, from `first` on.
void keep_largest(Grid& grey, float iso, const Components& components, std::size_t keep, int first = 0);

/// Fills hollows by mirroring their samples about iso. The outer surface does not move.
void fill_hollows(Grid& grey, float iso, const RunRows& hollows, int first = 0);
/// The same for a whole volume; returns the number of changed samples.
std::size_t fill_hollows(Grid& grey, float iso);

}  // namespace tactus::volume
