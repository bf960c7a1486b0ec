// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/reconstruction/pedicle.hpp"
#include "dsp/reconstruction/plate_line.hpp"
#include "dsp/reconstruction/reach.hpp"
#include "dsp/rope/measure.hpp"
#include "dsp/rope/rope.hpp"
#include "tests/dsp/reconstruction/small_flap.hpp"
#include "tests/support/catch.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

bool has(const FlapMeasures& m, FlapTrouble code, const std::string& object = "") {
    return std::ranges::any_of(m.warnings, [&](const FlapWarning& w) {
        return w.code == code && w.object.find(object) != std::string::npos && !w.text.empty();
    });
}

const Clearance& find(const std::vector<Clearance>& all, const std::string& object, Nearness nearness) {
    const auto found =
        std::ranges::find_if(all, [&](const Clearance& c) { return c.object == object && c.nearness == nearness; });
    REQUIRE(found != all.end());
    return *found;
}

double pedicle_length(const FibulaInputs& in, const Flap& flap) {
    const auto parts = parts_of(flap.vessels[0], in, plan_fibula(in));
    REQUIRE(parts[0].kind == VesselPart::Kind::pedicle);
    return parts[0].length;
}

}  // namespace

TEST_CASE("distances between screws, plates and cuts are those of many points on them") {
    const Random random{4};
    std::uint64_t n = 0;
    const auto any = [&](double size) {
        const Vec3 v(random.normal(n), random.normal(n + 1), random.normal(n + 2));
        n += 3;
        return size * v;
    };
    for (int round = 0; round < 200; ++round) {
        const Capsule a{any(10 * mm), any(10 * mm), 1 * mm}, b{any(10 * mm), any(10 * mm), 2 * mm};
        const Quat turn = glm::normalize(Quat(random.normal(n), random.normal(n + 1), random.normal(n + 2), 0.3));
        n += 3;
        const Block block{any(10 * mm), glm::mat3_cast(turn), {4 * mm, 3.5 * mm, 1.25 * mm}};
        const Disc disc{any(10 * mm), glm::normalize(any(1.0)), 8 * mm};
        double to_capsule = 1.0, to_block = 1.0, to_disc = 1.0;
        constexpr int steps = 400;
        for (int i = 0; i <= steps; ++i) {
            const Vec3 p = glm::mix(a.a, a.b, static_cast<double>(i) / steps);
            for (int k = 0; k <= steps; ++k)
                to_capsule = std::min(to_capsule, glm::length(p - glm::mix(b.a, b.b, static_cast<double>(k) / steps)));
            const Vec3 q = glm::transpose(block.axes) * (p - block.centre);
            to_block = std::min(to_block, glm::length(q - glm::clamp(q, -block.half, block.half)));
            const double h = glm::dot(p - disc.centre, disc.normal),
                         in = glm::length(p - disc.centre - h * disc.normal);
            to_disc = std::min(to_disc, in > disc.radius ? std::hypot(h, in - disc.radius) : std::abs(h));
        }
        const double tolerance = 0.5 * glm::length(a.b - a.a) / steps + 0.5 * glm::length(b.b - b.a) / steps;
        CHECK(distance(a, b) <= to_capsule - 3 * mm + 1e-9);
        CHECK(distance(a, b) >= to_capsule - 3 * mm - tolerance);
        CHECK(distance(a, block) <= to_block - 1 * mm + 1e-9);
        CHECK(distance(a, block) >= to_block - 1 * mm - tolerance);
        CHECK(distance(a, disc) <= to_disc - 1 * mm + 1e-9);
        CHECK(distance(a, disc) >= to_disc - 1 * mm - tolerance);
    }
}

