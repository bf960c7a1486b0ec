// SPDX-License-Identifier: Apache-2.0
// Breaks a bone: fragments as a scan shows them, displaced, and where they belong.
#include "assets/file/whole_file.hpp"
#include "assets/fracture/break_bone.hpp"
#include "assets/fracture/paint.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/operator/hand.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/snap_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <numbers>

namespace tactus {

namespace {

/// As {position_mm, quaternion_wxyz}.
nlohmann::ordered_json pose_json(const Pose& pose) {
    const PoseNumbers numbers = numbers_of(pose);
    return {{"position_mm", numbers.position_mm}, {"quaternion_wxyz", numbers.quaternion_wxyz}};
}

double volume_of_solid(const Grid& solid) {
    const auto inside = std::ranges::count_if(solid.values, [](float d) { return d < 0.0f; });
    return static_cast<double>(inside) * solid.spacing.x * solid.spacing.y * solid.spacing.z;
}

Vec3 middle_of(const Grid& solid) {
    return solid.origin + 0.5 * Vec3(solid.size[0] - 1, solid.size[1] - 1, solid.size[2] - 1) * solid.spacing;
}

/// Where a fragment lies in its file, as a motion of the unbroken bone: away from `centre` and a little to the side, and
/// turned about its own middle.
Pose displaced(const Grid& solid, const Vec3& centre, const FractureChoice& choice, std::uint64_t seed) {
    const Random random{seed};
    const auto direction = [&](std::uint64_t n) {
        return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
    };
    const Vec3 middle = middle_of(solid), away = middle - centre;
    const Vec3 outwards = glm::length(away) > 1e-6 ? glm::normalize(away) : direction(9);
    const Quat turn = rotation_by(choice.turn * std::numbers::pi / 180.0 * direction(0));
    const Vec3 to = middle + 1e-3 * choice.spread * glm::normalize(outwards + 0.5 * direction(3));
    return {to - turn * middle, turn};
}

/// The density of the unbroken bone where the fragment has bone.
Grid density_of(const Bone& bone, const Grid& distance, const Pose& into_bone) {
    const Voxmap map = make_voxmap(bone.density);
    Grid density = distance;
    for (int k = 0; k < density.size[2]; ++k)
        for (int j = 0; j < density.size[1]; ++j)
            for (int i = 0; i < density.size[0]; ++i) {
                const Sample here = map.sample(into_bone.apply(density.position(i, j, k)));
                density.at(i, j, k) = density.at(i, j, k) < 0.0f && here.inside ? static_cast<float>(here.value) : 0.0f;
            }
    return density;
}

Bone scan_fragment(const Bone& bone, const Voxmap& map, const Grid& solid, const Pose& placement,
                   const FractureChoice& choice, std::uint64_t seed) {
    ScanOptions scan;
    scan.voxel = Vec3(choice.voxel * 1e-3);
    scan.blur = choice.blur * 1e-3;
    scan.noise = choice.noise * 1e-2;
    scan.seed = seed;
    Bone fragment;
    fragment.distance = scan_solid(solid, placement, scan);
    fragment.density = density_of(bone, fragment.distance, placement.inverse());
    fragment.points = sample_surface(fragment.distance, {.spacing = choice.spacing * 1e-3});
    paint_fracture(fragment.points, map, placement.inverse());
    fragment.provenance = {{"source", fmt::format("simulated scan of a fragment of {}", bone.name)},
                           {"frame", "LPS"},
                           {"hu", "simulated"}};
    return fragment;
}

}  // namespace

int fracture_verb(const FractureChoice& choice) {
    if (choice.missing > choice.pieces - 2) throw Error("at least two pieces must be left; lower --missing");
    const Bone bone = bone_of_file(choice.bone);
    BreakOptions options;
    options.pieces = choice.pieces;
    options.seed = choice.seed;
    options.roughness = choice.roughness * 1e-3;
    options.chips = choice.chips * 1e-2;
    options.kerf = choice.kerf * 1e-3;
    std::vector<Grid> solids = break_bone(bone.distance, options);
    std::ranges::stable_sort(solids, std::ranges::greater{}, volume_of_solid);
    make_output_folder(choice.out);
    const Voxmap map = make_voxmap(bone.distance);
    const Vec3 centre = middle_of(bone.distance);
    using Json = nlohmann::ordered_json;
    Json truth{{"bone", bone.name},
               {"seed", choice.seed},
               {"unit", "mm"},
               {"frame", "LPS"},
               {"chips_percent", choice.chips},
               {"kerf_mm", choice.kerf},
               {"pose", "p_bone = R p_fragment + t"},
               {"fragments", Json::array()},
               {"missing", choice.missing}};
    const std::size_t left = solids.size() - static_cast<std::size_t>(choice.missing);
    for (std::size_t n = 0; n < left; ++n) {
        const std::string name = fmt::format("fragment_{:02}", n + 1);
        // The largest one stays: it is what the others are brought to.
        const Pose placement = n == 0 ? Pose{} : displaced(solids[n], centre, choice, choice.seed * 1009 + n);
        Bone fragment = scan_fragment(bone, map, solids[n], placement, choice, choice.seed * 2003 + n);
        fragment.name = name;
        save_bone(fragment, choice.out / (name + ".vdb"));
        const ColouredSurface surface{export_surface(fragment.distance), fragment.colour};
        write_mesh({&surface, 1}, choice.out / (name + ".stl"));
        truth["fragments"].push_back({{"fragment", name},
                                      {"pose", pose_json(placement.inverse())},
                                      {"volume_mm3", volume_of_solid(solids[n]) * 1e9},
                                      {"files", {name + ".vdb", name + ".stl"}}});
        if (!choice.json) fmt::print("{}: {:.0f} mm³\n", name, volume_of_solid(solids[n]) * 1e9);
    }
    write_whole_file(choice.out / "truth.json", truth.dump(2) + "\n");
    if (choice.json) fmt::print("{}\n", truth.dump(2));
    return done;
}

}  // namespace tactus
