// SPDX-License-Identifier: Apache-2.0
#include "assets/cases/case_bones.hpp"

#include "assets/bone/import.hpp"
#include "assets/cases/plan_file.hpp"
#include "assets/cases/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::cases {

bone::Bone bone_from_file(const std::filesystem::path& path, const RunJobs& run) {
    if (bone::file_of_bone(path).extension() == ".vdb") return bone::load_bone(path);
    bone::ImportOptions options;
    options.input = path;
    options.run = run;
    return bone::import_bone(options);
}

FragmentBone fragment_bone(const PlanFragment& fragment, const std::filesystem::path& folder, Paint paint,
                           const RunJobs& run) {
    FragmentBone loaded;
    try {
        loaded.bone = bone_from_file(file_of(fragment.file, folder), run);
        std::vector<contact::SurfacePoint>& points = loaded.bone.points;
        if (points.empty()) points = contact::sample_surface(loaded.bone.distance, {});
        if (points.empty()) throw Error("has no surface");
        loaded.was_painted = std::ranges::any_of(
            points, [](const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; });
        if (!loaded.was_painted && paint == Paint::or_proposed) propose_fracture(points);
    } catch (const Error& error) {
        const bool is_bone = bone::file_of_bone(fragment.file).extension() == ".vdb";
        throw Error(fmt::format("fragment '{}': {}{}", fragment.name, error.what(),
                                is_bone ? "" : "; or convert it with 'tactus import' and use the .vdb"));
    }
    return loaded;
}

void check_files(const CasePlan& plan, const std::filesystem::path& folder) {
    const auto problems = changed_files(plan, folder);
    if (!problems.empty())
        throw Error(fmt::format("{}{}; put the file back, or make a plan of the new one", problems.front(),
                                problems.size() > 1 ? fmt::format(" (and {} more)", problems.size() - 1) : ""));
}

CaseBones load_case(const std::filesystem::path& path) {
    CaseBones made;
    made.plan = load_case_plan(path);
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    try {
        check_files(made.plan, folder);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.message()));
    }
    for (PlanFragment& fragment : made.plan.fragments) {
        made.bones.push_back(fragment_bone(fragment, folder, Paint::or_proposed).bone);
        fragment.file = file_of(fragment.file, folder).string();
    }
    for (PlanStep& step : made.plan.steps)
        if (step.mirror) step.mirror->file = file_of(step.mirror->file, folder).string();
    return made;
}

}  // namespace tactus::cases
