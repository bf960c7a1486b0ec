// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/snapping.hpp"

#include "assets/bone/surface_points.hpp"
#include "assets/plan/paint_file.hpp"
#include "assets/plan/propose_paint.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/as_scanned.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>

namespace tactus::analysis {

namespace {

struct Fragment {
    bone::Bone bone;
    std::string paint;  ///< where it comes from
};

/// Paints what lies within the strokes' radius.
void brush(std::vector<contact::SurfacePoint>& points, const std::vector<Vec3>& strokes, double radius) {
    contact::remove_paint(points);
    for (const Vec3& centre : strokes)
        for (contact::SurfacePoint& p : points)
            if (p.label == contact::surface_label::none && glm::length(p.position - centre) <= radius)
                p.label = contact::surface_label::fracture;
}

Fragment painted_fragment(const std::filesystem::path& path, const FragmentPaint& paint) {
    Fragment fragment{bone_of_file(path), "file"};
    fragment.bone.points = bone::surface_points(fragment.bone, {}, on_threads());
    const auto is_painted = [](const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; };
    if (paint.file) {
        fragment.paint = paint.file->string();
        plan::paint_from_file(fragment.bone.points, fragment.paint);
    } else if (paint.radius) {
        brush(fragment.bone.points, paint.strokes, *paint.radius);
        fragment.paint = paint.name;
    } else if (std::ranges::none_of(fragment.bone.points, is_painted)) {
        plan::propose_fracture(fragment.bone.points);
        fragment.paint = "proposed";
    }
    return fragment;
}

std::vector<fit::FitSurface> faces_of(const Fragment& fragment, const std::filesystem::path& path) {
    try {
        return fit::make_fit_faces(fragment.bone.points, fragment.bone.distance);
    } catch (const Error& error) {
        const double left_out = contact::as_scanned_area(fragment.bone.points);
        throw Error(fmt::format(
            "{}: {}{}", path.string(), error.message(),
            left_out > 0.0
                ? fmt::format("; {:.0f} mm² are no fracture: they touch another fragment in the scan", left_out * 1e6)
                : ""));
    }
}

SnappedSide side_of(const Fragment& fragment, const std::vector<fit::FitSurface>& faces) {
    SnappedSide side{fragment.paint, {}, contact::as_scanned_area(fragment.bone.points)};
    for (const fit::FitSurface& face : faces) side.areas.push_back(face.area);
    return side;
}

}  // namespace

Snapped snap_files(const SnapSettings& settings) {
    const Fragment moving = painted_fragment(settings.moving, settings.moving_paint);
    const Fragment fixed = painted_fragment(settings.fixed, settings.fixed_paint);
    const std::vector<fit::FitSurface> moving_faces = faces_of(moving, settings.moving);
    const std::vector<fit::FitSurface> fixed_faces = faces_of(fixed, settings.fixed);
    Snapped out;
    const auto begin = std::chrono::steady_clock::now();
    out.fit = fit::find_fit(moving_faces, fixed_faces, settings.start, settings.mode,
                            settings.kerf.value_or(0.0));
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const bool has_place = out.fit.verdict == fit::FitVerdict::fit || out.fit.verdict == fit::FitVerdict::uncertain;
    out.as_scanned =
        has_place && fit::is_as_scanned(moving.bone.points, out.fit.pose, contact::make_voxmap(fixed.bone.distance));
    if (out.as_scanned) out.fit.verdict = fit::FitVerdict::ambiguous;
    else if (has_place) {
        out.kerf = fit::check_kerf({moving.bone.points, &moving_faces[out.fit.moving_face]},
                                   {fixed.bone.points, &fixed_faces[out.fit.fixed_face]}, out.fit.pose, settings.kerf);
        out.fit.verdict = fit::include_kerf(*out.kerf, out.fit.verdict, out.fit.bound);
    }
    out.moved = motion_between(settings.start, out.fit.pose, middle_of(moving.bone.points));
    out.moving = side_of(moving, moving_faces);
    out.fixed = side_of(fixed, fixed_faces);
    return out;
}

}  // namespace tactus::analysis
