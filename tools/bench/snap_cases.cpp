// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/snap_cases.hpp"

#include "assets/plan/break_bone.hpp"
#include "assets/plan/paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fit.hpp"

#include <glm/geometric.hpp>

#include <cmath>

namespace tactus::bench {

namespace {

Quat any_turn(const Random& random, std::uint64_t first) {
    return glm::normalize(
        Quat(random.normal(first), random.normal(first + 1), random.normal(first + 2), random.normal(first + 3)));
}

Vec3 any_direction(const Random& random, std::uint64_t first) {
    return glm::normalize(Vec3(random.normal(first), random.normal(first + 1), random.normal(first + 2)));
}

struct Piece {
    std::vector<contact::SurfacePoint> points;
    fit::FitSurface surface;
    Pose placement;
};

Piece scan_piece(const volume::Grid& solid, const contact::Voxmap& bone, const FractureKind& kind, std::uint64_t seed) {
    const Random random{seed};
    Piece piece;
    piece.placement.orientation = any_turn(random, 0);
    const volume::Grid distance = plan::scan_solid(solid, piece.placement, {.noise = kind.noise, .seed = seed});
    piece.points = contact::sample_surface(distance, {.spacing = 0.42e-3});
    plan::paint_fracture(piece.points, bone, piece.placement.inverse(), kind.spill);
    piece.surface = fit::make_fit_surface(piece.points, distance);
    return piece;
}

}  // namespace

const std::vector<FractureCase>& fracture_cases() {
    static const std::vector<FractureCase> cases{
        {{"clean", 0.8e-3, 0.0, 0.0, 0.03}, {{4, 12}, {8, 20}, {10, 30}}},
        {{"chipped25", 0.8e-3, 0.25, 0.0, 0.03}, {{4, 12}, {8, 20}, {10, 30}, {12, 45}}},
        {{"chipped30", 0.8e-3, 0.30, 0.0, 0.03}, {{4, 12}, {8, 20}}},
        {{"spilled", 0.8e-3, 0.0, 2e-3, 0.03}, {{4, 12}, {8, 20}, {10, 30}, {12, 45}}},
        {{"both", 0.8e-3, 0.25, 2e-3, 0.03}, {{4, 12}, {8, 20}, {10, 30}, {12, 45}}},
        {{"fine", 0.4e-3, 0.0, 0.0, 0.06}, {{4, 12}}},
    };
    return cases;
}

FracturePair make_fracture_pair(const volume::Grid& bone, const FractureKind& kind, std::uint64_t seed) {
    const std::vector<volume::Grid> solids =
        plan::break_bone(bone, {.seed = seed, .roughness = kind.roughness, .chips = kind.chips});
    const contact::Voxmap map = contact::make_voxmap(bone);
    Piece moving = scan_piece(solids[0], map, kind, 2 * seed), fixed = scan_piece(solids[1], map, kind, 2 * seed + 1);
    return {std::move(moving.points), std::move(moving.surface), std::move(fixed.surface),
            fixed.placement * moving.placement.inverse()};
}

double FracturePair::error(const Pose& pose) const {
    double sum = 0.0;
    for (const contact::SurfacePoint& p : moving_points) {
        const Vec3 off = pose.apply(p.position) - truth.apply(p.position);
        sum += glm::dot(off, off);
    }
    return std::sqrt(sum / static_cast<double>(moving_points.size()));
}

Pose start_beside(const FracturePair& pair, double offset, double angle, bool pushed, std::uint64_t seed) {
    const Random random{seed};
    Pose centres = fit::between_centres(pair.moving, pair.fixed, pair.truth);
    centres.position += offset * any_direction(random, 0);
    centres.orientation = glm::normalize(rotation_by(angle * any_direction(random, 3)) * centres.orientation);
    for (int n = 0; pushed && n < 400; ++n) {
        double deepest = 0.0;
        for (const Vec3& p : pair.moving.position) {
            const volume::Sample here = pair.fixed.field.sample(centres.apply(p));
            if (here.inside) deepest = std::min(deepest, here.value);
        }
        if (deepest > -0.05e-3) break;
        centres.position += 0.1e-3 * glm::normalize(pair.fixed.mean_normal);
    }
    return fit::between_bodies(pair.moving, pair.fixed, centres);
}

}  // namespace tactus::bench
