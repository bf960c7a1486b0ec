// SPDX-License-Identifier: Apache-2.0
#include "tools/study/bones/fracture_surface.hpp"

#include "assets/cases/paint_file.hpp"
#include "assets/cases/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/intact_side.hpp"

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

bool is_painted(const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; }

/// Labels what faces at least one of the fragments.
void propose_by_facing(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings,
                       double least_area) {
    cases::FacingOptions options;
    options.reach = settings.reach;
    options.least_area = least_area;
    std::vector<char> faces(points.size(), 0);
    for (const std::filesystem::path& other : settings.facing) {
        cases::propose_facing(points, points_of_fragment(other), options);
        for (std::size_t n = 0; n < points.size(); ++n) faces[n] = faces[n] || is_painted(points[n]);
    }
    for (std::size_t n = 0; n < points.size(); ++n)
        points[n].label = faces[n] ? contact::surface_label::fracture : contact::surface_label::none;
}

/// Labels the points proposed by the selected methods. A patch may fall into faces: small ones are left out, too.
std::optional<LaidIntact> propose(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings) {
    std::optional<LaidIntact> laid;
    double least_area = settings.least_area.value_or(20e-6);
    if (!settings.intact.empty()) {
        least_area = settings.least_area.value_or(cases::IntactOptions{}.least_area);
        laid = propose_by_intact(points, settings);
        std::vector<contact::SurfacePoint> others;
        for (const std::filesystem::path& other : settings.facing)
            for (const contact::SurfacePoint& p : points_of_fragment(other)) others.push_back(p);
        if (!settings.facing.empty()) cases::keep_patches_near(points, others, settings.reach);
    } else if (!settings.facing.empty()) {
        propose_by_facing(points, settings, least_area);
    } else {
        cases::ProposalOptions options;
        options.roughness = settings.roughness;
        options.least_area = least_area;
        cases::propose_fracture(points, options);
    }
    cases::drop_small_faces(points, least_area);
    return laid;
}

}  // namespace

FractureSurface propose_fracture_surface(const FractureSurfaceSettings& settings) {
    FractureSurface out{bone_of_file(settings.bone), std::nullopt};
    std::vector<contact::SurfacePoint>& points = out.bone.points;
    if (points.empty()) points = contact::sample_surface(out.bone.distance, {});
    const bool has_paint = std::ranges::any_of(points, is_painted);
    const bool is_asked = !settings.facing.empty() || !settings.intact.empty();
    const std::vector<contact::SurfacePoint> before = points;
    if (!settings.keep || !has_paint || is_asked) out.intact = propose(points, settings);
    if (settings.keep && has_paint)
        for (std::size_t n = 0; n < points.size(); ++n)
            if (is_painted(before[n])) points[n].label = contact::surface_label::fracture;
    if (!settings.paint.empty()) cases::paint_from_file(points, settings.paint, settings.correct);
    return out;
}

}  // namespace tactus::study
