// SPDX-License-Identifier: Apache-2.0
#include "tools/command/plan/flap_text.hpp"

#include "dsp/rope/measure.hpp"
#include "tools/analysis/plan/flap_words.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

#include <numbers>

namespace tactus::command {

using file::Json;

namespace {

constexpr double to_mm = 1e3, to_deg = 180.0 / std::numbers::pi;

Json point_json(const Vec3& p) { return {p.x * to_mm, p.y * to_mm, p.z * to_mm}; }

Json reach_json(const reconstruction::SiteReach& r) {
    Json path = Json::array();
    for (const Vec3& p : r.points) path.push_back(point_json(p));
    return {{"vessel", r.vessel},
            {"site", r.site},
            {"kind", reconstruction::name_of(r.kind)},
            {"reach", reconstruction::name_of(r.reach)},
            {"in_situ_mm", r.in_situ * to_mm},
            {"free_mm", r.free * to_mm},
            {"path_mm", r.path * to_mm},
            {"path_settled", r.is_settled},
            {"slack_mm", r.slack * to_mm},
            {"strain", r.strain},
            {"tension_n", r.tension ? Json(*r.tension) : Json(nullptr)},
            {"bend_radius_mm", r.bend_radius * to_mm},
            {"twist_deg", r.twist ? Json(*r.twist * to_deg) : Json(nullptr)},
            {"contact_mm", r.contact * to_mm},
            {"to_plate_mm", in_mm(r.to_plate)},
            {"to_screw_mm", in_mm(r.to_screw)},
            {"points_mm", path}};
}

}  // namespace

Json flap_json(const reconstruction::FlapMeasures& m) {
    Json clearances = Json::array(), reaches = Json::array(), spans = Json::array();
    for (const reconstruction::Clearance& c : m.clearances)
        clearances.push_back({{"object", c.object},
                              {"to", reconstruction::name_of(c.nearness)},
                              {"other", c.other},
                              {"distance_mm", c.distance * to_mm}});
    for (const reconstruction::SiteReach& r : m.reaches) reaches.push_back(reach_json(r));
    for (const reconstruction::SpanReach& s : m.spans)
        spans.push_back({{"vessel", s.vessel},
                         {"segments", {s.first, s.second}},
                         {"in_situ_mm", s.in_situ * to_mm},
                         {"path_mm", s.path * to_mm},
                         {"strain", s.strain}});
    return {{"reaches", reaches},
            {"spans", spans},
            {"clearances", clearances},
            {"tumour_margin_mm", in_mm(m.tumour_margin)}};
}

Json candidates_json(std::span<const reconstruction::Candidate> all) {
    Json list = Json::array();
    for (const reconstruction::Candidate& c : all) {
        Json reaches = Json::array(), warnings = Json::array();
        for (const reconstruction::SiteReach& r : c.measures.reaches) {
            Json one = reach_json(r), brief = Json::object();
            for (const auto& [key, value] : one.items())
                if (key != "points_mm") brief[key] = value;
            reaches.push_back(brief);
        }
        for (const reconstruction::FibulaWarning& w : c.plan.warnings)
            warnings.push_back({{"code", reconstruction::name_of(w.code)}, {"text", w.text}});
        for (const reconstruction::FlapWarning& w : c.measures.warnings)
            warnings.push_back({{"code", reconstruction::name_of(w.code)}, {"text", w.text}});
        list.push_back({{"leg", c.leg == reconstruction::Leg::left ? "left" : "right"},
                        {"mirrored", c.is_mirrored},
                        {"pedicle_at", c.at_first ? "first" : "last"},
                        {"reversed", c.inputs.reversed},
                        {"turned_180", c.is_flipped},
                        {"roll_deg", c.inputs.roll * to_deg},
                        {"as_given", c.changes == 0},
                        {"excluded", c.excluded.empty() ? Json(nullptr) : Json(c.excluded)},
                        {"reaches", reaches},
                        {"warnings", warnings}});
    }
    return list;
}

Json reconstruction_json(const reconstruction::Reconstruction& all) {
    const reconstruction::Flap& flap = all.flap;
    Json vessels = Json::array(), sites = Json::array(), perforators = Json::array(), plates = Json::array(),
         implants = Json::array();
    for (const reconstruction::FlapVessel& v : flap.vessels)
        vessels.push_back({{"name", v.name},
                           {"kind", reconstruction::name_of(v.kind)},
                           {"radius_mm", v.radius * to_mm},
                           {"length_mm", rope::length_of(v.points) * to_mm}});
    for (const reconstruction::RecipientSite& s : flap.sites)
        sites.push_back({{"name", s.name}, {"kind", reconstruction::name_of(s.kind)}, {"at_mm", point_json(s.at)}});
    for (const reconstruction::Perforator& p : flap.perforators)
        perforators.push_back({{"name", p.name}, {"at_mm", point_json(p.at)}});
    for (const reconstruction::Plate& p : flap.plates)
        plates.push_back({{"name", p.name},
                          {"width_mm", p.width * to_mm},
                          {"thickness_mm", p.thickness * to_mm},
                          {"length_mm", rope::length_of(p.points) * to_mm},
                          {"screws", p.screws.size()}});
    for (const reconstruction::DentalImplant& i : flap.implants)
        implants.push_back({{"name", i.name},
                            {"head_mm", point_json(i.head)},
                            {"axis", {i.axis.x, i.axis.y, i.axis.z}},
                            {"diameter_mm", i.diameter * to_mm},
                            {"length_mm", i.length * to_mm}});
    Json paddle = nullptr;
    if (flap.paddle)
        paddle = {{"at_mm", point_json(flap.paddle->at)},
                  {"length_mm", flap.paddle->length * to_mm},
                  {"width_mm", flap.paddle->width * to_mm}};
    return {{"donor", all.donor.file},
            {"jaw", all.jaw ? Json(all.jaw->file) : Json(nullptr)},
            {"tumour", all.tumour ? Json(all.tumour->file) : Json(nullptr)},
            {"margin_mm", flap.margin * to_mm},
            {"leg", all.inputs.leg == reconstruction::Leg::left ? "left" : "right"},
            {"planes", all.inputs.planes.size()},
            {"reversed", all.inputs.reversed},
            {"roll_deg", all.inputs.roll * to_deg},
            {"resection", reconstruction::name_of(all.inputs.resection)},
            {"vessels", vessels},
            {"perforators", perforators},
            {"sites", sites},
            {"plates", plates},
            {"implants", implants},
            {"paddle", paddle}};
}

void print_flap(const reconstruction::FlapMeasures& m) {
    for (const reconstruction::SiteReach& r : m.reaches) fmt::print("{}\n", analysis::reach_words(r));
    for (const reconstruction::SpanReach& s : m.spans)
        fmt::print("'{}' between segments {} and {}: {:.1f} mm in the leg, {:.1f} mm in the jaw\n", s.vessel,
                   s.first + 1, s.second + 1, s.in_situ * to_mm, s.path * to_mm);
    for (const reconstruction::Clearance& c : m.clearances)
        fmt::print("{}: {:.1f} mm to {}\n", c.object, c.distance * to_mm, c.other);
    if (m.tumour_margin) fmt::print("tumour: {:.1f} mm to the nearest cut of the jaw\n", *m.tumour_margin * to_mm);
}

void print_candidates(std::span<const reconstruction::Candidate> all) {
    int number = 0;
    for (const reconstruction::Candidate& c : all) {
        fmt::print("{}. {}\n", ++number, analysis::candidate_words(c));
        if (!c.excluded.empty()) {
            fmt::print("   excluded: {}\n", c.excluded);
            continue;
        }
        for (const reconstruction::FlapWarning& w : c.measures.warnings) fmt::print("   {}\n", w.text);
    }
}

void print_reconstruction(const reconstruction::Reconstruction& all) {
    const reconstruction::Flap& flap = all.flap;
    fmt::print("  reconstruction: {} of the {} leg{}, {}, {}, {}, {}, {}, {}\n",
               counted(all.inputs.planes.size() - 1, "segment"),
               all.inputs.leg == reconstruction::Leg::left ? "left" : "right", all.inputs.reversed ? ", reversed" : "",
               counted(flap.vessels.size(), "vessel"), counted(flap.perforators.size(), "perforator"),
               counted(flap.sites.size(), "site"), counted(flap.plates.size(), "plate"),
               counted(flap.implants.size(), "implant"), all.tumour ? "a tumour" : "no tumour");
}

}  // namespace tactus::command
