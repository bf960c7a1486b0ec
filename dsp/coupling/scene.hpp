// SPDX-License-Identifier: Apache-2.0
// Bodies and their poses, for contact and coupling.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tactus::geometry {
class TriangleTree;
}

namespace tactus::coupling {

/// A body for contact: surface points, distance field, or triangles; in one frame; any may be missing. Does not own
/// them: the node that made the body does.
struct Body {
    static constexpr std::string_view wire_name = "body";

    const contact::Pointshell* shell = nullptr;
    const contact::Voxmap* map = nullptr;
    const geometry::TriangleTree* triangles = nullptr;
    Pose home;  ///< frame of the body in the frame of its file
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;
};

struct SceneObject {
    Body body;
    Pose pose;
    int unit = -1;  ///< objects of one unit move together and do not touch each other; -1: none
    bool stands = true;  ///< the object is placed: others may be fitted to it
    int hangs_on = -1;   ///< the object that it was fitted to, and that it stands by; -1: none
};

/// Up to sixteen bodies with their poses, by value: a scene is a snapshot.
struct Scene {
    static constexpr std::string_view wire_name = "scene";
    static constexpr std::size_t max_objects = 16;

    std::array<SceneObject, max_objects> objects;
    std::size_t count = 0;
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;
};

/// Hash of the bodies and poses of a scene.
inline std::uint64_t hash_of(const Scene& scene) noexcept {
    Hash hash;
    hash.add_word(scene.count);
    for (std::size_t i = 0; i < scene.count; ++i) {
        hash.add_word(scene.objects[i].body.content_hash);
        hash.add_bytes(&scene.objects[i].pose, sizeof(Pose));
        if (scene.objects[i].unit >= 0) hash.add_word(static_cast<std::uint64_t>(scene.objects[i].unit) + 1);
    }
    return hash.state;
}

}  // namespace tactus::coupling
