// SPDX-License-Identifier: Apache-2.0
// Everything of a body's picture that needs no graphics card: it can be made on another thread.
#pragma once

#include "dsp/geometry/coarse_surface.hpp"
#include "tools/render/body_surface.hpp"
#include "tools/render/surface_map.hpp"

#include <memory>

namespace tactus::render {

/// How a body is to look. `map`: null for none; `map_range`: m, distance of its fullest colour.
struct BodyLook {
    std::shared_ptr<const observe::SeenBody> body;
    Vec3 colour{0.0};
    std::shared_ptr<const SurfaceMap> map;
    double map_range = 1e-3;
    int map_number = 0;
};

struct MadeBody {
    BodyLook look;
    contact::Voxmap field;
    BodySurface surface;
    geometry::SurfaceGrid grid;
    geometry::CoarseSurface::Levels levels;
};

/// In its colour, or in those of the map where the map has the body. Throws Error as make_voxmap does.
MadeBody make_body(BodyLook look);

}  // namespace tactus::render
