// SPDX-License-Identifier: Apache-2.0
// The values that an observer receives from a run. They are copies; no memory is common with the run.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/core/time.hpp"
#include "dsp/core/types.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/rope/rope_shape.hpp"
#include "dsp/volume/bricks.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::observe {

/// A value and the logical time of the activation that computed it.
template <class T>
struct Seen {
    T value;
    Flicks when = 0;
};

/// Consecutive values of a port, as numbers. Activations that were lost are missing.
struct SeenValues {
    std::vector<Flicks> when;     ///< of each value
    std::vector<double> columns;  ///< as from ValueType::to_columns, value after value
    std::size_t per_value = 1;    ///< numbers of one value
};

/// A scene without the shapes of its bodies, which are identified by the hash of their content.
struct SeenScene {
    struct Object {
        std::uint64_t body = 0;  ///< content_hash of the Body
        Pose pose;
        int unit = -1;  ///< objects of one unit move together; -1: none
        int hangs_on = -1;  ///< the object to which it was fitted; -1: none
        std::int64_t stands = 0;  ///< 1: placed: locked, or fitted to another
    };
    std::uint64_t count = 0;
    std::array<Object, coupling::Scene::max_objects> objects;
};

/// The shape of a body, in its own frame, m.
struct SeenBody {
    std::string port;  ///< "node.port" that outputs it
    std::uint64_t content_hash = 0;
    Pose home;
    volume::Grid distance;  ///< empty if it has no distance field
    std::vector<Vec3> points;
    std::vector<std::uint8_t> labels;  ///< per point, see surface_label
};

/// A copy of one version of a bone. Bricks of one publication always appear together.
struct SeenBone {
    volume::BrickLayout layout;
    volume::BoneRoot root;  ///< its bricks, and `layout`
    std::int64_t version = 0, first_version = 0;
    Flicks when = 0;
    std::uint64_t update = 1;  ///< increases whenever bricks change
    std::vector<std::uint64_t> changed_at;  ///< per brick: the update that last changed it; 1: initial
    std::vector<std::unique_ptr<float[]>> distance, density;  ///< own copies; null if none is stored
    std::shared_ptr<const void> borrowed;  ///< owner of the bricks of `root` that are not copies

    /// Copies everything. Throws only std::bad_alloc.
    explicit SeenBone(const volume::BoneSnapshot& from);
    SeenBone(const SeenBone&) = delete;
    SeenBone& operator=(const SeenBone&) = delete;

    volume::BoneSnapshot snapshot() const { return {&root, version, 0}; }
    /// Bricks that changed after `since`, ascending.
    std::vector<std::uint32_t> changed_since(std::uint64_t since) const;
};

}  // namespace tactus::observe
