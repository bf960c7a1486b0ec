// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/window/peer.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <vector>

namespace tactus::bench {

struct ViewGridPeer::Tree {
    openvdb::FloatGrid::Ptr grid;
};

/// A level set with a narrow band of three voxels, OpenVDB's standard form.
ViewGridPeer::ViewGridPeer(const volume::Grid& distance) : tree_(std::make_unique<Tree>()) {
    openvdb::initialize();
    const auto band = static_cast<float>(3.0 * distance.spacing.x);
    std::vector<float> values = distance.values;
    for (float& value : values) value = std::clamp(value, -band, band);
    const auto [nx, ny, nz] = distance.size;
    const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(nx - 1, ny - 1, nz - 1));
    tree_->grid = openvdb::FloatGrid::create(band);
    tree_->grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::tools::Dense<const float, openvdb::tools::LayoutXYZ> dense(box, values.data());
    openvdb::tools::copyFromDense(dense, *tree_->grid, 0.0f);
    openvdb::tools::pruneLevelSet(tree_->grid->tree());
}

ViewGridPeer::~ViewGridPeer() = default;

std::size_t ViewGridPeer::triangles() const {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*tree_->grid, points, triangles, quads, 0.0, 0.0);
    return triangles.size() + 2 * quads.size();
}

}  // namespace tactus::bench
