// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/case_bones.hpp"

#include "assets/bone/import.hpp"
#include "assets/fracture/propose_paint.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus {

CaseBones load_case(const std::filesystem::path& path) {
    CaseBones made;
    made.plan = load_case_plan(path);
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (const auto problems = changed_files(made.plan, folder); !problems.empty())
        throw Error(fmt::format("{}: {}", path.string(), problems.front()));
    for (PlanFragment& fragment : made.plan.fragments) {
        const std::filesystem::path file = file_of(fragment.file, folder);
        fragment.file = file.string();
        try {
            ImportOptions options;
            options.input = file;
            Bone bone = file_of_bone(file).extension() == ".vdb" ? load_bone(file) : import_bone(options);
            if (bone.points.empty()) bone.points = sample_surface(bone.distance, {});
            if (bone.points.empty()) throw Error("has no surface");
            if (std::ranges::none_of(bone.points,
                                     [](const SurfacePoint& p) { return p.label == surface_label::fracture; }))
                propose_fracture(bone.points);
            made.bones.push_back(std::move(bone));
        } catch (const Error& error) {
            throw Error(fmt::format("fragment '{}': {}", fragment.name, error.what()));
        }
    }
    return made;
}

}  // namespace tactus
