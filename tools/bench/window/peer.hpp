// SPDX-License-Identifier: Apache-2.0
// The same surface by OpenVDB.
#pragma once

#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <memory>

namespace tactus::bench {

class ViewGridPeer {
public:
    explicit ViewGridPeer(const volume::Grid& distance);
    ~ViewGridPeer();
    ViewGridPeer(const ViewGridPeer&) = delete;
    ViewGridPeer& operator=(const ViewGridPeer&) = delete;

    /// Meshes the whole grid with volumeToMesh; returns the number of triangles, two per quad.
    std::size_t triangles() const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace tactus::bench
