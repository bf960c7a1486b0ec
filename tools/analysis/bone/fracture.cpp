// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/fracture.hpp"

#include "assets/plan/break_bone.hpp"
#include "assets/plan/paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::analysis {

namespace {

double volume_of_solid(const volume::Grid& solid) {
    const auto inside = std::ranges::count_if(solid.values, [](float d) { return d < 0.0f; });
    return static_cast<double>(inside) * solid.spacing.x * solid.spacing.y * solid.spacing.z;
}

Vec3 middle_of(const volume::Grid& solid) {
    return solid.origin + 0.5 * Vec3(solid.size[0] - 1, solid.size[1] - 1, solid.size[2] - 1) * solid.spacing;
}

/// Displacement of a fragment in its file: away from `centre` with a small sideways part, and a rotation about its own
/// centre.
Pose displaced(const volume::Grid& solid, const Vec3& centre, const FractureSettings& settings, std::uint64_t seed) {
    const Random random{seed};
    const auto direction = [&](std::uint64_t n) {
        return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
    };
    const Vec3 middle = middle_of(solid), away = middle - centre;
    const Vec3 outwards = glm::length(away) > 1e-6 ? glm::normalize(away) : direction(9);
    const Quat turn = rotation_by(settings.turn * direction(0));
    const Vec3 to = middle + settings.spread * glm::normalize(outwards + 0.5 * direction(3));
    return {to - turn * middle, turn};
}

/// The density of the unbroken bone, sampled inside the fragment.
volume::Grid density_of(const bone::Bone& bone, const volume::Grid& distance, const Pose& into_bone) {
    const contact::Voxmap map = contact::make_voxmap(bone.density);
    volume::Grid density = distance;
    for (int k = 0; k < density.size[2]; ++k)
        for (int j = 0; j < density.size[1]; ++j)
            for (int i = 0; i < density.size[0]; ++i) {
                const volume::Sample here = map.sample(into_bone.apply(density.position(i, j, k)));
                density.at(i, j, k) = density.at(i, j, k) < 0.0f && here.inside ? static_cast<float>(here.value) : 0.0f;
            }
    return density;
}

bone::Bone scan_fragment(const bone::Bone& bone, const contact::Voxmap& map, const volume::Grid& solid,
                         const Pose& placement, const FractureSettings& settings, std::uint64_t seed) {
    plan::ScanOptions scan;
    scan.voxel = Vec3(settings.voxel);
    scan.blur = settings.blur;
    scan.noise = settings.noise;
    scan.seed = seed;
    bone::Bone fragment;
    fragment.distance = plan::scan_solid(solid, placement, scan);
    fragment.density = density_of(bone, fragment.distance, placement.inverse());
    fragment.points = contact::sample_surface(fragment.distance, {.spacing = settings.spacing});
    plan::paint_fracture(fragment.points, map, placement.inverse());
    fragment.provenance = {{"source", fmt::format("simulated scan of a fragment of {}", bone.name)},
                           {"frame", "LPS"},
                           {"hu", "simulated"}};
    return fragment;
}

}  // namespace

void break_and_scan(const bone::Bone& bone, const FractureSettings& settings,
                    const std::function<void(ScannedFragment fragment)>& take) {
    plan::BreakOptions options;
    options.pieces = settings.pieces;
    options.seed = settings.seed;
    options.roughness = settings.roughness;
    options.chips = settings.chips;
    options.kerf = settings.kerf;
    std::vector<volume::Grid> solids = plan::break_bone(bone.distance, options);
    std::ranges::stable_sort(solids, std::ranges::greater{}, volume_of_solid);
    const contact::Voxmap map = contact::make_voxmap(bone.distance);
    const Vec3 centre = middle_of(bone.distance);
    const std::size_t left = solids.size() - static_cast<std::size_t>(settings.missing);
    for (std::size_t n = 0; n < left; ++n) {
        // The largest fragment is not moved: it is the reference for the others.
        const Pose placement = n == 0 ? Pose{} : displaced(solids[n], centre, settings, settings.seed * 1009 + n);
        take({scan_fragment(bone, map, solids[n], placement, settings, settings.seed * 2003 + n), placement.inverse(),
              volume_of_solid(solids[n])});
    }
}

}  // namespace tactus::analysis
