// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_repaint.hpp"

#include "assets/plan/paint_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/registration/registration.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

namespace {

constexpr double max_off = 0.5e-3;  // m: meshes become bones of voxels up to this size
constexpr double max_share = 0.02;  // of the points; sharp edges are rounded by voxels

double voxel_of(const CaseFragment& f) {
    const Vec3& h = f.map.grid.spacing;
    return std::max({h.x, h.y, h.z});
}

/// Share of the points of `a` that do not lie on `b`.
double share_off(const CaseFragment& a, const CaseFragment& b) {
    const fit::RegistrationTarget surface(b.bone.points);
    const double limit = std::max({max_off, voxel_of(a), voxel_of(b)});
    std::size_t off = 0;
    for (const contact::SurfacePoint& p : a.bone.points)
        if (surface.distance(p.position) > limit) ++off;
    return static_cast<double>(off) / static_cast<double>(a.bone.points.size());
}

/// Whether the fragment's file is there with the bytes that the plan knows.
bool is_as_planned(const plan::PlanFragment& fragment, const std::filesystem::path& folder) {
    plan::CasePlan alone;
    alone.fragments.push_back(fragment);
    return plan::changed_files(alone, folder).empty();
}

}  // namespace

Repainted repaint(const plan::CasePlan& plan, const std::filesystem::path& folder, int fragment,
                  const std::filesystem::path& file, bool is_same_bone) {
    const plan::PlanFragment now = plan::fragments_of(plan)[static_cast<std::size_t>(fragment)];
    plan::CasePlan taken;
    plan::add_fragment(taken, now.name, file, folder, now.colour);
    const CaseFragment bone = load_fragment(taken.fragments.front(), folder);
    Repainted made{plan::painted_faces(bone.bone.points).size(), is_as_planned(now, folder), {}};
    if (made.is_compared) {
        const CaseFragment before = load_fragment(now, folder);
        const double off = std::max(share_off(bone, before), share_off(before, bone));
        if (off > max_share)
            throw Error(
                fmt::format("{}: {:.0f} % of its surface does not lie on that of '{}': it is another bone, or "
                            "in another place; make a plan of it with 'tactus plan new'",
                            file.string(), off * 100.0, now.name));
    } else if (!is_same_bone) {
        throw Error(
            fmt::format("fragment '{}': the file that the plan was made of is gone or has changed, so that "
                        "nothing shows whether {} is the same bone; say --same-bone if only its paint differs",
                        now.name, file.string()));
    }
    made.step.kind = plan::StepKind::repaint;
    made.step.by = "command";
    made.step.fragments.push_back(fragment);
    made.step.painted = plan::HashedFile{taken.fragments.front().file, taken.fragments.front().hash};
    return made;
}

}  // namespace tactus::analysis
