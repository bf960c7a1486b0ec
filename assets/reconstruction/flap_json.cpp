// SPDX-License-Identifier: Apache-2.0
#include "assets/reconstruction/flap_json.hpp"

#include "assets/file/json_vector.hpp"
#include "assets/table/log_lines.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::reconstruction {

using file::Json;

namespace {

using file::json_of;

constexpr double farthest = 100.0;  // m
constexpr std::size_t max_points = 10000, max_things = 100;

Json json_of(const std::vector<Vec3>& all) {
    Json list = Json::array();
    for (const Vec3& v : all) list.push_back(json_of(v));
    return list;
}

VesselKind kind_of(const Members& item) {
    const std::string kind = item.text("kind");
    if (kind != "artery" && kind != "vein") item.fail("must have the 'kind' \"artery\" or \"vein\"");
    return kind == "artery" ? VesselKind::artery : VesselKind::vein;
}

Screw screw_of(const Members& item) {
    item.know({"axis"}, {"head", "length", "diameter"});
    const Screw usual;
    return {item.place("head"), item.direction("axis"), item.positive("length", usual.length),
            item.positive("diameter", usual.diameter)};
}

Plate plate_of(const Members& item) {
    item.know({"name", "outward", "screws", "laid"}, {"width", "thickness", "points"});
    const Plate usual;
    Plate plate{item.name(),
                item.positive("width", usual.width),
                item.positive("thickness", usual.thickness),
                item.places("points", max_points),
                item.directions("outward", max_points),
                {}};
    if (plate.points.size() < 2) item.fail("needs at least two points");
    if (plate.outward.size() != plate.points.size()) item.fail("needs a direction 'outward' for each point");
    for (const Members& screw : item.list("screws", max_things)) plate.screws.push_back(screw_of(screw));
    if (const std::optional<Members> laid = item.object("laid")) {
        laid->know({"screws_per_segment"}, {"height"});
        const double screws = laid->number("screws_per_segment");
        if (!(screws >= 0.0 && screws <= static_cast<double>(max_things) && screws == std::floor(screws)))
            item.fail("has 'screws_per_segment' that is no whole number from 0 to 100");
        plate.laid = {laid->length("height"), static_cast<int>(screws)};
    }
    return plate;
}

double share_of(const Members& item, const char* key, double otherwise, double most) {
    const double found = item.has(key) ? item.number(key) : otherwise;
    if (!(found >= 0.0 && found <= most)) item.fail(fmt::format("has a '{}' that is not 0 to {:g}", key, most));
    return found;
}

double not_negative(const Members& item, const char* key, double otherwise) {
    const double found = item.length(key, otherwise);
    if (found < 0.0) item.fail(fmt::format("has a negative '{}'", key));
    return found;
}

FlapLimits limits_of(const Members& item) {
    item.know({"over_in_situ", "kink_radii", "twist_deg", "twist_rad"}, {"clearance", "perforator_to_cut"});
    const FlapLimits usual;
    FlapLimits limits;
    limits.clearance = not_negative(item, "clearance", usual.clearance);
    limits.perforator_to_cut = not_negative(item, "perforator_to_cut", usual.perforator_to_cut);
    limits.over_in_situ = share_of(item, "over_in_situ", usual.over_in_situ, 1.0);
    limits.kink = share_of(item, "kink_radii", usual.kink, 100.0);
    limits.twist = item.has("twist_deg") ? share_of(item, "twist_deg", 0.0, 180.0) * degree
                                         : share_of(item, "twist_rad", usual.twist, std::numbers::pi + 1e-9);
    return limits;
}

template <class Named>
void check_names(const Members& all, const std::vector<Named>& named, const char* what) {
    for (std::size_t n = 0; n < named.size(); ++n)
        for (std::size_t k = 0; k < n; ++k)
            if (named[k].name == named[n].name)
                all.fail(fmt::format("has two {} of the name '{}'", what, named[n].name));
}

}  // namespace

Members::Members(const Json& json, std::string where, LengthUnit unit)
    : json_(json), where_(std::move(where)), unit_(unit) {
    if (!json.is_object()) fail("is not an object");
}

void Members::fail(const std::string& what) const { throw Error(fmt::format("{} {}", where_, what)); }

void Members::know(std::initializer_list<const char*> names, std::initializer_list<const char*> lengths) const {
    std::vector<std::string> all(names.begin(), names.end());
    for (const char* const length : lengths) all.push_back(with_unit(length));
    file::refuse_unknown(json_, where_, all);
}

const Json& Members::at(std::string_view key) const {
    const Json* found = json_.find(key);
    if (!found) fail(fmt::format("has no '{}'", key));
    return *found;
}

