// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/contact_peer.hpp"

#include <glm/gtc/quaternion.hpp>

#include <openvdb/math/Stencils.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

namespace tactus::bench {

struct ContactGridPeer::Tree {
    openvdb::FloatGrid::Ptr grid;
    Vec3 origin, per_spacing;
};

ContactGridPeer::ContactGridPeer(const volume::Grid& distance) : tree_(std::make_unique<Tree>()) {
    openvdb::initialize();
    const auto [nx, ny, nz] = distance.size;
    const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(nx - 1, ny - 1, nz - 1));
    tree_->grid = openvdb::FloatGrid::create(1.0f);
    // The tolerance is zero, so that no sample is pruned.
    const openvdb::tools::Dense<const float, openvdb::tools::LayoutXYZ> dense(box, distance.values.data());
    openvdb::tools::copyFromDense(dense, *tree_->grid, 0.0f, /*serial=*/true);
    tree_->origin = distance.origin;
    tree_->per_spacing = 1.0 / distance.spacing;
}

ContactGridPeer::~ContactGridPeer() = default;

double ContactGridPeer::read(std::span<const Vec3> points, const Pose& pose) const {
    openvdb::math::BoxStencil<openvdb::FloatGrid> stencil(*tree_->grid);
    const Mat3 turn = glm::mat3_cast(pose.orientation);
    double sum = 0.0;
    for (const Vec3& point : points) {
        const Vec3 p = (pose.position + turn * point - tree_->origin) * tree_->per_spacing;
        const openvdb::Vec3f at(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
        stencil.moveTo(at);
        const auto slope = stencil.gradient(at);
        sum += static_cast<double>(stencil.interpolation(at)) + static_cast<double>(slope[0] + slope[1] + slope[2]);
    }
    return sum;
}

}  // namespace tactus::bench