TEST_CASE("the pedicle is what was stripped off discarded bone, and a cut farther from the knee makes it longer") {
    FibulaInputs in = small_inputs();
    const Flap flap = small_flap();
    in.along_line = {80 * mm, 130 * mm};
    const double before = pedicle_length(in, flap);
    const FibulaPlan plan = plan_fibula(in);
    const std::vector<VesselPart> parts = parts_of(flap.vessels[0], in, plan);
    // In the leg: from the end of the vessel at 330 mm to the last cut, which leans by 14.04 degrees at 10 mm aside.
    CHECK(before == Approx(330 * mm - plan.segments[1].along_line[1]).margin(3 * mm));
    double all = 0.0;
    for (const VesselPart& part : parts) all += part.length;
    CHECK(all == Approx(330 * mm).epsilon(1e-9));
    // Only the wedge and what lies beyond the last segment is off the bone besides the pedicle.
    std::vector<VesselPart::Kind> kinds;
    for (const VesselPart& part : parts) kinds.push_back(part.kind);
    using enum VesselPart::Kind;
    CHECK(kinds == std::vector{pedicle, attached, span, attached, lost});
    // What is attached keeps its shape: a point goes with its segment.
    const PlacedVessel there = placed(flap.vessels[0], parts, plan);
    CHECK(rope::length_of(there.lines[0]) >= parts[1].length + parts[3].length);
    CHECK(glm::length(there.lines[0].front() - plan.segments[1].donor_to_target.apply(parts[1].points.front())) <
          1e-12);
    // Both segments 20 mm nearer to the ankle.
    in.along_line = {60 * mm, 110 * mm};
    CHECK(pedicle_length(in, flap) == Approx(before + 20 * mm).margin(1e-9));
    // Only the cut at the knee's end moves, by a shorter last segment.
    FibulaInputs shorter = in;
    shorter.along_line = {80 * mm, 130 * mm};
    shorter.planes[2].origin.x -= 12 * mm;
    CHECK(pedicle_length(shorter, flap) > before + 10 * mm);
}

TEST_CASE("a vessel's free length, strain and tension at a site are those of the material") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    const PlacedVessel at = placed(flap.vessels[0], parts_of(flap.vessels[0], in, plan), plan);
    const Vec3 exit = at.lines[0].front(), away = glm::normalize(Vec3(1.0, 0.3, -0.2));
    const double in_situ = pedicle_length(in, flap);
    for (const auto& [over, reach] :
         {std::pair{0.5, Reach::slack}, {1.0, Reach::in_situ}, {1.05, Reach::stretched}, {1.2, Reach::too_short}}) {
        flap.sites = {{"there", VesselKind::artery, exit + over * in_situ * away}};
        const FlapMeasures m = measure_flap(in, plan, flap, nullptr);
        REQUIRE(m.reaches.size() == 1);
        const SiteReach& r = m.reaches[0];
        CHECK(r.in_situ == Approx(in_situ));
        CHECK(r.free == Approx(0.89 * in_situ));
        CHECK(r.path == Approx(over * in_situ).epsilon(1e-6));
        const double strain = std::max(over / 0.89 - 1.0, 0.0);
        CHECK(r.strain == Approx(strain).margin(1e-6));
        CHECK(r.slack == Approx(std::max(0.89 - over, 0.0) * in_situ).margin(1e-6));
        REQUIRE(r.tension);
        CHECK(*r.tension == Approx(rope::artery().stiffness * strain).epsilon(1e-4).margin(1e-6));
        CHECK(r.reach == reach);
        CHECK(has(m, FlapTrouble::too_short, "peroneal") == (reach == Reach::too_short));
        CHECK(has(m, FlapTrouble::stretched, "peroneal") == (reach == Reach::stretched));
        CHECK(has(m, FlapTrouble::no_site, "comitant"));
    }
    // A vein has reach but no newtons.
    flap.sites = {{"there", VesselKind::vein, exit + 1.1 * in_situ * away}};
    const FlapMeasures m = measure_flap(in, plan, flap, nullptr);
    CHECK(m.reaches[0].strain > 0.2);
    CHECK_FALSE(m.reaches[0].tension);
}