std::string Members::text(std::string_view key) const {
    const Json& value = at(key);
    if (!value.is_string() ||
        std::ranges::any_of(value.as_text(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        fail(fmt::format("has a '{}' that is not a one-line text", key));
    if (table::as_utf8(value.as_text()) != value.as_text()) fail(fmt::format("has a '{}' that is not UTF-8", key));
    return value.as_text();
}

std::string Members::name() const {
    std::string found = text("name");
    if (found.empty()) fail("has an empty name");
    return found;
}

bool Members::truth(std::string_view key) const {
    const Json& value = at(key);
    if (!value.is_boolean()) fail(fmt::format("has a '{}' that is not true or false", key));
    return value.get<bool>();
}

double Members::number(std::string_view key) const {
    const Json& value = at(key);
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    if (!std::isfinite(number)) fail(fmt::format("has a '{}' that is not a number", key));
    return number;
}

std::string Members::with_unit(std::string_view key) const { return fmt::format("{}_{}", key, unit_.name); }

double Members::length(std::string_view key) const {
    const std::string named = with_unit(key);
    const double metres = number(named) * unit_.metres;
    if (!(std::abs(metres) <= farthest)) fail(fmt::format("has a '{}' beyond {:.0f} m", named, farthest));
    return metres;
}

double Members::length(std::string_view key, double otherwise) const {
    return has(with_unit(key)) ? length(key) : otherwise;
}

double Members::positive(std::string_view key, double otherwise) const {
    const double found = length(key, otherwise);
    if (!(found > 0.0)) fail(fmt::format("has a '{}' that is not above 0", with_unit(key)));
    return found;
}

Vec3 Members::vector(const Json& json, const std::string& key, bool is_direction) const {
    Vec3 v(0.0);
    bool is_vector = json.is_array() && json.size() == 3;
    for (std::size_t axis = 0; is_vector && axis < 3; ++axis) {
        is_vector = json[axis].is_number();
        if (is_vector) v[static_cast<int>(axis)] = json[axis].get<double>();
    }
    if (!is_vector || !is_finite(v)) fail(fmt::format("has a '{}' that is not three numbers", key));
    if (!is_direction) {
        v *= unit_.metres;
        if (!(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= farthest))
            fail(fmt::format("has a '{}' beyond {:.0f} m", key, farthest));
        return v;
    }
    const double size = glm::length(v);
    if (!(size > 1e-6 && size < 1e6)) fail(fmt::format("has a '{}' that is no direction", key));
    return std::abs(size - 1.0) < 1e-9 ? v : v / size;
}

Vec3 Members::place(std::string_view key) const { return vector(at(with_unit(key)), with_unit(key), false); }

Vec3 Members::direction(std::string_view key) const { return vector(at(key), std::string(key), true); }

const Json& Members::entries(std::string_view key, std::size_t most) const {
    const Json& value = at(key);
    if (!value.is_array()) fail(fmt::format("has a '{}' that is not a list", key));
    if (value.size() > most) fail(fmt::format("has a '{}' with more than {} elements", key, most));
    return value;
}

std::vector<Vec3> Members::places(std::string_view key, std::size_t most) const {
    std::vector<Vec3> all;
    for (const Json& one : entries(with_unit(key), most)) all.push_back(vector(one, with_unit(key), false));
    return all;
}

std::vector<Vec3> Members::directions(std::string_view key, std::size_t most) const {
    std::vector<Vec3> all;
    for (const Json& one : entries(key, most)) all.push_back(vector(one, std::string(key), true));
    return all;
}

std::vector<double> Members::lengths(std::string_view key, std::size_t most) const {
    std::vector<double> all;
    for (const Json& one : entries(with_unit(key), most)) {
        const double metres = one.is_number() ? one.get<double>() * unit_.metres : std::nan("");
        if (!(std::abs(metres) <= farthest)) fail(fmt::format("has a '{}' that is not lengths", with_unit(key)));
        all.push_back(metres);
    }
    return all;
}

std::vector<Members> Members::list(std::string_view key, std::size_t most) const {
    std::vector<Members> all;
    if (!has(key)) return all;
    for (const Json& one : entries(key, most))
        all.emplace_back(one, fmt::format("{}: {}[{}]", where_, key, all.size()), unit_);
    return all;
}

std::optional<Members> Members::object(std::string_view key) const {
    if (!has(key)) return {};
    return Members(at(key), fmt::format("{}: {}", where_, key), unit_);
}

std::vector<FlapVessel> vessels_in(const Members& all) {
    std::vector<FlapVessel> vessels;
    const FlapVessel usual;
    for (const Members& item : all.list("vessels", max_things)) {
        item.know({"name", "kind", "file"}, {"radius", "points"});
        vessels.push_back(
            {item.name(), kind_of(item), item.positive("radius", usual.radius), item.places("points", max_points)});
        if (vessels.back().points.size() < 2) item.fail("needs at least two points");
    }
    check_names(all, vessels, "vessels");
    return vessels;
}

std::vector<FlapVessel> vessels_of(const Json& json, const std::string& where) {
    const Members item(json, where, in_metres);
    if (!item.has("vessels")) item.fail("has no 'vessels'");
    return vessels_in(item);
}

Json json_of(const std::vector<FlapVessel>& vessels) {
    Json made = Json::array();
    for (const FlapVessel& v : vessels)
        made.push_back(
            {{"name", v.name}, {"kind", name_of(v.kind)}, {"radius_m", v.radius}, {"points_m", json_of(v.points)}});
    return made;
}

Flap flap_of(const Members& all) {
    Flap flap;
    flap.vessels = vessels_in(all);
    for (const Members& item : all.list("perforators", max_things)) {
        item.know({"name"}, {"at"});
        flap.perforators.push_back({item.name(), item.place("at")});
    }
    for (const Members& item : all.list("sites", max_things)) {
        item.know({"name", "kind"}, {"at"});
        flap.sites.push_back({item.name(), kind_of(item), item.place("at")});
    }
    for (const Members& item : all.list("plates", max_things)) flap.plates.push_back(plate_of(item));
    const DentalImplant implant;
    for (const Members& item : all.list("implants", max_things)) {
        item.know({"name", "axis"}, {"head", "diameter", "length"});
        flap.implants.push_back({item.name(), item.place("head"), item.direction("axis"),
                                 item.positive("diameter", implant.diameter), item.positive("length", implant.length)});
    }
    const SkinPaddle paddle;
    if (const auto item = all.object("paddle")) {
        item->know({}, {"at", "length", "width"});
        flap.paddle = {item->place("at"), item->positive("length", paddle.length),
                       item->positive("width", paddle.width)};
    }
    flap.margin = all.length("margin", flap.margin);
    if (flap.margin < 0.0) all.fail("has a negative margin");
    if (const auto item = all.object("limits")) flap.limits = limits_of(*item);
    check_names(all, flap.perforators, "perforators");
    check_names(all, flap.sites, "sites");
    check_names(all, flap.plates, "plates");
    check_names(all, flap.implants, "implants");
    return flap;
}

void add_members(Json& json, const Flap& flap) {
    const auto list = [](const auto& all, const auto& one) {
        Json made = Json::array();
        for (const auto& each : all) made.push_back(one(each));
        return made;
    };
    json["vessels"] = json_of(flap.vessels);
    json["perforators"] =
        list(flap.perforators, [](const Perforator& p) { return Json{{"name", p.name}, {"at_m", json_of(p.at)}}; });
    json["sites"] = list(flap.sites, [](const RecipientSite& s) {
        return Json{{"name", s.name}, {"kind", name_of(s.kind)}, {"at_m", json_of(s.at)}};
    });
    json["plates"] = list(flap.plates, [&](const Plate& p) {
        Json plate{{"name", p.name},
                   {"width_m", p.width},
                   {"thickness_m", p.thickness},
                   {"points_m", json_of(p.points)},
                   {"outward", json_of(p.outward)},
                   {"screws", list(p.screws, [](const Screw& s) {
                        return Json{{"head_m", json_of(s.head)},
                                    {"axis", json_of(s.axis)},
                                    {"length_m", s.length},
                                    {"diameter_m", s.diameter}};
                    })}};
        if (p.laid) plate["laid"] = {{"height_m", p.laid->height}, {"screws_per_segment", p.laid->screws_per_segment}};
        return plate;
    });
    json["implants"] = list(flap.implants, [](const DentalImplant& i) {
        return Json{{"name", i.name},
                    {"head_m", json_of(i.head)},
                    {"axis", json_of(i.axis)},
                    {"diameter_m", i.diameter},
                    {"length_m", i.length}};
    });
    if (flap.paddle)
        json["paddle"] = {
            {"at_m", json_of(flap.paddle->at)}, {"length_m", flap.paddle->length}, {"width_m", flap.paddle->width}};
    json["margin_m"] = flap.margin;
    json["limits"] = {{"clearance_m", flap.limits.clearance},
                      {"perforator_to_cut_m", flap.limits.perforator_to_cut},
                      {"over_in_situ", flap.limits.over_in_situ},
                      {"kink_radii", flap.limits.kink},
                      {"twist_rad", flap.limits.twist}};
}

}  // namespace tactus::reconstruction
