// SPDX-License-Identifier: Apache-2.0
#include "assets/library/broken_mandible.hpp"

#include "assets/bone/labels.hpp"
#include "assets/library/hand_script.hpp"
#include "assets/plan/break_bone.hpp"
#include "assets/plan/paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/faces.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace tactus::library {

namespace {

Vec3 direction(const Random& random, std::uint64_t n) {
    return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
}

Vec3 middle_of(const std::vector<contact::SurfacePoint>& points) {
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    return middle;
}

/// Rotated about its centre and translated.
Pose about(const Vec3& middle, const Vec3& translation, const Vec3& rotation) {
    const Quat q = rotation_by(rotation);
    return {middle + translation - q * middle, q};
}

std::size_t samples_inside(const volume::Grid& solid) {
    return static_cast<std::size_t>(std::ranges::count_if(solid.values, [](float d) { return d < 0.0f; }));
}

/// A painted point in place, with its piece and face.
struct FacePoint {
    Vec3 position, normal;
    std::size_t face;
};

/// The painted points of each piece in place. Faces are numbered consecutively over all pieces.
std::vector<std::vector<FacePoint>> paint_of(const BrokenMandible& broken) {
    std::vector<std::vector<FacePoint>> paint(broken.fragments.size());
    std::size_t faces = 0;
    for (std::size_t n = 0; n < paint.size(); ++n)
        for (const auto& face : fit::split_faces(broken.fragments[n].points)) {
            for (const std::size_t i : face) {
                const contact::SurfacePoint& p = broken.fragments[n].points[i];
                paint[n].push_back({broken.truth[n].apply(p.position), broken.truth[n].rotate(p.normal), faces});
            }
            ++faces;
        }
    return paint;
}

/// Number of points of a piece's best face that touch placed pieces; 0 when no face touches. A face that is covered
/// completely defines the position better than a larger one that is covered in part.
double worth_of(const std::vector<FacePoint>& piece, const std::vector<FacePoint>& standing,
                const geometry::PointTree& tree, double kerf) {
    struct Covered {
        std::size_t near = 0, touching = 0;
    };
    constexpr std::size_t min_touching = 40;  // smallest face that the matcher accepts, points
    std::map<std::pair<std::size_t, std::size_t>, Covered> covered;
    for (const FacePoint& p : piece) {
        const FacePoint& other = standing[tree.nearest(p.position)];
        const double distance = glm::length(p.position - other.position) - kerf;
        if (!(distance < 0.7e-3 && glm::dot(p.normal, other.normal) < -0.6)) continue;
        Covered& pair = covered[{p.face, other.face}];
        ++pair.near;
        pair.touching += distance < 0.4e-3;
    }
    double most = 0.0;
    for (const auto& [pair, points] : covered) {
        if (points.touching < min_touching) continue;
        const auto whole = static_cast<double>(std::ranges::count(piece, pair.first, &FacePoint::face));
        most = std::max(most, static_cast<double>(points.near * points.near) / whole);
    }
    return most;
}

/// Order of assembly: each next piece has the largest possible face against `first` or an earlier piece. Ends when no
/// other piece touches them.
std::vector<std::size_t> order_from(std::size_t first, const std::vector<std::vector<FacePoint>>& paint, double kerf,
                                    std::vector<char>& done) {
    std::vector<FacePoint> standing = paint[first];
    std::vector<std::size_t> order;
    done[first] = 1;
    for (;;) {
        std::vector<Vec3> places;
        for (const FacePoint& p : standing) places.push_back(p.position);
        const geometry::PointTree tree(places);
        std::size_t best = first;
        double most = 0.0;
        for (std::size_t n = 0; n < paint.size() && !standing.empty(); ++n) {
            if (done[n]) continue;
            if (const double worth = worth_of(paint[n], standing, tree, kerf); worth > most) best = n, most = worth;
        }
        if (best == first) return order;
        done[best] = 1;
        order.push_back(best);
        standing.insert(standing.end(), paint[best].begin(), paint[best].end());
    }
}

/// The direction in front of the bone from which a piece reaches its place with the most clearance to placed pieces.
Vec3 way_in(const std::vector<contact::SurfacePoint>& points, const Pose& truth, const geometry::PointTree& tree,
            const std::vector<Vec3>& standing) {
    Vec3 best(0.0, -1.0, 0.0);
    double widest = -1.0;
    for (int side = 0; side < 18; ++side) {
        // Rows at 0, 45 and 80 degrees from straight ahead.
        const double lean = side == 0 ? 0.0 : side < 9 ? 0.8 : 1.4, round = 2.0 * std::numbers::pi * side / 8.0;
        const Vec3 d(std::sin(lean) * std::cos(round), -std::cos(lean), std::sin(lean) * std::sin(round));
        double room = 1.0;
        for (const double away : {6e-3, 10e-3, 15e-3, 22e-3, 30e-3, 40e-3})
            for (std::size_t n = 0; n < points.size(); n += points.size() / 150 + 1) {
                const Vec3 x = truth.apply(points[n].position) + away * d;
                const double clear = glm::length(x - standing[tree.nearest(x)]) / away;
                room = std::min(room, clear);
            }
        if (room > widest) widest = room, best = d;
    }
    return best;
}

/// Snap for two searches of the matcher, settle, and release before the piece is pulled again.
void snap_and_settle(HandScript& script) {
    script.stay(0.05, "trigger second");
    script.stay(0.95, "trigger second third");
    script.stay(0.25, "second third");
    script.stay(0.10, "");
}

std::string script_of(const BrokenMandible& broken, const BrokenMandibleOptions& options, double& seconds) {
    HandScript script;
    const auto& order = broken.order;
    std::vector<Vec3> standing;
    const auto stand = [&](std::size_t n) {
        for (const contact::SurfacePoint& p : broken.fragments[n].points)
            standing.push_back(broken.truth[n].apply(p.position));
    };
    stand(0);
    script.go(0.0, {middle_of(broken.fragments[order[0]].points), {1.0, 0.0, 0.0, 0.0}}, "");
    for (const std::size_t n : order) {
        const Vec3 middle = middle_of(broken.fragments[n].points);
        const Pose grip{middle, {1.0, 0.0, 0.0, 0.0}};
        const Vec3 place = broken.truth[n].apply(middle);
        const Pose& beside = broken.beside[n];
        script.go(0.6, grip, "");
        script.stay(0.1, "trigger");
        script.stay(0.1, "trigger");
        const Vec3 translation =
            way_in(broken.fragments[n].points, broken.truth[n], geometry::PointTree(standing), standing);
        stand(n);
        // Lift the piece, move it in front of its place, and insert it.
        script.go(0.4, about(middle, Vec3(0.0, 25e-3, 0.0), Vec3(0.0)) * grip, "trigger");
        script.go(0.8, about(place, 40e-3 * translation, Vec3(0.0)) * beside * grip, "trigger");
        script.go(0.6, beside * grip, "trigger");
        script.stay(0.2, "trigger");
        snap_and_settle(script);
    }
    // Settle each piece twice more, now with all neighbours in place. The hand grasps a piece only near its position.
    for (const std::uint64_t pass : {6u, 9u})
        for (const std::size_t n : order) {
            const Random random{options.seed * 7919 + n};
            const Vec3 place = broken.truth[n].apply(middle_of(broken.fragments[n].points));
            script.go(0.5, {place + 1.5e-3 * direction(random, pass), {1.0, 0.0, 0.0, 0.0}}, "");
            script.stay(0.1, "trigger");
            snap_and_settle(script);
        }
    seconds = script.time();
    return script.text();
}

}  // namespace

