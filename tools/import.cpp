// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"
#include "tools/terminal.hpp"
#include "tools/verbs.hpp"
#include "tools/workers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tactus {

int import_verb(const ImportChoice& choice) {
    ImportSummary s;
    LiveLine line;
    ImportOptions options = choice;
    options.run = on_threads();
    const Bone bone = import_bone(
        options,
        [&line](double part, std::string_view doing) { line.show(fmt::format("{:3.0f} %  {}", 100.0 * part, doing)); },
        &s);
    line.clear();
    save_bone(bone, choice.out);
    if (choice.json) {
        const nlohmann::ordered_json json{
            {"frame", s.frame},
            {"hu", s.hu},
            {"voxel_mm", s.voxel_mm},
            {"size", s.size},
            {"bone_volume_mm3", s.bone_volume_mm3},
            {"surface_area_mm2", s.surface_area_mm2},
            {"density", {{"min", s.density.min}, {"max", s.density.max}, {"mean", s.density.mean}}},
            {"components", s.components},
            {"file", choice.out.string()}};
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print(
        "{}: {} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm\n  {:.0f} mm³ of bone, {:.0f} mm² of surface, {} "
        "component{} found\n"
        "  density {:.0f} … {:.0f}, mean {:.0f} kg/m³ ({})\n",
        choice.out.string(), s.size[0], s.size[1], s.size[2], s.voxel_mm[0], s.voxel_mm[1], s.voxel_mm[2],
        s.bone_volume_mm3, s.surface_area_mm2, s.components, s.components == 1 ? "" : "s", s.density.min, s.density.max,
        s.density.mean, s.hu);
    return done;
}

}  // namespace tactus
