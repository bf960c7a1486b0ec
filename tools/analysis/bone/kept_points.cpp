// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/kept_points.hpp"

#include "assets/bone/mesh_part.hpp"
#include "assets/bone/surface_points.hpp"
#include "assets/plan/case_bones.hpp"
#include "assets/plan/mesh_unit.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/workers.hpp"

namespace tactus::analysis {

namespace {

/// The points that an import of a closed mesh and sampling it give, without what only the volume needs.
std::vector<contact::SurfacePoint> points_of_mesh(const std::filesystem::path& path) {
    try {
        return contact::sample_surface(bone::distance_of_mesh({.input = path,
                                                               .unit = plan::unit_of_file(path),
                                                               .is_coarse = false,
                                                               .within = {},
                                                               .is_surface_only = true,
                                                               .run = on_threads()}),
                                       {});
    } catch (const Error&) {
        return {};  // The import says what is wrong.
    }
}

}  // namespace

std::vector<contact::SurfacePoint> points_of_fragment(const std::filesystem::path& path, std::string& note) {
    return plan::points_of_key(plan::key_of_points(path), note, [&] {
        std::vector<contact::SurfacePoint> points;
        if (is_mesh(path)) points = points_of_mesh(path);
        if (!points.empty()) return points;
        return bone::surface_points(bone_of_file(path), {}, on_threads());
    });
}

}  // namespace tactus::analysis
