// SPDX-License-Identifier: Apache-2.0
// From a CT volume in HU to a bone.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "dsp/core/jobs.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>

namespace tactus::bone {

/// How the surface of a bone is taken from CT values.
struct BoneSurface {
    float threshold = 300.0f;  ///< HU; bone is what lies at or above
    std::size_t keep = 1;      ///< how many components, largest first; 0 keeps all
    bool fill = true;          ///< hollows that do not reach the outside count as bone (their density stays low)
};

/// kg/m³ from HU by the default line, never below 0. Uncalibrated: no density phantom was in the scan.
float density_of_hu(float hu);
/// HU from kg/m³ by the same line.
float hu_of_density(float density);
/// The same line in words, with its source.
std::string density_calibration();

/// HU on a grid of LPS axes that need not be in memory.
struct HuLayers {
    /// Samples along x and y, from low to high (inclusive).
    struct Window {
        std::array<int, 2> low, high;
    };
    volume::Grid layout;  ///< size, origin and spacing; no values
    /// What a window shows of `count` layers from `first` on; asked for in ascending order, twice.
    std::function<volume::Grid(int first, int count, const Window& window)> layers;
};

/// How much is worked on at one time, and who hears of it. Changes no bit of the result.
struct ImportInLayers {
    int at_once = 0;  ///< layers; 0: as many as have some million samples
    std::function<void(double share)> progress = [](double) {};
    std::function<void()> check_values = [] {};  ///< called when all layers were read once; may throw
};

struct SparseHuBone {
    SparseBone bone;
    std::map<std::string, std::string> provenance;
    std::size_t components = 0;  ///< found above the threshold, before any were taken out
};

/// Builds distance and density on those samples of `hu` (LPS, m) that lie around the bone, with five millimetres and six
/// samples of room; outside of the volume four layers of air are added, so that a bone cut by its border ends in a flat
/// face half a voxel outside the last samples. Grey values are smoothed to about 0.3 mm (not at all where voxels are
/// coarser: any scanner blurs more than that). Distances outside of the bone are not longer than five millimetres or six
/// voxels. Throws Error when nothing reaches the threshold. Memory: some 25 bytes per sample of the layers that are
/// worked on, 20 per run of neighbouring samples above the threshold, 24 per cell that the surface crosses, and the blocks
/// of the result; none of it grows with what is not bone.
SparseHuBone sparse_bone_from_hu(const HuLayers& hu, const BoneSurface& surface, const RunJobs& run = run_in_turn,
                                 const ImportInLayers& how = {});

struct HuBone {
    Bone bone;
    std::size_t components = 0;
};

/// The same with all samples in memory.
HuBone bone_from_hu(volume::Grid hu, const BoneSurface& surface, const RunJobs& run = run_in_turn);

}  // namespace tactus::bone
