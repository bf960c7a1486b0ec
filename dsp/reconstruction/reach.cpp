// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/reach.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/margin_wall.hpp"
#include "dsp/reconstruction/pedicle.hpp"
#include "dsp/rope/measure.hpp"
#include "dsp/rope/rope.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::reconstruction {

namespace {

constexpr double bend_step = 5.0 * mm, lead_in = 10.0 * mm, touching = 0.1 * mm;
constexpr std::size_t path_points = 33;

double strain_of(double path, double in_situ) {
    const double free = rope::free_over_in_situ * in_situ;
    return free > 0.0 ? std::max(path / free - 1.0, 0.0) : infinity;
}

bool is_free(const Vec3& a, const Vec3& b, double radius, const rope::Obstacle* bone) {
    if (!bone) return true;
    const double length = glm::length(b - a);
    Vec3 normal(0.0);
    for (double at = 0.0; at < length;) {
        const double away = bone->distance(glm::mix(a, b, at / length), normal) - radius;
        // The ends hold where they are: the vessel leaves the bone there.
        if (away < 0.0 && at > 2.0 * radius && at < length - 2.0 * radius) return false;
        at += std::clamp(away, 0.5 * mm, 5.0 * mm);
    }
    return true;
}

/// True if a path stays clear of the bone, except at its ends. A polyline around bone cuts off an arc between points.
bool keeps_off(const std::vector<Vec3>& path, double radius, const rope::Obstacle* bone) {
    constexpr double tolerance = 0.3 * mm, min_curve = 10.0 * mm;
    Vec3 normal(0.0);
    for (std::size_t n = 0; n + 1 < path.size(); ++n) {
        const Vec3 middle = 0.5 * (path[n] + path[n + 1]);
        if (glm::length(middle - path.front()) < 2.0 * radius || glm::length(middle - path.back()) < 2.0 * radius)
            continue;
        const double step = glm::length(path[n + 1] - path[n]);
        if (bone->distance(middle, normal) < radius - tolerance - step * step / (8.0 * min_curve)) return false;
    }
    return true;
}

/// The shortest of the ways that begin straight and round the four sides of what is in the way.
rope::ShortestPath path_of(const Vec3& from, const Vec3& to, double radius, const rope::Obstacle* bone) {
    const double chord = glm::length(to - from);
    if (!(chord > 1e-6)) return {std::vector<Vec3>(path_points, from), 0.0, 0.0, true};
    if (is_free(from, to, radius, bone)) return {rope::resampled(std::array{from, to}, path_points), chord, 0.0, true};
    const Vec3 along = (to - from) / chord;
    const Vec3 u = glm::normalize(glm::cross(along, std::abs(along.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0))),
               v = glm::cross(along, u);
    rope::ShortestPath best;
    bool is_off = false;
    const double aside = std::max(0.25 * chord, 25.0 * mm);
    for (const Vec3& side : {Vec3(0.0), u, -u, v, -v}) {
        const std::array<Vec3, 3> start{from, 0.5 * (from + to) + aside * side, to};
        rope::ShortestPath found = rope::shortest_path(start, bone, radius, path_points / 2 + 1);
        const bool off = keeps_off(found.points, radius, bone);
        if (best.points.empty() || (off && !is_off) || (off == is_off && found.length < best.length))
            best = std::move(found), is_off = off;
    }
    rope::ShortestPath path = rope::shortest_path(best.points, bone, radius, path_points);
    path.is_settled = path.is_settled && keeps_off(path.points, radius, bone);
    return path;
}

double contact_of(const std::vector<Vec3>& path, double radius, const rope::Obstacle* bone) {
    if (!bone) return 0.0;
    double length = 0.0;
    Vec3 normal(0.0);
    for (std::size_t n = 0; n + 1 < path.size(); ++n)
        if (bone->distance(0.5 * (path[n] + path[n + 1]), normal) < radius + touching)
            length += glm::length(path[n + 1] - path[n]);
    return length;
}

/// The pedicle of a vessel, where it leaves the bone in the jaw.
struct Pedicle {
    double length = 0.0;
    Vec3 exit{0.0};
    std::vector<Vec3> lead;  // the last of the vessel on the bone, up to the exit
};

std::optional<Pedicle> pedicle_of(const std::vector<VesselPart>& parts, const FibulaPlan& plan) {
    if (parts.size() < 2 || parts[0].kind != VesselPart::Kind::pedicle) return {};
    const Pose& pose = plan.segments[parts[0].segment].donor_to_target;
    Pedicle found{parts[0].length, pose.apply(parts[0].points.back()), {}};
    double length = 0.0;
    const std::vector<Vec3>& on_bone = parts[1].points;
    for (std::size_t n = 0; n < on_bone.size() && length < lead_in; ++n) {
        const double step = n > 0 ? glm::length(on_bone[n] - on_bone[n - 1]) : 0.0;
        const double share = step > 0.0 ? std::min(1.0, (lead_in - length) / step) : 1.0;
        length += step;
        found.lead.push_back(pose.apply(n > 0 ? glm::mix(on_bone[n - 1], on_bone[n], share) : on_bone[n]));
    }
    std::ranges::reverse(found.lead);
    return found;
}

/// Over two pieces of bend_step, wherever they lie on the way.
double bend_of(const Pedicle& pedicle, const std::vector<Vec3>& path) {
    constexpr std::size_t parts = 10;
    std::vector<Vec3> line = pedicle.lead;
    line.insert(line.end(), path.begin() + 1, path.end());
    const auto count = static_cast<std::size_t>(std::round(rope::length_of(line) * parts / bend_step)) + 1;
    if (count < 2 * parts + 1) return infinity;
    const std::vector<Vec3> fine = rope::resampled(line, count);
    double least = infinity;
    for (std::size_t n = parts; n + parts < fine.size(); ++n)
        least = std::min(least, rope::min_bend_radius(std::array{fine[n - parts], fine[n], fine[n + parts]}));
    return least;
}

void measure_hardware(SiteReach& reach, double radius, const Flap& flap) {
    double plate = infinity, screw = infinity;
    for (std::size_t n = 0; n + 1 < reach.points.size(); ++n) {
        const Capsule piece{reach.points[n], reach.points[n + 1], radius};
        for (const Plate& one : flap.plates) {
            for (const Block& block : blocks_of(one)) plate = std::min(plate, distance(piece, block));
            for (const Screw& each : one.screws) screw = std::min(screw, distance(piece, capsule_of(each)));
        }
    }
    if (plate < infinity) reach.to_plate = plate;
    if (screw < infinity) reach.to_screw = screw;
}

SiteReach reach_of(const FlapVessel& vessel, const RecipientSite& site, const Pedicle& pedicle, const Flap& flap,
                   const rope::Obstacle* bone) {
    SiteReach reach;
    reach.vessel = vessel.name;
    reach.site = site.name;
    reach.kind = vessel.kind;
    rope::ShortestPath path = path_of(pedicle.exit, site.at, vessel.radius, bone);
    reach.in_situ = pedicle.length;
    reach.free = rope::free_over_in_situ * pedicle.length;
    reach.path = path.length;
    reach.is_settled = path.is_settled;
    reach.points = std::move(path.points);
    reach.slack = std::max(reach.free - reach.path, 0.0);
    reach.strain = strain_of(reach.path, pedicle.length);
    reach.reach = reach_at(reach.strain, flap.limits);
    if (vessel.kind == VesselKind::artery) reach.tension = rope::artery().stiffness * reach.strain;
    reach.bend_radius = bend_of(pedicle, reach.points);
    reach.contact = contact_of(reach.points, vessel.radius, bone);
    measure_hardware(reach, vessel.radius, flap);
    return reach;
}

/// By how much the vein's side of the artery turns on the way to the site, against the side carried along the path.
std::optional<double> twist_of(const SiteReach& artery, const Vec3& vein_at_exit, const Vec3& vein_at_site) {
    constexpr double min_apart = 0.5 * mm;
    const std::vector<Vec3>& p = artery.points;
    const auto across = [](const Vec3& v, const Vec3& along) { return v - glm::dot(v, along) * along; };
    const Vec3 first = p[1] - p[0], last = p.back() - p[p.size() - 2];
    if (!(glm::length(first) > 0.0 && glm::length(last) > 0.0)) return {};
    const Vec3 from = across(vein_at_exit - p.front(), glm::normalize(first)), axis = glm::normalize(last),
               to = across(vein_at_site - p.back(), axis);
    if (glm::length(from) < min_apart || glm::length(to) < min_apart) return {};
    const Vec3 carried = rope::transported(p, from);
    return std::atan2(glm::dot(glm::cross(carried, to), axis), glm::dot(carried, to));
}

void measure_twists(std::vector<SiteReach>& reaches, const Flap& flap) {
    const SiteReach* vein = nullptr;
    for (const SiteReach& one : reaches)
        if (one.kind == VesselKind::vein && (!vein || one.strain < vein->strain)) vein = &one;
    if (!vein) return;
    for (SiteReach& one : reaches) {
        if (one.kind != VesselKind::artery) continue;
        const Vec3* nearest = nullptr;
        for (const RecipientSite& site : flap.sites)
            if (site.kind == VesselKind::vein &&
                (!nearest || glm::length(site.at - one.points.back()) < glm::length(*nearest - one.points.back())))
                nearest = &site.at;
        if (nearest) one.twist = twist_of(one, vein->points.front(), *nearest);
    }
}

void measure_spans(std::vector<SpanReach>& spans, const FlapVessel& vessel, const std::vector<VesselPart>& parts,
                   const FibulaPlan& plan) {
    using enum VesselPart::Kind;
    for (std::size_t n = 1; n + 1 < parts.size(); ++n) {
        if (parts[n].kind != span || parts[n - 1].kind != attached || parts[n + 1].kind != attached) continue;
        const Vec3 from = plan.segments[parts[n - 1].segment].donor_to_target.apply(parts[n].points.front()),
                   to = plan.segments[parts[n + 1].segment].donor_to_target.apply(parts[n].points.back());
        const double path = glm::length(to - from);
        spans.push_back({vessel.name, parts[n - 1].segment, parts[n + 1].segment, parts[n].length, path,
                         strain_of(path, parts[n].length)});
    }
}

}  // namespace

