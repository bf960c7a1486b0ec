// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/ranking.hpp"

#include "dsp/core/error.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/flap_obstacle.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <tuple>
#include <utility>

namespace tactus::reconstruction {

namespace {

void mirror(Vec3& v) { v.x = -v.x; }

/// The best strain of a sort of vessels, and whether any of them has a site.
struct KindReach {
    bool is_there = false, reaches = false;
    double strain = 0.0;
    Reach reach = Reach::slack;
    std::string why;
};

KindReach reach_of(const FlapMeasures& m, const Flap& flap, VesselKind kind) {
    KindReach found;
    const bool has_vessel = std::ranges::any_of(flap.vessels, [&](const FlapVessel& v) { return v.kind == kind; }),
               has_site = std::ranges::any_of(flap.sites, [&](const RecipientSite& s) { return s.kind == kind; });
    found.is_there = has_vessel && has_site;
    const SiteReach* best = nullptr;
    for (const SiteReach& one : m.reaches)
        if (one.kind == kind && (!best || one.strain < best->strain)) best = &one;
    if (best) found.strain = best->strain, found.reach = best->reach;
    found.reaches = best && best->reach != Reach::too_short;
    for (const FlapWarning& w : m.warnings)
        if (!found.reaches && found.why.empty() && w.object.starts_with(name_of(kind)) &&
            (w.code == FlapTrouble::too_short || w.code == FlapTrouble::no_pedicle))
            found.why = w.text;
    return found;
}

using Order = std::tuple<bool, int, int, int, int, int, double>;

Order order_of(const Candidate& c, const Flap& flap) {
    int meets = 0, bends = 0, others = static_cast<int>(c.plan.warnings.size());
    for (const FlapWarning& w : c.measures.warnings) {
        if (w.code == FlapTrouble::near_vessel) ++meets;
        else if (w.code == FlapTrouble::kinked || w.code == FlapTrouble::twisted) ++bends;
        else if (w.code != FlapTrouble::stretched) ++others;
    }
    int reach = 0;
    double strain = 0.0;
    for (const VesselKind kind : {VesselKind::artery, VesselKind::vein}) {
        const KindReach found = reach_of(c.measures, flap, kind);
        reach = std::max(reach, static_cast<int>(found.reach));
        strain = std::max(strain, found.strain);
    }
    return {!c.excluded.empty(), meets, reach, bends, others, c.changes, strain};
}

FibulaInputs turned(const FibulaInputs& given, const FibulaPlan* now, bool reverse, bool flip) {
    FibulaInputs inputs = given;
    if (reverse) {
        inputs.reversed = !inputs.reversed;
        if (!inputs.along_line.empty()) {
            inputs.along_line.clear();
            if (now && now->left_distal) inputs.distal_margin = *now->left_distal;
        }
    }
    if (flip) inputs.roll += inputs.roll > 0.0 ? -std::numbers::pi : std::numbers::pi;
    return inputs;
}

void measure(Candidate& c, const Flap& flap, const DonorBone& donor, const RankingScene& scene) {
    try {
        c.plan = plan_fibula(c.inputs, donor);
    } catch (const Error& error) {
        c.excluded = error.message();
        return;
    }
    const FlapObstacle bone(c.plan, scene.jaw, scene.donor, c.is_mirrored);
    c.measures = measure_flap(c.inputs, c.plan, flap, &bone, scene.tumour);
    for (const VesselKind kind : {VesselKind::artery, VesselKind::vein})
        if (const KindReach found = reach_of(c.measures, flap, kind);
            found.is_there && !found.reaches && c.excluded.empty())
            c.excluded = found.why;
}

}  // namespace

FibulaInputs other_leg(const FibulaInputs& inputs) {
    FibulaInputs other = inputs;
    mirror(other.line_point);
    mirror(other.line_direction);
    other.leg = inputs.leg == Leg::left ? Leg::right : Leg::left;
    if (other.donor) {
        for (Vec3& v : other.donor->vertices) mirror(v);
        for (auto& t : other.donor->triangles) std::swap(t[1], t[2]);
    }
    return other;
}

Flap other_leg(const Flap& flap) {
    Flap other = flap;
    for (FlapVessel& vessel : other.vessels)
        for (Vec3& p : vessel.points) mirror(p);
    for (Perforator& p : other.perforators) mirror(p.at);
    if (other.paddle) mirror(other.paddle->at);
    return other;
}

std::vector<Candidate> ranked(const FibulaInputs& inputs, const Flap& flap, const RankingScene& scene) {
    const DonorBone given_leg(inputs);
    std::array<FibulaInputs, 2> legs{inputs, {}};
    legs[0].jaw.reset();
    // What does not lie along the line is left out before it is mirrored.
    if (legs[0].donor) legs[0].donor = given_leg.surface();
    legs[1] = other_leg(legs[0]);
    const DonorBone mirrored_leg(legs[1], legs[1].donor.value_or(geometry::TriangleSurface{}));
    for (FibulaInputs& leg : legs) leg.donor.reset();
    const std::array<Flap, 2> flaps{flap, other_leg(flap)};
    std::vector<Candidate> all;
    const FibulaPlan* now = nullptr;
    FibulaPlan given;
    for (const bool other : {false, true})
        for (const bool reverse : {false, true})
            for (const bool flip : {false, true}) {
                Candidate c;
                c.inputs = turned(legs[other ? 1 : 0], now, reverse, flip);
                c.leg = c.inputs.leg;
                c.is_mirrored = other;
                c.at_first = c.inputs.reversed;
                c.is_flipped = flip;
                c.changes = (flip ? 1 : 0) + (reverse ? 2 : 0) + (other ? 4 : 0);
                measure(c, flaps[other ? 1 : 0], other ? mirrored_leg : given_leg, scene);
                if (c.changes == 0) given = c.plan, now = &given;
                all.push_back(std::move(c));
            }
    std::ranges::stable_sort(all, {}, [&](const Candidate& c) { return order_of(c, flap); });
    return all;
}

}  // namespace tactus::reconstruction