TEST_CASE("the way to a site goes round bone, as long as the geodesic") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    flap.vessels.pop_back();
    const PlacedVessel at = placed(flap.vessels[0], parts_of(flap.vessels[0], in, plan), plan);
    const Vec3 exit = at.lines[0].front();
    // A column upright 30 mm beside the exit, and the site on its other side, level: two tangents and an arc.
    const double r = 12 * mm + flap.vessels[0].radius, d = 30 * mm;
    const rope::Cylinder column(exit + Vec3(d, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), 12 * mm);
    flap.sites = {{"behind", VesselKind::artery, exit + Vec3(2.0 * d, 0.0, 0.0)}};
    const SiteReach found = measure_flap(in, plan, flap, &column).reaches[0];
    const double exact = 2.0 * std::sqrt(d * d - r * r) + 2.0 * r * std::asin(r / d);
    CHECK(found.path == Approx(exact).epsilon(0.005));
    CHECK(found.is_settled);
    CHECK(found.contact == Approx(2.0 * r * std::asin(r / d)).margin(4 * mm));
    // The column bends it, but the corner at the bone may be tighter.
    CHECK(found.bend_radius <= r * 1.1);
}

TEST_CASE("an artery whose vein changes sides is twisted by the angle between them") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    const PlacedVessel artery = placed(flap.vessels[0], parts_of(flap.vessels[0], in, plan), plan),
                       vein = placed(flap.vessels[1], parts_of(flap.vessels[1], in, plan), plan);
    const Vec3 exit = artery.lines[0].front(), beside = vein.lines[0].front() - exit, along(1.0, 0.0, 0.0);
    const Vec3 across = beside - glm::dot(beside, along) * along;
    for (const double turn : {0.0, 0.5, 1.4, 1.7, -2.5}) {
        const Vec3 there = exit + 60 * mm * along;
        flap.sites = {{"a", VesselKind::artery, there},
                      {"v", VesselKind::vein, there + glm::angleAxis(turn, along) * across}};
        const FlapMeasures m = measure_flap(in, plan, flap, nullptr);
        REQUIRE(m.reaches[0].twist);
        CHECK(*m.reaches[0].twist == Approx(turn).margin(1e-6));
        CHECK(has(m, FlapTrouble::twisted) == (std::abs(turn) > pi / 2.0));
    }
}

TEST_CASE("a vessel that turns back at the bone is kinked, unless it is slack by the length of a wider bend") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    flap.vessels.pop_back();
    const PlacedVessel at = placed(flap.vessels[0], parts_of(flap.vessels[0], in, plan), plan);
    const Vec3 exit = at.lines[0].front(), back = glm::normalize(at.lines[0][1] - exit);
    const double free = 0.89 * pedicle_length(in, flap), least = flap.limits.kink * flap.vessels[0].radius;
    for (const double slack : {-1.0 * mm, 2.0 * mm, pi * least - 1.0 * mm, pi * least + 1.0 * mm, 30.0 * mm}) {
        CAPTURE(slack);
        flap.sites = {{"behind", VesselKind::artery, exit + (free - slack) * back}};
        const FlapMeasures m = measure_flap(in, plan, flap, nullptr);
        CHECK(m.reaches[0].bend_radius < least);
        CHECK(m.reaches[0].slack == Approx(std::max(slack, 0.0)).margin(1e-6));
        CHECK(has(m, FlapTrouble::kinked) == (slack < pi * least));
    }
    // Straight on there is no bend.
    flap.sites = {{"ahead", VesselKind::artery, exit - (free - 2.0 * mm) * back}};
    CHECK_FALSE(has(measure_flap(in, plan, flap, nullptr), FlapTrouble::kinked));
}

