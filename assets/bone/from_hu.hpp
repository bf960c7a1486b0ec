// SPDX-License-Identifier: Apache-2.0
// Converts a CT volume in HU to a bone.
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

/// Settings of the surface extraction from CT values.
struct BoneSurface {
    float threshold = 300.0f;  ///< HU; samples at or above it are bone
    std::size_t keep = 1;      ///< number of components to keep, largest first; 0 keeps all
    bool fill = true;          ///< closed hollows and marrow (marrow_of) count as bone; they keep their low density
};

/// Upper limit of bone density, kg/m³ (enamel reaches 2900 to 3000): higher values are fillings, implants, or artefacts
/// beside them.
inline constexpr double max_bone_density = 3000.0;

/// Density in kg/m³ from HU by the default linear relation, at least 0. It assumes a typical scanner, because the scan
/// contains no density phantom.
float density_of_hu(float hu);
/// The inverse of density_of_hu for densities above 0, HU.
float hu_of_density(float density);
/// Describes the relation, with its source.
std::string density_calibration();

/// HU on a grid with LPS axes, delivered layer by layer.
struct HuLayers {
    /// A range of samples in x and y, low to high inclusive.
    struct Window {
        std::array<int, 2> low, high;
    };
    volume::Grid layout;  ///< size, origin and spacing; no values
    /// The samples of a window in `count` layers, starting at `first`. Called in ascending order, in two passes.
    std::function<volume::Grid(int first, int count, const Window& window)> layers;
};

/// Chunk size and callbacks. They do not change the result.
struct ImportInLayers {
    int at_once = 0;  ///< layers; 0: as many as have some million samples
    std::function<void(double share)> progress = [](double) {};
    std::function<void()> check_values = [] {};  ///< called after the first pass over the layers; may throw
};

struct SparseHuBone {
    SparseBone bone;
    std::map<std::string, std::string> provenance;
    std::size_t components = 0;  ///< found above the threshold, before selection
    std::size_t voxels_above = 0, voxels_kept = 0;  ///< samples at or above the threshold: all, and in kept components
    std::size_t voxels_hollow = 0,
                voxels_marrow = 0;  ///< that count as bone because bone encloses them: wholly; with leaks
};

/// Builds distance and density on the samples of `hu` (LPS, m) around the bone, with a margin of 5 mm and at least six
/// samples. Outside the volume it adds four layers of air: a bone cut by the border of the scan ends in a flat face
/// half a voxel outside the last samples. Grey values are smoothed to about 0.3 mm; coarser voxels are not smoothed,
/// because any scanner blurs more than that. Distances outside the bone are clamped to 5 mm or six voxels. Throws Error
/// if no sample reaches the threshold. Memory: about 25 bytes per sample of the layers in process, 20 per run of
/// neighbouring samples above the threshold, 24 per cell that the surface crosses, and the blocks of the result.
/// Samples that are not bone need no memory beyond that.
SparseHuBone sparse_bone_from_hu(const HuLayers& hu, const BoneSurface& surface, const RunJobs& run = run_in_turn,
                                 const ImportInLayers& how = {});

struct HuBone {
    Bone bone;
    std::size_t components = 0;
};

/// The same for a volume in memory.
HuBone bone_from_hu(volume::Grid hu, const BoneSurface& surface, const RunJobs& run = run_in_turn);

}  // namespace tactus::bone
