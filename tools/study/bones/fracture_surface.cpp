// SPDX-License-Identifier: Apache-2.0
#include "tools/study/bones/fracture_surface.hpp"

#include "assets/cases/paint_file.hpp"
#include "assets/cases/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/intact_side.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::study {

namespace {

std::vector<contact::SurfacePoint> points_of_fragment(const std::filesystem::path& path) {
    const bone::Bone bone = bone_of_file(path);
    return bone.points.empty() ? contact::sample_surface(bone.distance, {}) : bone.points;
}

/// Labels the points inside the unbroken bone; returns its registration to the fragments.
LaidIntact propose_by_intact(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings) {
    const std::vector<contact::SurfacePoint> main = settings.main.empty() ? points : points_of_fragment(settings.main);
    const IntactSide intact = lay_intact_side(settings.intact, settings.mirror, main);
    const fit::RegistrationTarget target(intact.points);
    LaidIntact laid{intact.registration, std::nullopt};
    Pose place;
    if (!settings.main.empty()) {
        fit::RegistrationSettings nearby;
        nearby.widest = 10e-3;
        laid.on_bone = fit::register_surface(points, target, {}, nearby);
        place = laid.on_bone->pose;
    }
    cases::IntactOptions options;
    if (settings.least_area) options.least_area = *settings.least_area;
    cases::propose_inside(points, target, place, options);
    return laid;
}

/// Labels the points proposed by the selected methods.
std::optional<LaidIntact> propose(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings) {
    if (!settings.intact.empty()) {
        const LaidIntact laid = propose_by_intact(points, settings);
        if (!settings.facing.empty())
            cases::keep_patches_near(points, points_of_fragment(settings.facing), settings.reach);
        return laid;
    }
    if (!settings.facing.empty()) {
        cases::FacingOptions options;
        options.reach = settings.reach;
        if (settings.least_area) options.least_area = *settings.least_area;
        cases::propose_facing(points, points_of_fragment(settings.facing), options);
        return std::nullopt;
    }
    cases::ProposalOptions options;
    options.roughness = settings.roughness;
    if (settings.least_area) options.least_area = *settings.least_area;
    cases::propose_fracture(points, options);
    return std::nullopt;
}

}  // namespace

FractureSurface propose_fracture_surface(const FractureSurfaceSettings& settings) {
    FractureSurface out{bone_of_file(settings.bone), std::nullopt};
    std::vector<contact::SurfacePoint>& points = out.bone.points;
    if (points.empty()) points = contact::sample_surface(out.bone.distance, {});
    const bool has_paint = std::ranges::any_of(
        points, [](const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; });
    if (settings.keep && has_paint && !(settings.facing.empty() && settings.intact.empty()))
        throw Error(
            fmt::format("{}: with --keep the existing paint is used, so --facing and --intact have no effect; leave "
                        "out --keep for a new proposal",
                        settings.bone.string()));
    if (!settings.keep || !has_paint) out.intact = propose(points, settings);
    if (!settings.paint.empty()) cases::paint_from_file(points, settings.paint, settings.correct);
    return out;
}

}  // namespace tactus::study