TEST_CASE("two plates that come near each other are warned of, and those that cross") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    const auto plate = [](const char* name, const Vec3& from, const Vec3& to) {
        return Plate{name, 7 * mm, 2.5 * mm, {from, to}, {{0, 0, 1}, {0, 0, 1}}, {}};
    };
    const Vec3 a(0, 0, 200 * mm), b(40 * mm, 0, 200 * mm);
    flap.plates = {plate("low", a, b), plate("high", a + Vec3(0, 7.4 * mm, 0), b + Vec3(0, 7.4 * mm, 0))};
    FlapMeasures m = measure_flap(in, plan, flap, nullptr);
    CHECK(find(m.clearances, "plate 'low'", Nearness::to_hardware).distance == Approx(0.4 * mm).margin(1e-7));
    CHECK(has(m, FlapTrouble::near_hardware, "plate 'high'"));
    // Crossed like a plus, where no corner lies in the other one.
    flap.plates[1] = plate("high", {20 * mm, -20 * mm, 200 * mm}, {20 * mm, 20 * mm, 200 * mm});
    m = measure_flap(in, plan, flap, nullptr);
    CHECK(find(m.clearances, "plate 'low'", Nearness::to_hardware).distance == Approx(0.0).margin(1e-7));
    flap.plates[1] = plate("high", {20 * mm, -20 * mm, 210 * mm}, {20 * mm, 20 * mm, 210 * mm});
    m = measure_flap(in, plan, flap, nullptr);
    CHECK(find(m.clearances, "plate 'low'", Nearness::to_hardware).distance == Approx(7.5 * mm).margin(1e-7));
    CHECK_FALSE(has(m, FlapTrouble::near_hardware));
}

TEST_CASE("a site where the vessel leaves the bone is reached without a way") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    flap.sites = {{"here", VesselKind::artery,
                   placed(flap.vessels[0], parts_of(flap.vessels[0], in, plan), plan).lines[0].front()}};
    const FlapMeasures m = measure_flap(in, plan, flap, nullptr);
    REQUIRE(m.reaches.size() == 1);
    CHECK(m.reaches[0].path < 1e-6);
    CHECK(m.reaches[0].reach == Reach::slack);
}

TEST_CASE("plates, screws and implants that come near cuts, vessels and each other are named with the distance") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    flap.plates = {plate_on(in, plan)};
    flap.plates[0].name = "front";
    // The plate lies on the bone's outside, 7 mm from the axis; vessels lie below: nothing is near.
    for (const Vec3& p : flap.plates[0].points) CHECK(std::abs(p.z) < 1e-6);
    CHECK(flap.plates[0].points[2].y < -7 * mm);
    FlapMeasures m = measure_flap(in, plan, flap, nullptr);
    CHECK_FALSE(has(m, FlapTrouble::near_vessel));
    CHECK_FALSE(has(m, FlapTrouble::near_cut));
    REQUIRE(flap.plates[0].screws.size() == 4);

    // Away from the plate:
    flap.plates[0].points = {{0, 0, 200 * mm}, {10 * mm, 0, 200 * mm}};
    flap.plates[0].outward = {{0, 0, 1}, {0, 0, 1}};
    // A screw 0.5 mm beside the joint, along the cut.
    flap.plates[0].screws = {{{1.5 * mm, -20 * mm, 0}, {0, 1, 0}, 12 * mm, 2 * mm}};
    m = measure_flap(in, plan, flap, nullptr);
    CHECK(find(m.clearances, "screw 1 of plate 'front'", Nearness::to_cut).distance == Approx(0.5 * mm).margin(1e-7));
    CHECK(find(m.clearances, "screw 1 of plate 'front'", Nearness::to_cut).other == "cut 2");
    CHECK(has(m, FlapTrouble::near_cut, "screw 1"));
    // An implant that meets the screw, and one that is 2 mm away from it.
    flap.implants = {{"left", {3.5 * mm, -14 * mm, 8 * mm}, {0, 0, -1}, 4 * mm, 14 * mm},
                     {"right", {-5.5 * mm, -14 * mm, 8 * mm}, {0, 0, -1}, 4 * mm, 14 * mm}};
    m = measure_flap(in, plan, flap, nullptr);
    CHECK(find(m.clearances, "implant 'left'", Nearness::to_hardware).distance == Approx(-1.0 * mm).margin(1e-7));
    CHECK(find(m.clearances, "implant 'right'", Nearness::to_hardware).distance == Approx(4.0 * mm).margin(1e-7));
    CHECK(has(m, FlapTrouble::near_hardware, "implant 'left'"));
    CHECK_FALSE(has(m, FlapTrouble::near_hardware, "implant 'right'"));
    // An implant down to the artery, which lies 10 mm below the axis.
    flap.implants = {{"deep", {20 * mm, -5 * mm, 8 * mm}, {0, 0, -1}, 4 * mm, 16 * mm}};
    m = measure_flap(in, plan, flap, nullptr);
    CHECK(find(m.clearances, "implant 'deep'", Nearness::to_vessel).distance < 0.0);
    CHECK(has(m, FlapTrouble::near_vessel, "implant 'deep'"));
}

