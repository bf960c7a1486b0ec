// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/runoff.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::vessel {

namespace {

constexpr double trifurcation = 0.3, foot = 0.85, peroneal_end = 0.75;
constexpr double beside = 60e-3;  // m from the plane of the bones: what lies further is not of this leg

struct Leg {
    const LegGeometry& bones;
    Vec3 down;
    double length;

    explicit Leg(const LegGeometry& leg)
        : bones(leg), down(leg.tibia_bottom - leg.tibia_top), length(glm::length(down)) {
        for (const Vec3& p : {leg.tibia_top, leg.tibia_bottom, leg.fibula_top, leg.fibula_bottom})
            if (!is_finite(p)) throw Error("the ends of tibia and fibula must be positions in mm");
        if (length < 0.1 || glm::length(leg.fibula_bottom - leg.fibula_top) < 0.1)
            throw Error("tibia and fibula must be at least 100 mm long: give the ends of their axes");
        down /= length;
        if (glm::dot(leg.fibula_bottom - leg.fibula_top, down) <= 0.0)
            throw Error("the fibula is upside down: give its head first, as the tibia's plateau");
        for (const double level : {0.3, 0.7})
            if (glm::length(fibula_at(level) - tibia_at(level)) < 10e-3)
                throw Error("the axes of tibia and fibula are closer than 10 mm");
        const double lateral = fibula_at(0.5).x - tibia_at(0.5).x;  // LPS: positive is left
        if ((lateral > 0.0) == leg.is_right)
            throw Error(fmt::format("the fibula lies {} of the tibia, but the {} leg is stated; positions are LPS",
                                    lateral > 0.0 ? "left" : "right", leg.is_right ? "right" : "left"));
    }

    Vec3 tibia_at(double level) const { return bones.tibia_top + level * (bones.tibia_bottom - bones.tibia_top); }
    /// Where the fibula's axis crosses the cross-section of the tibia at this level.
    Vec3 fibula_at(double level) const {
        const Vec3 way = bones.fibula_bottom - bones.fibula_top;
        const double along = glm::dot(tibia_at(level) - bones.fibula_top, down) / glm::dot(way, down);
        return bones.fibula_top + along * way;
    }
    double level_of(const Vec3& p) const { return glm::dot(p - bones.tibia_top, down) / length; }

    std::optional<LegArtery> artery_at(const Vec3& p) const {
        const double level = level_of(p);
        const Vec3 tibia = tibia_at(level), to_fibula = fibula_at(level) - tibia;
        const double width = glm::length(to_fibula);
        const Vec3 lateral = to_fibula / width;
        Vec3 front = glm::normalize(glm::cross(lateral, down));
        if (!bones.is_right) front = -front;
        const double u = glm::dot(p - tibia, lateral) / width, w = glm::dot(p - tibia, front);
        if (u < -1.5 || u > 2.5 || std::abs(w) > beside) return std::nullopt;
        if (w > 0.0) return LegArtery::anterior_tibial;
        return u > 0.5 ? LegArtery::peroneal : LegArtery::posterior_tibial;
    }
};

void warn(RunOff& found) {
    const auto& [anterior, posterior, peroneal] = found.arteries;
    if (!found.is_judged) {
        found.warnings.push_back(
            fmt::format("the track covers levels {:.2f} to {:.2f} of the leg, which is too little to judge its "
                        "arteries (0.4 to 0.7 "
                        "is needed): the run-off is unknown",
                        std::min(found.from, found.to), found.to));
        return;
    }
    if (!peroneal.is_seen)
        found.warnings.push_back(
            "the peroneal artery was not found: the fibula may have no pedicle on this side; seed it by hand or look "
            "at "
            "the scan before planning");
    const bool front = anterior.is_seen && anterior.reaches_foot, back = posterior.is_seen && posterior.reaches_foot;
    if (peroneal.is_seen && !front && !back)
        found.warnings.push_back(
            "neither the anterior nor the posterior tibial artery is seen to reach the foot: the peroneal artery may "
            "be "
            "the only one to it, and taking it may cost the foot");
    else if (peroneal.is_seen && !(front && back))
        found.warnings.push_back(fmt::format(
            "the {} artery is not seen to reach the foot: without the peroneal artery the foot would depend on the {} "
            "artery alone",
            name_of(front ? LegArtery::posterior_tibial : LegArtery::anterior_tibial),
            name_of(front ? LegArtery::anterior_tibial : LegArtery::posterior_tibial)));
    for (std::size_t n = 0; n < 3; ++n)
        if (found.arteries[n].has_lost_stretch)
            found.warnings.push_back(fmt::format("the {} artery has a stretch without contrast: occluded or too thin",
                                                 name_of(static_cast<LegArtery>(n))));
}

}  // namespace

std::string_view name_of(LegArtery artery) {
    switch (artery) {
        case LegArtery::anterior_tibial: return "anterior tibial";
        case LegArtery::posterior_tibial: return "posterior tibial";
        case LegArtery::peroneal: return "peroneal";
    }
    return "";
}

RunOff run_off(const Track& track, const LegGeometry& geometry) {
    const Leg leg(geometry);
    RunOff found;
    std::array<double, 3> length{};
    for (const Branch& branch : track.branches)
        for (std::size_t n = 0; n < branch.nodes.size(); ++n) {
            const Node& node = branch.nodes[n];
            const double level = leg.level_of(node.position);
            found.from = std::min(found.from, level);
            found.to = std::max(found.to, level);
            if (level < trifurcation || level > 1.05) continue;
            const std::optional<LegArtery> artery = leg.artery_at(node.position);
            if (!artery) continue;
            const std::size_t index = static_cast<std::size_t>(*artery);
            SeenArtery& seen = found.arteries[index];
            if (node.is_lost) {
                seen.has_lost_stretch = true;
                continue;
            }
            if (n > 0) length[index] += glm::length(node.position - branch.nodes[n - 1].position);
            seen.from = length[index] > 0.0 && seen.is_seen ? std::min(seen.from, level) : level;
            seen.to = seen.is_seen ? std::max(seen.to, level) : level;
            seen.is_seen = true;
        }
    for (std::size_t n = 0; n < 3; ++n) {
        SeenArtery& seen = found.arteries[n];
        // A side branch that crosses a corner is no artery of the leg.
        if (length[n] < 0.1 * leg.length) seen = {};
        seen.reaches_foot = seen.is_seen && seen.to > (n == std::size_t(LegArtery::peroneal) ? peroneal_end : foot);
    }
    found.is_judged = found.from < 0.4 && found.to > 0.7;
    warn(found);
    return found;
}

}  // namespace tactus::vessel
