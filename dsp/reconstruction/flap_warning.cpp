// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/flap_warning.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/pedicle.hpp"
#include "dsp/reconstruction/reach.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace tactus::reconstruction {

namespace {

class Warnings {
public:
    Warnings(FlapMeasures& measures, const FibulaInputs& inputs, const FibulaPlan& plan, const Flap& flap)
        : m_(measures), inputs_(inputs), plan_(plan), flap_(flap) {}

    void all() {
        of_clearances();
        of_perforators();
        of_paddle();
        of_tumour();
        of_vessels();
        of_spans();
    }

private:
    void add(FlapTrouble code, std::string text, std::string object, std::string other, double number) {
        m_.warnings.push_back({code, std::move(text), std::move(object), std::move(other), number});
    }

    void of_clearances() {
        for (const Clearance& c : m_.clearances) {
            if (c.distance >= flap_.limits.clearance - 1e-9) continue;
            const FlapTrouble code = c.nearness == Nearness::to_cut      ? FlapTrouble::near_cut
                                     : c.nearness == Nearness::to_vessel ? FlapTrouble::near_vessel
                                                                         : FlapTrouble::near_hardware;
            add(code,
                c.distance < 0.0 ? fmt::format("{} meets {}, {:.1f} mm deep", c.object, c.other, -c.distance / mm)
                                 : fmt::format("{} comes within {:.1f} mm of {}, less than {:.1f} mm", c.object,
                                               c.distance / mm, c.other, flap_.limits.clearance / mm),
                c.object, c.other, c.distance);
        }
    }

    void of_perforators() {
        double low = infinity, high = -infinity;
        for (const FibulaSegment& s : plan_.segments)
            for (const double along : s.along_line) low = std::min(low, along), high = std::max(high, along);
        for (const Perforator& p : flap_.perforators) {
            const std::string name = fmt::format("perforator '{}'", p.name);
            const double away = distance_to_cuts(plan_, p.at);
            if (segment_at(plan_, p.at) == plan_.segments.size()) {
                // Those beyond the flap stay in the leg.
                const double along = glm::dot(p.at - inputs_.line_point, glm::normalize(inputs_.line_direction));
                if (along > low && along < high)
                    add(FlapTrouble::perforator_lost,
                        fmt::format("{} lies in the wedge between two segments, {:.1f} mm from the nearest one", name,
                                    away / mm),
                        name, "", away);
            } else if (away < flap_.limits.perforator_to_cut - 1e-9)
                add(FlapTrouble::perforator_on_cut,
                    fmt::format("{} lies {:.1f} mm from an osteotomy, less than {:.1f} mm: move the cut by {:.1f} mm",
                                name, away / mm, flap_.limits.perforator_to_cut / mm,
                                (flap_.limits.perforator_to_cut - away) / mm),
                    name, "", away);
        }
    }

    void of_paddle() {
        if (!flap_.paddle) return;
        const Vec3 axis = glm::normalize(inputs_.line_direction);
        double nearest = infinity;
        for (const Perforator& p : flap_.perforators)
            if (segment_at(plan_, p.at) < plan_.segments.size())
                nearest = std::min(nearest, std::abs(glm::dot(p.at - flap_.paddle->at, axis)));
        if (nearest <= 0.5 * flap_.paddle->length) return;
        add(FlapTrouble::paddle_without_perforator,
            nearest < infinity
                ? fmt::format("the skin paddle has no perforator on kept bone: the nearest one lies {:.1f} mm beyond "
                              "its end",
                              (nearest - 0.5 * flap_.paddle->length) / mm)
                : "the skin paddle has no perforator on kept bone: none is marked there",
            "paddle", "", nearest);
    }

    void of_tumour() {
        if (!m_.tumour_margin || *m_.tumour_margin >= flap_.margin - 1e-9) return;
        add(FlapTrouble::tumour_margin,
            *m_.tumour_margin < 0.0
                ? fmt::format("a cut of the jaw runs {:.1f} mm inside the tumour", -*m_.tumour_margin / mm)
                : fmt::format("a cut of the jaw is {:.1f} mm from the tumour, less than {:.1f} mm",
                              *m_.tumour_margin / mm, flap_.margin / mm),
            "tumour", "", *m_.tumour_margin);
    }

    void of_vessels() {
        for (const VesselKind kind : {VesselKind::artery, VesselKind::vein}) {
            if (flap_.vessels.empty()) break;
            if (std::ranges::none_of(flap_.vessels, [&](const FlapVessel& v) { return v.kind == kind; }))
                add(kind == VesselKind::artery ? FlapTrouble::no_artery : FlapTrouble::no_vein,
                    fmt::format("the flap has no {}: a flap needs at least one artery and one vein", name_of(kind)),
                    name_of(kind), "", 0.0);
        }
        for (const FlapVessel& vessel : flap_.vessels) {
            const std::string name = fmt::format("{} '{}'", name_of(vessel.kind), vessel.name);
            if (const SiteReach* best = best_of(m_.reaches, vessel.name)) of_reach(*best, vessel, name);
            else if (std::ranges::none_of(flap_.sites, [&](const RecipientSite& s) { return s.kind == vessel.kind; })) {
                if (!flap_.sites.empty())
                    add(FlapTrouble::no_site, fmt::format("there is no site for {}", name), name, "", 0.0);
            } else
                add(FlapTrouble::no_pedicle,
                    fmt::format("{} has no pedicle: it does not leave the kept bone at the knee's end", name), name, "",
                    0.0);
        }
    }

