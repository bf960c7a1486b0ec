// SPDX-License-Identifier: Apache-2.0
// Random flaps of the synthetic case against a check in Python that measures by brute force.
#include "assets/library/flap_bones.hpp"
#include "assets/library/flap_case.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/reconstruction/cut.hpp"
#include "dsp/reconstruction/flap_obstacle.hpp"
#include "dsp/reconstruction/jaw_normal.hpp"
#include "dsp/reconstruction/plate_line.hpp"
#include "dsp/reconstruction/reach.hpp"
#include "dsp/rope/bone_field.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

using namespace tactus;
using namespace tactus::reconstruction;
using file::Json;

namespace {

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

Json json_of(std::span<const Vec3> points) {
    Json list = Json::array();
    for (const Vec3& p : points) list.push_back(json_of(p));
    return list;
}

Json json_of(const geometry::TriangleSurface& surface) {
    Json triangles = Json::array();
    for (const auto& t : surface.triangles) triangles.push_back({t[0], t[1], t[2]});
    return {{"vertices", json_of(surface.vertices)}, {"triangles", triangles}};
}

Json matrix_of(const Pose& pose) {
    const Mat3 turn = glm::mat3_cast(pose.orientation);
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({turn[0][row], turn[1][row], turn[2][row], pose.position[row]});
    return rows;
}

/// The distances round a closed surface.
struct Field {
    contact::Voxmap map;
    rope::BoneField field;

    explicit Field(const geometry::TriangleSurface& surface) : map(made(surface)), field(map) {}
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;