BrokenMandible break_mandible(const bone::Bone& bone, const BrokenMandibleOptions& options) {
    std::vector<volume::Grid> solids = plan::break_bone(
        bone.distance, {.pieces = options.pieces, .seed = options.seed, .chips = options.chips, .kerf = options.kerf});
    std::ranges::stable_sort(solids, std::ranges::greater{}, samples_inside);
    const contact::Voxmap whole = contact::make_voxmap(bone.distance);
    const Vec3 centre =
        bone.distance.position(bone.distance.size[0] / 2, bone.distance.size[1] / 2, bone.distance.size[2] / 2);
    if (options.missing < 0 || options.missing > options.pieces - 2) throw Error("at least two pieces must be left");
    solids.resize(solids.size() - static_cast<std::size_t>(options.missing));
    BrokenMandible broken;
    for (std::size_t n = 0; n < solids.size(); ++n) {
        const Random random{options.seed * 1009 + n};
        const volume::Grid& solid = solids[n];
        const Vec3 middle = solid.position(solid.size[0] / 2, solid.size[1] / 2, solid.size[2] / 2);
        // The pieces lie in rows in front of the bone.
        const Vec3 to = centre + Vec3(36e-3 * (static_cast<double>(n % 4) - 1.5), -options.distance,
                                      36e-3 * (static_cast<double>(n / 4) - 1.0));
        const Pose placement = n == 0 ? Pose{} : about(middle, to - middle, options.rotation * direction(random, 0));
        bone::Bone fragment;
        fragment.distance = plan::scan_solid(solid, placement, {.seed = options.seed * 2003 + n});
        fragment.density = fragment.distance;
        for (float& d : fragment.density.values) d = d < 0.0f ? 1200.0f : 0.0f;
        fragment.points = contact::sample_surface(fragment.distance, {.spacing = 0.42e-3});
        plan::paint_fracture(fragment.points, whole, placement.inverse());
        fragment.name = fmt::format("fragment_{:02}", n + 1);
        fragment.colour = bone::label_colour(static_cast<int>(n) + 1);
        fragment.provenance = {
            {"source", "simulated scan of a piece of the bundled mandible"}, {"frame", "LPS"}, {"hu", "simulated"}};
        broken.truth.push_back(placement.inverse());
        broken.fragments.push_back(std::move(fragment));
    }
    for (std::size_t n = 0; n < broken.fragments.size(); ++n) {
        const Random random{options.seed * 7919 + n};
        const Vec3 place = broken.truth[n].apply(middle_of(broken.fragments[n].points));
        broken.beside.push_back(
            about(place, options.error * direction(random, 0), options.error_turn * direction(random, 3)) *
            broken.truth[n]);
    }
    const auto paint = paint_of(broken);
    std::vector<char> done(paint.size(), 0);
    broken.order = order_from(0, paint, options.kerf, done);
    for (std::size_t n = 0; n < done.size(); ++n) {
        if (done[n]) continue;
        if (options.missing == 0) throw Error("a piece of the bundled mandible touches none of the others");
        broken.islands.push_back({n});
        for (const std::size_t other : order_from(n, paint, options.kerf, done)) broken.islands.back().push_back(other);
    }
    broken.script = script_of(broken, options, broken.seconds);
    return broken;
}

plan::CasePlan plan_of(const BrokenMandible& broken, const std::vector<std::string>& files,
                       const std::vector<std::uint64_t>& hashes) {
    plan::CasePlan plan;
    plan.title = "A mandible in twelve pieces";
    for (std::size_t n = 0; n < broken.fragments.size(); ++n)
        plan.fragments.push_back({broken.fragments[n].name, files[n], hashes[n], broken.fragments[n].colour});
    plan::PlanStep lock;
    lock.kind = plan::StepKind::lock;
    lock.by = "command";
    lock.fragments = {0};
    plan::add_step(plan, lock);
    return plan;
}

}  // namespace tactus::library
