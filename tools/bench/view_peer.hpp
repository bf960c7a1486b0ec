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

    /// Meshes all of it by volumeToMesh and counts; a quad counts as two.
    std::size_t triangles() const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace tactus::bench
