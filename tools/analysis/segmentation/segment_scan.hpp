// SPDX-License-Identifier: Apache-2.0
// Separates the fragments of a scan by random walks from painted seeds.
#pragma once

#include "assets/segmentation/seeds_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/jobs.hpp"
#include "dsp/segmentation/label_map.hpp"
#include "dsp/segmentation/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

struct SegmentSettings {
    std::filesystem::path scan;      ///< as for volume::read_volume
    volume::ReadOptions read;
    std::optional<double> threshold;  ///< values at and above it are bone; none: bone::suggested_threshold
    /// Values at and above it are excluded; none: 2500 HU, and no limit for scanner numbers.
    std::optional<double> metal;
    double marrow = 2e-3;            ///< m: radius of the closing that includes marrow; 0: none
    RunJobs run = run_in_turn;
};

/// The bone of a scan as a graph.
struct ScanGraph {
    volume::Grid scan;               ///< values on LPS axes
    volume::HuKind hu = volume::HuKind::calibrated;
    bool is_in_hu = true;
    std::vector<std::string> notes;  ///< corrections while reading, and excluded parts; one sentence each
    double threshold = 0.0;
    std::string threshold_from;      ///< "given", or the method
    std::size_t metal_voxels = 0;
    segmentation::GapLaw law;

    volume::Grid box;                ///< the part of the scan around the bone; values are those of the scan
    std::array<int, 3> box_at{0, 0, 0};  ///< its first sample in the scan
    segmentation::VoxelGraph graph;       ///< of `box`
    std::vector<std::int32_t> node_of_voxel;  ///< of `box`
};
/// Reads a scan and makes its graph. Throws Error for scans without bone and for label maps.
ScanGraph scan_graph(const SegmentSettings& settings);

/// Returns the strokes of segmentation::propose_seeds, named "fragment_1" and so on. Throws Error if there are fewer than
/// two.
std::vector<segmentation::SeedLabel> proposed_seeds(const ScanGraph& scan);

struct SegmentedLabel {
    std::string name;
    Vec3 colour{0.0};  ///< sRGB, 0 to 1
    std::size_t voxels = 0;
    double volume = 0.0;  ///< m³
};
struct UnseededIsland {
    std::size_t voxels = 0;
    Vec3 centre{0.0};  ///< m, mean of its voxels
    Vec3 inside{0.0};  ///< m, its voxel nearest to the centre
};
/// Returns the parts of the bone that no seed reaches, largest first. `label`: per node, 0 if it has none.
std::vector<UnseededIsland> islands_of(const ScanGraph& scan, std::span<const std::uint8_t> label);

struct UncertainPlace {
    std::size_t voxels = 0;
    Vec3 deepest{0.0};  ///< m
};
struct TouchingFace {
    std::string a, b;
    double area = 0.0;  ///< m²
};

struct SegmentedScan {
    segmentation::LabelMap map;  ///< of the whole scan
    volume::Grid certainty;  ///< of the whole scan, 0 where there is no bone
    std::vector<SegmentedLabel> labels;
    std::vector<UnseededIsland> islands;  ///< largest first
    std::vector<UncertainPlace> uncertain;  ///< regions with certainty below 0.4, largest first
    std::vector<TouchingFace> touching;  ///< labels in contact without a gap, widest first: their faces are as scanned
    std::size_t marrow_voxels = 0;  ///< voxels that received the label of the nearest bone
    segmentation::GapLaw law;  ///< the law used; see segmentation::law_of_seeds
    double residual = 0.0;
    int iterations = 0;
    double certainty_p05 = 0.0;  ///< 5th percentile of the certainty of the labelled bone voxels
    double seconds = 0.0;  ///< processor time of the solver
};
/// Returns the graph with the conductances for these seeds, or null if those of the scan itself apply. `law`: receives
/// the law used.
std::unique_ptr<segmentation::VoxelGraph> graph_for_seeds(const ScanGraph& scan, std::span<const std::uint8_t> seed,
                                                          segmentation::GapLaw& law);

/// Throws Error for strokes that touch no bone, and for labels whose strokes are completely painted over by later ones;
/// `seeds_file` is the name in the message.
SegmentedScan segment_scan(const ScanGraph& scan, std::span<const segmentation::SeedLabel> seeds,
                           const SegmentSettings& settings, const std::string& seeds_file);

}  // namespace tactus::analysis
