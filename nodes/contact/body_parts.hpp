// SPDX-License-Identifier: Apache-2.0
// The data of a node that creates a body.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/geometry/triangle_tree.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

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

/// The body of a bone: its frame has the axes of the file and the centroid of the surface points as its origin. `spacing`
/// of the points, m; 0: those of the file, or 0.5 mm if it has none. Throws Error for a bone without a surface.
inline std::shared_ptr<const BodyParts> parts_of(const bone::Bone& bone, double spacing, bool with_triangles) {
    std::vector<contact::SurfacePoint> points = bone.points;
    if (spacing > 0.0 || points.empty()) {
        contact::SurfaceSampling sampling;
        if (spacing > 0.0) sampling.spacing = spacing;
        points = contact::sample_surface(bone.distance, sampling);
    }
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : points) middle += p.position;
    middle /= static_cast<double>(std::max<std::size_t>(points.size(), 1));
    for (contact::SurfacePoint& p : points) p.position -= middle;
    volume::Grid field = bone.distance;
    field.origin -= middle;
    auto parts =
        std::make_shared<const BodyParts>(contact::make_pointshell(points), contact::make_voxmap(std::move(field)),
                                          Pose{middle, {1.0, 0.0, 0.0, 0.0}}, with_triangles);
    if (parts->shell.empty()) throw Error("bone '" + bone.name + "' has no surface");
    return parts;
}

}  // namespace tactus::nodes