    void of_reach(const SiteReach& r, const FlapVessel& vessel, const std::string& name) {
        const FlapLimits& limits = flap_.limits;
        const std::string site = fmt::format("site '{}'", r.site);
        const double most = (1.0 + limits.over_in_situ) * r.in_situ;
        if (r.reach == Reach::too_short)
            add(FlapTrouble::too_short,
                fmt::format("{} does not reach {}: the way is {:.1f} mm, it reaches {:.1f} mm ({:.1f} mm free of "
                            "tension)",
                            name, site, r.path / mm, most / mm, r.free / mm),
                name, site, r.strain);
        else if (r.reach == Reach::stretched)
            add(FlapTrouble::stretched,
                fmt::format("{} reaches {} with a strain of {:.0f} %, more than in the leg", name, site,
                            100.0 * r.strain),
                name, site, r.strain);
        // A vessel that is slack by the length of a half turn at that radius can be laid in a wider bend.
        const double min_bend = limits.kink * vessel.radius;
        if (r.bend_radius < min_bend && r.slack < std::numbers::pi * min_bend)
            add(FlapTrouble::kinked,
                fmt::format("{} bends to a radius of {:.1f} mm on the way to {}, less than {:.1f} times its own", name,
                            r.bend_radius / mm, site, limits.kink),
                name, site, r.bend_radius);
        if (r.twist && std::abs(*r.twist) > limits.twist)
            add(FlapTrouble::twisted,
                fmt::format("{} is twisted by {:.0f}° against its vein on the way to {}, more than {:.0f}°", name,
                            std::abs(*r.twist) * 180.0 / std::numbers::pi, site,
                            limits.twist * 180.0 / std::numbers::pi),
                name, site, *r.twist);
    }

    void of_spans() {
        for (const SpanReach& s : m_.spans) {
            if (reach_at(s.strain, flap_.limits) < Reach::stretched) continue;
            add(FlapTrouble::span_stretched,
                fmt::format("'{}' is stretched by {:.0f} % between segments {} and {}", s.vessel, 100.0 * s.strain,
                            s.first + 1, s.second + 1),
                s.vessel, "", s.strain);
        }
    }

    FlapMeasures& m_;
    const FibulaInputs& inputs_;
    const FibulaPlan& plan_;
    const Flap& flap_;
};

}  // namespace

const char* name_of(FlapTrouble trouble) {
    switch (trouble) {
        case FlapTrouble::near_cut: return "near-cut";
        case FlapTrouble::near_vessel: return "near-vessel";
        case FlapTrouble::near_hardware: return "near-hardware";
        case FlapTrouble::outside_bone: return "outside-bone";
        case FlapTrouble::leaves_bone: return "leaves-bone";
        case FlapTrouble::perforator_on_cut: return "perforator-on-cut";
        case FlapTrouble::perforator_lost: return "perforator-lost";
        case FlapTrouble::paddle_without_perforator: return "paddle-without-perforator";
        case FlapTrouble::tumour_margin: return "tumour-margin";
        case FlapTrouble::no_artery: return "no-artery";
        case FlapTrouble::no_vein: return "no-vein";
        case FlapTrouble::no_site: return "no-site";
        case FlapTrouble::no_pedicle: return "no-pedicle";
        case FlapTrouble::too_short: return "too-short";
        case FlapTrouble::stretched: return "stretched";
        case FlapTrouble::kinked: return "kinked";
        case FlapTrouble::twisted: return "twisted";
        case FlapTrouble::span_stretched: return "span-stretched";
    }
    return "";
}

void add_warnings(FlapMeasures& measures, const FibulaInputs& inputs, const FibulaPlan& plan, const Flap& flap) {
    Warnings(measures, inputs, plan, flap).all();
}

std::vector<FlapWarning> hardware_warnings(const Flap& flap, const rope::Obstacle& bone) {
    constexpr double step = 0.25e-3;  // m
    std::vector<FlapWarning> all;
    const auto check = [&](std::string name, const Vec3& head, const Vec3& axis, double length) {
        double least = infinity, at_tip = 0.0;
        const int steps = std::max(1, static_cast<int>(std::ceil(length / step)));
        for (int n = 0; n <= steps; ++n) {
            Vec3 normal(0.0);
            at_tip = bone.distance(head + axis * (length * n / steps), normal);
            least = std::min(least, at_tip);
        }
        if (least > 0.0) {
            std::string text = fmt::format("{} meets no bone: the nearest is {:.1f} mm away", name, least / mm);
            all.push_back({FlapTrouble::outside_bone, std::move(text), std::move(name), "", least});
        } else if (at_tip > max_standing_out) {
            std::string text = fmt::format("{} leaves the bone: its tip stands {:.1f} mm out", name, at_tip / mm);
            all.push_back({FlapTrouble::leaves_bone, std::move(text), std::move(name), "", at_tip});
        }
    };
    for (const Plate& plate : flap.plates)
        for (std::size_t n = 0; n < plate.screws.size(); ++n)
            check(fmt::format("screw {} of plate '{}'", n + 1, plate.name), plate.screws[n].head, plate.screws[n].axis,
                  plate.screws[n].length);
    for (const DentalImplant& implant : flap.implants)
        check(fmt::format("implant '{}'", implant.name), implant.head, implant.axis, implant.length);
    return all;
}

}  // namespace tactus::reconstruction