const char* name_of(Reach reach) {
    switch (reach) {
        case Reach::slack: return "slack";
        case Reach::in_situ: return "in-situ";
        case Reach::stretched: return "stretched";
        case Reach::too_short: return "too-short";
    }
    return "";
}

Reach reach_at(double strain, const FlapLimits& limits) {
    const double in_situ = 1.0 / rope::free_over_in_situ - 1.0;
    if (strain <= 0.0) return Reach::slack;
    if (strain <= in_situ) return Reach::in_situ;
    return strain <= (1.0 + limits.over_in_situ) / rope::free_over_in_situ - 1.0 ? Reach::stretched : Reach::too_short;
}

const SiteReach* best_of(std::span<const SiteReach> all, const std::string& vessel) {
    const SiteReach* best = nullptr;
    for (const SiteReach& one : all)
        if (one.vessel == vessel &&
            (!best || one.strain < best->strain || (one.strain == best->strain && one.slack > best->slack)))
            best = &one;
    return best;
}

FlapMeasures measure_flap(const FibulaInputs& inputs, const FibulaPlan& plan, const Flap& flap,
                          const rope::Obstacle* bone, std::span<const Vec3> tumour) {
    FlapMeasures measures;
    for (const FlapVessel& vessel : flap.vessels) {
        const std::vector<VesselPart> parts = parts_of(vessel, inputs, plan);
        measures.vessels.push_back(placed(vessel, parts, plan));
        measure_spans(measures.spans, vessel, parts, plan);
        const std::optional<Pedicle> pedicle = pedicle_of(parts, plan);
        for (const RecipientSite& site : flap.sites)
            if (pedicle && site.kind == vessel.kind)
                measures.reaches.push_back(reach_of(vessel, site, *pedicle, flap, bone));
    }
    measure_twists(measures.reaches, flap);
    for (PlacedVessel& vessel : measures.vessels)
        if (const SiteReach* best = best_of(measures.reaches, vessel.name)) vessel.lines.push_back(best->points);
    measures.clearances = clearances(flap, cuts_of(inputs, plan), measures.vessels);
    if (!tumour.empty())
        for (const Plane& plane : resection_planes(inputs))
            measures.tumour_margin = std::min(measures.tumour_margin.value_or(infinity), margin_behind(plane, tumour));
    add_warnings(measures, inputs, plan, flap);
    return measures;
}

}  // namespace tactus::reconstruction