    static contact::Voxmap made(const geometry::TriangleSurface& surface) {
        constexpr double spacing = 0.8 * mm, margin = 12.0 * mm;
        Vec3 low = surface.vertices.front(), high = low;
        for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
        volume::Grid layout;
        layout.origin = low - margin;
        layout.spacing = Vec3(spacing);
        for (int a = 0; a < 3; ++a)
            layout.size[static_cast<std::size_t>(a)] =
                static_cast<int>(std::ceil((high[a] - low[a] + 2.0 * margin) / spacing)) + 1;
        return contact::make_voxmap(volume::signed_distance(layout, surface));
    }
};

class Draw {
public:
    explicit Draw(std::uint64_t seed) : random_{seed} {}
    double uniform(double low, double high) { return low + (high - low) * random_.uniform(count_++); }
    bool chance(double share) { return uniform(0.0, 1.0) < share; }
    Vec3 vector(double size) {
        const double x = random_.normal(count_++), y = random_.normal(count_++), z = random_.normal(count_++);
        return size * Vec3(x, y, z);
    }
    int whole(int low, int high) {
        return low + static_cast<int>(random_.bits(count_++) % static_cast<std::uint64_t>(high - low + 1));
    }

private:
    Random random_;
    std::uint64_t count_ = 0;
};

FibulaInputs random_inputs(const library::FlapCase& made, Draw& draw) {
    FibulaInputs in = made.inputs;
    for (JawPlane& plane : in.planes) {
        plane.origin += draw.vector(1.5 * mm);
        if (plane.normal) plane.normal = *plane.normal + draw.vector(0.08);
    }
    // Short segments, too.
    if (draw.chance(0.3))
        in.planes[1].origin = glm::mix(in.planes[1].origin, in.planes[0].origin, draw.uniform(0.2, 0.6));
    if (draw.chance(0.15)) in.planes.erase(in.planes.begin() + 1);
    if (draw.chance(0.7)) in.roll += draw.uniform(-0.5, 0.5);
    else in.roll = draw.uniform(-std::numbers::pi, std::numbers::pi);
    in.reversed = draw.chance(0.25);
    in.between = draw.uniform(0.0, 4.0) * mm;
    in.distal_margin = draw.uniform(50.0, 130.0) * mm;
    if (draw.chance(0.3)) {
        double along = -draw.uniform(60.0, 110.0) * mm;
        for (std::size_t n = 0; n + 1 < in.planes.size(); ++n) {
            in.along_line.push_back(along);
            along += draw.uniform(38.0, 60.0) * mm;
        }
        if (in.reversed) std::ranges::reverse(in.along_line);
    }
    in.resection = std::array{Resection::between, Resection::after_first, Resection::before_last,
                              Resection::none}[static_cast<std::size_t>(draw.chance(0.6) ? 0 : draw.whole(0, 3))];
    return in;
}

FlapVessel vessel_of(const vessel::Track& track, const char* name, VesselKind kind, Draw& draw) {
    FlapVessel vessel{name, kind, draw.uniform(1.0, 2.2) * mm, {}};
    const auto& nodes = track.branches[0].nodes;
    // Some begin below the last cut at the knee: no pedicle is left.
    const std::size_t from = draw.chance(0.1) ? nodes.size() / 3 : 0;
    for (std::size_t n = from; n < nodes.size(); ++n) vessel.points.push_back(nodes[n].position);
    if (draw.chance(0.5)) std::ranges::reverse(vessel.points);
    const Vec3 aside = draw.vector(0.7 * mm);
    for (Vec3& p : vessel.points) p += aside;
    return vessel;
}

Flap random_flap(const library::FlapCase& made, const FibulaInputs& in, const FibulaPlan& plan, Draw& draw) {
    Flap flap;
    if (!draw.chance(0.05)) flap.vessels.push_back(vessel_of(made.artery, "peroneal", VesselKind::artery, draw));
    if (!draw.chance(0.05)) flap.vessels.push_back(vessel_of(made.vein, "comitant", VesselKind::vein, draw));
    for (const library::NamedPoint& site : made.sites) {
        const bool is_vein = site.name.find("vein") != std::string::npos;
        // A few sites, so that the best one is not always near.
        if (!draw.chance(0.35)) continue;
        flap.sites.push_back({site.name, is_vein ? VesselKind::vein : VesselKind::artery,
                              site.position + draw.vector(draw.chance(0.5) ? 6.0 * mm : 20.0 * mm)});
    }
    for (const library::NamedPoint& mark : made.perforators)
        flap.perforators.push_back({mark.name, mark.position + Vec3(0.0, 0.0, draw.uniform(-25.0, 25.0) * mm)});
    for (int n = draw.whole(0, 2); n > 0; --n) {
        PlateSettings settings;
        settings.screw_length = draw.uniform(6.0, 18.0) * mm;
        settings.screws_per_segment = draw.whole(0, 3);
        settings.height = (n == 2 ? 5.0 : -1.0) * mm + draw.uniform(-2.0, 2.0) * mm;
        try {
            flap.plates.push_back(plate_on(in, plan, settings));
            flap.plates.back().name = fmt::format("plate {}", n);
        } catch (const Error&) {
            // No bone at that height.
        }
    }
    for (int n = draw.whole(0, 3); n > 0; --n) {
        const std::size_t segment = static_cast<std::size_t>(draw.whole(0, static_cast<int>(in.planes.size()) - 2));
        const Vec3 on = glm::mix(in.planes[segment].origin, in.planes[segment + 1].origin, draw.uniform(0.05, 0.95));
        const Vec3 axis = glm::normalize(Vec3(0.0, 0.0, -1.0) + draw.vector(0.2));
        flap.implants.push_back({fmt::format("implant {}", n), on - draw.uniform(4.0, 8.0) * mm * axis, axis,
                                 draw.uniform(3.0, 5.0) * mm, draw.uniform(8.0, 16.0) * mm});
    }
    if (draw.chance(0.6))
        flap.paddle = SkinPaddle{in.line_point + in.line_direction * draw.uniform(-150.0, 150.0) * mm,
                                 draw.uniform(10.0, 80.0) * mm, 40.0 * mm};
    flap.margin = draw.uniform(3.0, 15.0) * mm;
    flap.limits.clearance = draw.uniform(0.2, 4.0) * mm;
    flap.limits.perforator_to_cut = draw.uniform(1.0, 8.0) * mm;
    flap.limits.over_in_situ = draw.uniform(0.02, 0.25);
    flap.limits.kink = draw.uniform(2.0, 8.0);
    flap.limits.twist = draw.uniform(20.0, 150.0) * degree;
    return flap;
}

std::vector<Vec3> random_tumour(Draw& draw) {
    const Vec3 middle = library::arch_point(draw.uniform(0.0, 0.8)) + draw.vector(2.0 * mm);
    const double radius = draw.uniform(2.0, 15.0) * mm;
    std::vector<Vec3> points;
    for (int n = 0; n < 60; ++n) points.push_back(middle + radius * glm::normalize(draw.vector(1.0)));
    return points;
}

Json measured(const FlapMeasures& m) {
    Json reaches = Json::array(), clearances = Json::array(), spans = Json::array(), warnings = Json::array();
    for (const SiteReach& r : m.reaches)
        reaches.push_back({{"vessel", r.vessel},
                           {"site", r.site},
                           {"reach", name_of(r.reach)},
                           {"in_situ", r.in_situ},
                           {"free", r.free},
                           {"path", r.path},
                           {"settled", r.is_settled},
                           {"slack", r.slack},
                           {"strain", r.strain},
                           {"tension", r.tension ? Json(*r.tension) : Json(nullptr)},
                           {"bend", std::isfinite(r.bend_radius) ? Json(r.bend_radius) : Json(nullptr)},
                           {"twist", r.twist ? Json(*r.twist) : Json(nullptr)},
                           {"to_plate", r.to_plate ? Json(*r.to_plate) : Json(nullptr)},
                           {"to_screw", r.to_screw ? Json(*r.to_screw) : Json(nullptr)},
                           {"points", json_of(r.points)}});
    for (const Clearance& c : m.clearances) clearances.push_back({c.object, name_of(c.nearness), c.other, c.distance});
    for (const SpanReach& s : m.spans)
        spans.push_back({s.vessel, static_cast<int>(s.first), static_cast<int>(s.second), s.in_situ, s.path, s.strain});
    for (const FlapWarning& w : m.warnings)
        warnings.push_back(
            {name_of(w.code), w.object, w.other, std::isfinite(w.number) ? Json(w.number) : Json(nullptr)});
    return {{"reaches", reaches},
            {"clearances", clearances},
            {"spans", spans},
            {"tumour_margin", m.tumour_margin ? Json(*m.tumour_margin) : Json(nullptr)},
            {"warnings", warnings}};
}

void check_random_flaps(int count) {
    if (std::system("/usr/bin/python3 -c 'import numpy, scipy' 2>/dev/null") != 0)
        return tactus::test::skip("no python3 with numpy and scipy here");
    const library::FlapCase made = library::make_flap();
    FibulaInputs nominal = made.inputs;
    nominal.donor = made.fibula;
    const FibulaPlan first = plan_fibula(nominal);
    // The jaw is resected: its stumps stay where they are, whatever is planned.
    const std::size_t last = nominal.planes.size() - 1;
    const CutPieces jaw = cut_between(made.jaw, {nominal.planes[0].origin, jaw_normal(nominal, 0)},
                                      Plane{nominal.planes[last].origin, jaw_normal(nominal, last)});
    REQUIRE(jaw.rest.size() == 2);
    const Field donor(made.fibula), left(jaw.rest[0].surface), right(jaw.rest[1].surface);
    const std::array<const rope::Obstacle*, 2> stumps{&left.field, &right.field};
    const auto path = std::filesystem::temp_directory_path() / fmt::format("tactus_flaps_{}", ::getpid());
    int accepted = 0;
    {
        std::ofstream out(path);
        out << Json{{"donor", json_of(made.fibula)},
                    {"stumps", Json::array({json_of(jaw.rest[0].surface), json_of(jaw.rest[1].surface)})}}
                   .dump()
            << "\n";
        for (std::uint64_t trial = 0; accepted < count && trial < 4 * static_cast<std::uint64_t>(count); ++trial) {
            Draw draw(trial + 1);
            Reconstruction all;
            all.inputs = random_inputs(made, draw);
            all.inputs.donor = made.fibula;
            all.inputs.jaw = made.jaw;
            FibulaPlan plan;
            try {
                plan = plan_fibula(all.inputs);
            } catch (const Error&) {
                continue;  // planes that meet inside the bone, places that are out of order
            }
            all.flap = random_flap(made, all.inputs, plan, draw);
            const std::vector<Vec3> tumour = draw.chance(0.5) ? random_tumour(draw) : std::vector<Vec3>{};
            const FlapObstacle bone(plan, stumps, &donor.field);
            const FlapMeasures measures = measure_flap(all.inputs, plan, all.flap, &bone, tumour);
            Json poses = Json::array();
            for (const FibulaSegment& s : plan.segments) poses.push_back(matrix_of(s.donor_to_target));
            Json given = json_of(all);
            out << Json{{"given", given}, {"tumour", json_of(tumour)}, {"poses", poses}, {"said", measured(measures)}}
                       .dump()
                << "\n";
            ++accepted;
        }
    }
    CHECK(accepted == count);
    const std::string script = (tactus::test::source_folder() / "tests/assets/library/check_flaps.py").string();
    CHECK(std::system(fmt::format("/usr/bin/python3 '{}' '{}'", script, path.string()).c_str()) == 0);
    std::filesystem::remove(path);
}

}  // namespace

// Costly: brute force in Python over every triangle.
TEST_CASE("random flaps of the synthetic case have the measures and warnings that brute force in Python gives",
          "[slow]") {
    check_random_flaps(5);
}

TEST_CASE("twenty random flaps, or TACTUS_FLAP_PLANS, have the measures and warnings of brute force in Python",
          "[long]") {
    const char* const wanted = std::getenv("TACTUS_FLAP_PLANS");
    check_random_flaps(wanted ? std::atoi(wanted) : 20);
}
