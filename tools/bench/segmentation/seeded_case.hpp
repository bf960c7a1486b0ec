// SPDX-License-Identifier: Apache-2.0
// Real fractures with an expert's label per fragment, painted by a scripted user.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/segmentation/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench {

/// A scan whose fragments are known.
struct SeededCase {
    std::string name;
    int labels = 0;
    volume::Grid grid;
    segmentation::VoxelGraph graph;         ///< all voxels with an expert's label
    segmentation::GapLaw law;               ///< of `graph`; that of the scan
    std::vector<std::uint8_t> inside;  ///< of each voxel: it has a label
    std::vector<std::uint8_t> truth;   ///< of each node, from 1 on
    std::vector<std::int32_t> node_of_voxel;
    std::vector<std::uint32_t> surface;  ///< nodes with a neighbour outside of the bone
};
/// FOLDER/fragments/NAME_ct.nrrd and NAME_labels.nrrd; none when they are not there.
std::optional<SeededCase> seeded_case(const std::filesystem::path& folder, const std::string& name);

/// Dabs of three voxels' radius on the surface, `dabs` per label. A dab paints its own label only, as a user would.
std::vector<std::uint8_t> painted_seeds(const SeededCase& real, int dabs, Random random);
/// One more dab, of the label that the expert gave to `node`.
void add_dab(const SeededCase& real, std::size_t node, std::vector<std::uint8_t>& seed);

/// The graph with the conductances that `segment` takes for these seeds.
segmentation::VoxelGraph graph_of_seeds(const SeededCase& real, const std::vector<std::uint8_t>& seed);

/// Mean over the labels of 2 |A ∩ B| / (|A| + |B|).
double mean_dice(const SeededCase& real, const std::vector<std::uint8_t>& label);

/// Labels by scikit-image's random_walker (beta 130, Jacobi conjugate gradients, tolerance 1e-3) on values scaled to 0
/// to 1, and its processor time without that of its Laplacian, which several seedings share.
struct PeerLabels {
    std::vector<std::uint8_t> label;
    double seconds = 0.0;
};
/// Of each seeding; fewer when python3 cannot import it or fails. `cache`: a folder that keeps what was found for the same
/// values and seeds; empty: none.
std::vector<PeerLabels> peer_labels(const SeededCase& real, const std::vector<std::vector<std::uint8_t>>& seeds,
                                    const std::filesystem::path& cache);

}  // namespace tactus::bench
