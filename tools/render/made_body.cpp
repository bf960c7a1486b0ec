// SPDX-License-Identifier: Apache-2.0
#include "tools/render/made_body.hpp"

#include "tools/render/scene_colours.hpp"

#include <glm/common.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace tactus::render {

MadeBody make_body(BodyLook look) {
    MadeBody made{std::move(look), {}, {}, {}, {}};
    const observe::SeenBody& body = *made.look.body;
    made.field = contact::make_voxmap(body.distance);
    made.grid = {body.distance.origin, body.distance.spacing, 0};
    made.surface = make_body_surface(body, made.field, made.look.colour, scene_colours::paint_colour);
    auto& vertices = made.surface.patch.vertices;
    const std::vector<float>* distances = nullptr;
    if (made.look.map)
        if (const auto of = made.look.map->distance.find(body.content_hash); of != made.look.map->distance.end())
            distances = &of->second;
    if (distances && distances->size() == vertices.size()) {
        const auto plain = geometry::packed_colour(glm::mix(made.look.colour, Vec3(0.55), 0.75));
        for (std::size_t n = 0; n < vertices.size(); ++n) {
            const double distance = static_cast<double>((*distances)[n]);
            vertices[n].colour =
                std::isfinite(distance) ? geometry::packed_colour(map_colour(distance, made.look.map_range)) : plain;
        }
        made.surface.has_paint = false;
    }
    geometry::CoarseSurface coarse;
    made.levels = coarse.make(made.surface.patch, made.grid);
    return made;
}

}  // namespace tactus::render