TEST_CASE("perforators on cuts or off the kept bone, and a paddle without one, are warned of") {
    FibulaInputs in = small_inputs();
    in.along_line = {80 * mm, 130 * mm};
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    const auto at = [&](double along) { return in.line_point + Vec3(0.0, 0.0, along); };
    const double cut = plan.segments[0].along_line[1], tilt = std::cos(plan.segments[0].tilt[1]);
    flap.perforators = {{"middle", at(100 * mm)}, {"edge", at(cut - 2 * mm / tilt)}, {"wedge", at(cut + 2 * mm)}};
    flap.paddle = SkinPaddle{at(100 * mm), 60 * mm, 40 * mm};
    FlapMeasures m = measure_flap(in, plan, flap, nullptr);
    CHECK_FALSE(has(m, FlapTrouble::perforator_on_cut, "middle"));
    CHECK(has(m, FlapTrouble::perforator_on_cut, "edge"));
    CHECK(has(m, FlapTrouble::perforator_lost, "wedge"));
    for (const FlapWarning& w : m.warnings)
        if (w.object == "perforator 'edge'") CHECK(w.number == Approx(2 * mm).margin(1e-9));
    CHECK_FALSE(has(m, FlapTrouble::paddle_without_perforator));
    // The same paddle 70 mm farther up has none: the one on kept bone lies too low, and the others are lost.
    flap.paddle->at = at(200 * mm);
    CHECK(has(measure_flap(in, plan, flap, nullptr), FlapTrouble::paddle_without_perforator));
}

TEST_CASE("a tumour nearer to a cut of the jaw than the margin is warned of, on the resected side") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    flap.margin = 10 * mm;
    for (const auto& [x, margin] : {std::pair{0.0, 40.0}, {34.0, 6.0}, {-45.0, -5.0}}) {
        const std::vector<Vec3> tumour{{x * mm, 0, 0}, {0, 0, 5 * mm}};
        const FlapMeasures m = measure_flap(in, plan, flap, nullptr, tumour);
        REQUIRE(m.tumour_margin);
        CHECK(*m.tumour_margin == Approx(margin * mm).margin(1e-9));
        CHECK(has(m, FlapTrouble::tumour_margin) == (margin < 10.0));
        // The cuts of the jaw stay where they are when segments are moved, or lie in the leg still.
        FibulaPlan moved = plan;
        for (FibulaSegment& segment : moved.segments) segment.donor_to_target = {};
        CHECK(measure_flap(in, moved, flap, nullptr, tumour).tumour_margin == m.tumour_margin);
        CHECK(std::abs(glm::dot(cuts_of(in, moved)[1].normal, cuts_of(in, plan)[1].normal)) == Approx(1.0));
    }
    FibulaInputs open = in;
    open.resection = Resection::none;
    CHECK_FALSE(measure_flap(open, plan, flap, nullptr, std::vector{Vec3(0.0)}).tumour_margin);
}

TEST_CASE("a flap without an artery or a vein is warned of") {
    const FibulaInputs in = small_inputs();
    const FibulaPlan plan = plan_fibula(in);
    Flap flap = small_flap();
    CHECK_FALSE(has(measure_flap(in, plan, flap, nullptr), FlapTrouble::no_vein));
    flap.vessels.pop_back();
    CHECK(has(measure_flap(in, plan, flap, nullptr), FlapTrouble::no_vein));
    CHECK_FALSE(has(measure_flap(in, plan, Flap{}, nullptr), FlapTrouble::no_vein));
}
