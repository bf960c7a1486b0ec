// SPDX-License-Identifier: Apache-2.0
// The same distances in OpenVDB, read by its own trilinear stencil.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/volume/grid.hpp"

#include <memory>
#include <span>

namespace tactus::bench {

/// A dense grid as an OpenVDB float grid with every sample active.
class ContactGridPeer {
public:
    explicit ContactGridPeer(const volume::Grid& distance);
    ~ContactGridPeer();
    ContactGridPeer(const ContactGridPeer&) = delete;
    ContactGridPeer& operator=(const ContactGridPeer&) = delete;

    /// Value and gradient at every point, moved by the pose; returns a sum over all, so that nothing is left out. No
    /// forces are made of them.
    double read(std::span<const Vec3> points, const Pose& pose) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace tactus::bench
