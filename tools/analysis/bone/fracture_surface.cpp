// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/fracture_surface.hpp"

#include "assets/plan/paint_file.hpp"
#include "assets/plan/propose_paint.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/bone/kept_numbers.hpp"
#include "tools/analysis/bone/kept_points.hpp"

#include <algorithm>

namespace tactus::analysis {

namespace {

// To be raised with every change of code that changes a registration or what broken_inside finds.
constexpr int algorithm = 2;

/// The registration of the unbroken bone: kept apart, because it is the same for all fragments of a case that name the
/// same main one, and however they are painted.
std::vector<double> intact_on_main(IntactBone& intact, const FractureSurfaceSettings& settings, std::string& note) {
    const std::filesystem::path& main = settings.main.empty() ? settings.bone : settings.main;
    plan::ResultKey key("unbroken bone on a fragment", algorithm);
    key.add_file(settings.intact).add_file(main).add("mirror", settings.mirror ? 1.0 : 0.0);
    return plan::result_of(key, intact_numbers, note,
                           [&] { return intact.numbers_on(points_of_fragment(main, note)); });
}

/// The registrations and the numbers of the broken points.
std::vector<double> broken_by_intact(const std::vector<contact::SurfacePoint>& points,
                                     const FractureSurfaceSettings& settings, std::string& note) {
    IntactBone intact(settings.intact, settings.mirror);
    NumberReader known(intact_on_main(intact, settings, note));
    const fit::Registration on_main = known.registration();
    const fit::RegistrationTarget target(intact.laid(known));
    if (note.empty()) note = intact.note();
    std::vector<double> numbers;
    add_registration(numbers, on_main);
    Pose place;
    if (!settings.main.empty()) {
        fit::RegistrationSettings nearby;
        nearby.widest = 10e-3;
        const fit::Registration own = fit::register_surface(points, target, {}, nearby);
        add_registration(numbers, own);
        place = own.pose;
    }
    const std::vector<std::uint8_t> broken = plan::broken_inside(points, target, place);
    for (std::size_t n = 0; n < points.size(); ++n)
        if (broken[n]) numbers.push_back(static_cast<double>(n));
    return numbers;
}

/// Labels the points inside the unbroken bone; returns its registration to the fragments.
LaidIntact propose_by_intact(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings,
                             double min_area, std::string& note) {
    plan::ResultKey key("points inside of the unbroken bone", algorithm);
    key.add_file(settings.bone).add_file(settings.intact);
    if (!settings.main.empty()) key.add_file(settings.main);
    key.add("mirror", settings.mirror ? 1.0 : 0.0).add("points", static_cast<double>(points.size()));
    NumberReader read(
        plan::result_of(key, std::nullopt, note, [&] { return broken_by_intact(points, settings, note); }));
    LaidIntact laid{read.registration(), std::nullopt};
    if (!settings.main.empty()) laid.on_bone = read.registration();
    std::vector<std::uint8_t> broken(points.size(), 0);
    while (!read.is_at_end())
        if (const double n = read.next(); n >= 0.0 && n < static_cast<double>(points.size()))
            broken[static_cast<std::size_t>(n)] = 1;
    plan::label_broken(points, broken, min_area);
    return laid;
}

bool is_painted(const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; }

/// Labels what faces at least one of the fragments.
void propose_by_facing(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings,
                       double min_area, std::string& note) {
    plan::FacingOptions options;
    options.reach = settings.reach;
    options.min_area = min_area;
    std::vector<char> faces(points.size(), 0);
    for (const std::filesystem::path& other : settings.facing) {
        plan::propose_facing(points, points_of_fragment(other, note), options);
        for (std::size_t n = 0; n < points.size(); ++n) faces[n] = faces[n] || is_painted(points[n]);
    }
    contact::remove_paint(points);
    for (std::size_t n = 0; n < points.size(); ++n)
        if (faces[n]) points[n].label = contact::surface_label::fracture;
}

/// Labels the points proposed by the selected methods. A patch may fall into faces: small ones are left out, too.
std::optional<LaidIntact> propose(std::vector<contact::SurfacePoint>& points, const FractureSurfaceSettings& settings,
                                  std::string& note) {
    std::optional<LaidIntact> laid;
    double min_area = settings.min_area.value_or(20e-6);
    if (!settings.intact.empty()) {
        min_area = settings.min_area.value_or(plan::IntactOptions{}.min_area);
        laid = propose_by_intact(points, settings, min_area, note);
        std::vector<contact::SurfacePoint> others;
        for (const std::filesystem::path& other : settings.facing)
            for (const contact::SurfacePoint& p : points_of_fragment(other, note)) others.push_back(p);
        if (!settings.facing.empty()) plan::keep_patches_near(points, others, settings.reach);
    } else if (!settings.facing.empty()) {
        propose_by_facing(points, settings, min_area, note);
    } else {
        plan::ProposalOptions options;
        options.roughness = settings.roughness;
        options.min_area = min_area;
        plan::propose_fracture(points, options);
    }
    plan::drop_small_faces(points, min_area);
    return laid;
}

}  // namespace

FractureSurface propose_fracture_surface(const FractureSurfaceSettings& settings) {
    FractureSurface out;
    if (settings.whole) out.bone = bone_of_file(settings.bone);
    std::vector<contact::SurfacePoint>& points = out.bone.points;
    if (points.empty()) points = points_of_fragment(settings.bone, out.note);
    else contact::mark_as_scanned(points, out.bone.border);
    const bool has_paint = std::ranges::any_of(points, is_painted);
    const bool is_asked = !settings.facing.empty() || !settings.intact.empty();
    const std::vector<contact::SurfacePoint> before = points;
    if (!settings.keep || !has_paint || is_asked) out.intact = propose(points, settings, out.note);
    if (settings.keep && has_paint)
        for (std::size_t n = 0; n < points.size(); ++n)
            if (is_painted(before[n])) points[n].label = contact::surface_label::fracture;
    if (!settings.paint.empty()) plan::paint_from_file(points, settings.paint, settings.correct);
    out.as_scanned = contact::as_scanned_area(points);
    return out;
}

}  // namespace tactus::analysis
