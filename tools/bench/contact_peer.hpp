// SPDX-License-Identifier: Apache-2.0
// The same distances in OpenVDB, sampled with its trilinear stencil.
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

    /// Samples value and gradient at every transformed point; returns a sum, so that the compiler cannot remove the
    /// work. Computes no forces.
    double read(std::span<const Vec3> points, const Pose& pose) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace tactus::bench
