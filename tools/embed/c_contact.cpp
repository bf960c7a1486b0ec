// SPDX-License-Identifier: Apache-2.0
// The C functions for the contact of two meshes.
#include "assets/mesh/mesh.hpp"
#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "tools/embed/c_errors.hpp"
#include "tools/embed/c_mesh.hpp"
#include "tools/embed/c_use.hpp"
#include "tools/embed/tactus.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

using namespace tactus;

struct tactus_contact {
    contact::Pointshell shell;
    contact::Voxmap map;
    contact::ContactLaw law;
    contact::PointshellContact kernel;
    std::atomic<bool> is_used{false};
};

namespace {

struct Settings {
    double stiffness = 4e10, spacing = 0.5e-3, voxel = 0.5e-3;
};

double given_or(double given, double otherwise, double lowest, double highest, const char* what, const char* unit) {
    if (given == 0.0) return otherwise;
    if (!(given >= lowest && given <= highest))
        throw Error(fmt::format("the {} of a contact, {:g} {}, is not between {:g} and {:g}", what, given, unit, lowest,
                                highest));
    return given;
}

Settings settings_of(const tactus_contact_settings* given) {
    Settings settings;
    if (!given) return settings;
    if (given->size != sizeof(*given))
        throw Error(
            "tactus_contact_settings.size must be sizeof(tactus_contact_settings) of the header that the program was "
            "compiled with");
    settings.stiffness = given_or(given->stiffness, settings.stiffness, 1.0, 1e15, "stiffness", "N/m per m²");
    settings.spacing = given_or(given->spacing, settings.spacing, 1e-5, 0.1, "spacing of points", "m");
    settings.voxel = given_or(given->voxel, settings.voxel, 1e-5, 0.1, "voxel", "m");
    return settings;
}

/// Distances inside an open surface, or one with triangles of both directions, are not defined.
void check_closed(const geometry::TriangleSurface& surface) {
    const mesh::MeshTopology topology = mesh::topology_of(surface);
    if (!topology.is_watertight())
        throw Error(
            fmt::format("the fixed mesh is not closed: {} edges with one triangle, {} with more than two, {} between "
                        "triangles of opposite direction; join equal vertices and close holes",
                        topology.boundary_edges, topology.non_manifold_edges, topology.flipped_edges));
    if (!(mesh::volume_of(surface) > 0.0))
        throw Error("the fixed mesh is inside out: triangles must be counter-clockwise seen from outside");
}

contact::Voxmap field_of(const geometry::TriangleSurface& surface, double voxel) {
    constexpr double max_samples = 1 << 25;  // 24 bytes each while they are computed
    constexpr int margin = 4;  // voxels around the surface
    Vec3 low = surface.vertices.front(), high = low;
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    volume::Grid layout{{0, 0, 0}, low - Vec3(margin * voxel), Vec3(voxel), {}};
    double count = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double samples = std::ceil((high[axis] - low[axis]) / voxel) + 2.0 * margin + 1.0;
        layout.size[static_cast<std::size_t>(axis)] = static_cast<int>(std::min(samples, max_samples));
        count *= samples;
    }
    if (count > max_samples)
        throw Error(
            fmt::format("the distance field of the fixed mesh would have {:.3g} samples of {:g} mm, more than {:.3g}; "
                        "choose a wider voxel",
                        count, voxel * 1e3, max_samples));
    return contact::make_voxmap(volume::signed_distance(layout, surface));
}

Pose pose_at(const double* poses, std::size_t index) {
    const double* const p = poses + 7 * index;
    Pose pose{{p[0], p[1], p[2]}, Quat(p[3], p[4], p[5], p[6])};
    if (!is_valid(pose))
        throw Error(
            fmt::format("pose {} is not valid: seven finite numbers, px py pz qw qx qy qz, with a quaternion of "
                        "length 1, are needed",
                        index));
    pose.orientation = glm::normalize(pose.orientation);
    return pose;
}

}  // namespace

extern "C" {

tactus_contact* tactus_make_contact(const tactus_mesh* moving, const tactus_mesh* fixed,
                                    const tactus_contact_settings* settings, tactus_error* error) {
    return embed::guarded<tactus_contact*>(error, nullptr, [&] {
        const Settings chosen = settings_of(settings);
        const geometry::TriangleSurface body = embed::surface_of(moving, "moving"),
                                        rest = embed::surface_of(fixed, "fixed");
        check_closed(rest);
        contact::Pointshell shell =
            contact::make_pointshell(contact::sample_surface(body, {.spacing = chosen.spacing}));
        if (shell.empty()) throw Error("the moving mesh has no area");
        contact::ContactLaw law;
        law.stiffness = chosen.stiffness;
        law.by_area = true;
        contact::PointshellContact kernel(shell.nodes.size());
        return new tactus_contact{std::move(shell), field_of(rest, chosen.voxel), law, std::move(kernel)};
    });
}

int tactus_contact_at(tactus_contact* contact, const double* poses, size_t count, tactus_contact_sum* sums,
                      tactus_error* error) {
    return embed::guarded(error, -1, [&] {
        const embed::Use<tactus_contact> held(contact, "contact");
        if (count > 0 && (!poses || !sums))
            throw Error("there are no poses, or there is no room for the sums: NULL was given");
        for (std::size_t n = 0; n < count; ++n) {
            const Pose pose = pose_at(poses, n);
            const contact::ContactPair pair{&held->shell, pose, &held->map, Pose{}};
            const contact::ContactSum found = held->kernel({&pair, 1}, pose.position, held->law);
            tactus_contact_sum& sum = sums[n];
            const Wrench wrench = found.wrench();
            for (int axis = 0; axis < 3; ++axis) {
                sum.wrench[axis] = wrench.force[axis];
                sum.wrench[3 + axis] = wrench.torque[axis];
            }
            std::ranges::copy(found.stiffness, sum.stiffness);
            sum.energy = found.energy;
            sum.penetration = found.penetration;
            sum.points = static_cast<int64_t>(found.in_contact);
        }
        return 0;
    });
}

void tactus_free_contact(tactus_contact* contact) { delete contact; }

}  // extern "C"
