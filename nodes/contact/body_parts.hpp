// SPDX-License-Identifier: Apache-2.0
// The data of a node that creates a body.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/geometry/triangle_tree.hpp"

#include <algorithm>
#include <optional>

namespace tactus::nodes {

/// Points and distance field of one body; optionally the triangles of the field's zero surface. Throws Error if no
/// point represents an area.
struct BodyParts {
    contact::Pointshell shell;
    contact::Voxmap map;
    std::optional<geometry::TriangleTree> triangles;
    Pose home;
    std::uint64_t content_hash = 0;

    BodyParts(contact::Pointshell points, contact::Voxmap field, const Pose& at, bool with_triangles)
        : shell(std::move(points)), map(std::move(field)), home(at) {
        if (!shell.empty() && std::ranges::none_of(shell.area, [](float area) { return area > 0.0f; }))
            throw Error(
                "its surface points stand for no area, so contact would have no force; import it again, or give "
                "'spacing'");
        if (with_triangles) triangles.emplace(geometry::iso_surface(map.grid, 0.0f, false));
        Hash hash;
        hash.add_bytes(shell.position.data(), shell.position.size() * sizeof(Vec3));
        hash.add_bytes(map.grid.values.data(), map.grid.values.size() * sizeof(float));
        hash.add_bytes(&home, sizeof home);
        hash.add_word(with_triangles ? 1 : 0);
        content_hash = hash.state;
    }
    coupling::Body body() const noexcept {
        return {&shell, &map, triangles ? &*triangles : nullptr, home, 1, content_hash};
    }
};

}  // namespace tactus::nodes
