// SPDX-License-Identifier: Apache-2.0
#include "tools/render/section_grey.hpp"

#include "assets/plan/case_bones.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::render {

display::Legend::Scale section_scale() {
    return {"density at the cut, mg/cm3", fmt::format("{:g}", section_grey.black),
            fmt::format("{:g}", section_grey.white), Vec3(0.0), Vec3(1.0)};
}

bool DensityCopy::add_layer(const volume::BoneSnapshot& bone) {
    const volume::BrickLayout& layout = bone.layout();
    if (layers == 0) {
        grid = {layout.size, layout.origin, layout.spacing, {}};
        grid.values.assign(grid.count(), 0.0f);
    }
    if (layers == layout.bricks[2]) return true;
    const int bz = layers++;
    for (int by = 0; by < layout.bricks[1]; ++by)
        for (int bx = 0; bx < layout.bricks[0]; ++bx) {
            const float* const brick = bone.root->density[static_cast<std::size_t>(layout.brick_index(bx, by, bz))];
            if (!brick) continue;
            const std::array<int, 3> first{bx * volume::brick_cells, by * volume::brick_cells,
                                           bz * volume::brick_cells};
            const auto past = [&](std::size_t axis) {
                return std::min(volume::brick_side, layout.size[axis] - first[axis]);
            };
            for (int z = 0; z < past(2); ++z)
                for (int y = 0; y < past(1); ++y)
                    for (int x = 0; x < past(0); ++x)
                        grid.at(first[0] + x, first[1] + y, first[2] + z) =
                            brick[volume::BrickLayout::sample_index(x, y, z)];
        }
    return layers == layout.bricks[2];
}

std::vector<volume::Grid> read_densities(const std::filesystem::path& file) {
    std::vector<volume::Grid> grids;
    try {
        if (file.extension() != ".json") {
            grids.push_back(std::move(plan::bone_from_file(file).density));
            return grids;
        }
        for (const plan::PlanFragment& fragment : plan::fragments_of(plan::load_case_plan(file)))
            grids.push_back(std::move(plan::bone_from_file(plan::file_of(fragment.file, file.parent_path())).density));
    } catch (const Error&) {
        grids.clear();  // the run says what is wrong
    }
    return grids;
}

}  // namespace tactus::render
