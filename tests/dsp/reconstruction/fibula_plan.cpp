// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/fibula_plan.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/reconstruction/slabs.hpp"
#include "tests/dsp/reconstruction/donors.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

// A tube of radius 7 mm about the line.
geometry::TriangleSurface tube(const Vec3& from, const Vec3& axis, double length = 330.0 * mm) {
    return tube_of(from, axis, length, 90, 67, [](double, double) { return 7.0 * mm; });
}

// Three segments round an arc of the chin; the inner planes bisect.
FibulaInputs chin() {
    FibulaInputs inputs;
    inputs.planes = {{Vec3(-35, -60, -60) * mm, Vec3(0.3, -0.9, -0.2), {}},
                     {Vec3(-20, -95, -64) * mm, {}, {}},
                     {Vec3(14, -98, -66) * mm, {}, {}},
                     {Vec3(36, -62, -61) * mm, Vec3(0.4, 0.9, 0.1), {}}};
    inputs.line_point = Vec3(90, 10, -120) * mm;
    inputs.line_direction = Vec3(0.09, -0.02, 1.0);
    return inputs;
}

std::string refusal(const FibulaInputs& inputs) {
    try {
        plan_fibula(inputs);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

std::size_t count(const FibulaPlan& plan, PlanWarning code) {
    return static_cast<std::size_t>(std::count_if(plan.warnings.begin(), plan.warnings.end(),
                                                  [&](const FibulaWarning& w) { return w.code == code; }));
}

}  // namespace

TEST_CASE("dsp: the cuts of a fibula mapped to the jaw are the planes of the jaw") {
    const FibulaInputs inputs = chin();
    const FibulaPlan plan = plan_fibula(inputs);
    REQUIRE(plan.segments.size() == 3);
    const Vec3 line = glm::normalize(inputs.line_direction);
    for (std::size_t n = 0; n < 3; ++n) {
        const FibulaSegment& s = plan.segments[n];
        const Vec3 axis = inputs.planes[n + 1].origin - inputs.planes[n].origin;
        CHECK(s.length_centre == Approx(glm::length(axis)));
        CHECK(glm::length(s.donor_to_target.rotate(line) - glm::normalize(axis)) < 1e-9);
        for (std::size_t end = 0; end < 2; ++end) {
            CHECK(glm::length(s.donor_to_target.apply(s.donor_plane[end].origin) - inputs.planes[n + end].origin) <
                  1e-9);
            CHECK(glm::dot(s.donor_plane[end].normal, line) > 0.0);
            CHECK(std::cos(s.tilt[end]) == Approx(glm::dot(s.donor_plane[end].normal, line)));
            if (inputs.planes[n + end].normal) {
                const Vec3 normal = glm::normalize(*inputs.planes[n + end].normal);
                CHECK(glm::length(glm::cross(s.donor_to_target.rotate(s.donor_plane[end].normal), normal)) < 1e-9);
            }
        }
    }
    // At a joint that bisects, both cuts have the same tilt, and with it sections of the same shape.
    for (std::size_t n = 0; n < 2; ++n) {
        CHECK(plan.segments[n].tilt[1] == Approx(plan.segments[n + 1].tilt[0]).margin(1e-9));
        const Vec3 mapped = plan.segments[n].donor_to_target.rotate(plan.segments[n].donor_plane[1].normal),
                   again = plan.segments[n + 1].donor_to_target.rotate(plan.segments[n + 1].donor_plane[0].normal);
        CHECK(glm::length(mapped - again) < 1e-9);
    }
    CHECK(count(plan, PlanWarning::section_mismatch) == 0);
    CHECK_FALSE(plan.clearances[0]);
}

TEST_CASE("dsp: medial of the donor faces the same side of the jaw for either leg") {
    FibulaInputs inputs = chin();
    inputs.line_direction = Vec3(0.0, 0.0, 1.0);
    const FibulaPlan left = plan_fibula(inputs);
    inputs.leg = Leg::right;
    const FibulaPlan right = plan_fibula(inputs);
    for (std::size_t n = 0; n < 3; ++n) {
        // In LPS the left leg's medial side looks to the right: -x.
        const Vec3 a = left.segments[n].donor_to_target.rotate(Vec3(-1.0, 0.0, 0.0)),
                   b = right.segments[n].donor_to_target.rotate(Vec3(1.0, 0.0, 0.0));
        CHECK(glm::length(a - b) < 1e-9);
    }
}

TEST_CASE("dsp: on a tube gaps and lengths follow from its radius") {
    FibulaInputs inputs = chin();
    const Vec3 line = glm::normalize(inputs.line_direction);
    inputs.donor = tube(inputs.line_point, line);
    const FibulaPlan plan = plan_fibula(inputs);
    const double radius = 7.0 * mm;
    // The lowest point of the first cut lies at the distal margin.
    const FibulaSegment& first = plan.segments[0];
    CHECK(first.along_line[0] - radius * std::tan(first.tilt[0]) == Approx(75.0 * mm).margin(0.02 * mm));
    for (std::size_t n = 0; n < 3; ++n) {
        const FibulaSegment& s = plan.segments[n];
        // Length over the cross-section is linear; its extremes lie where both slopes add up.
        const auto slope = [&](std::size_t end) {
            const Vec3& normal = s.donor_plane[end].normal;
            return (normal - glm::dot(normal, line) * line) / glm::dot(normal, line);
        };
        const double swing = radius * glm::length(slope(0) - slope(1));
        CHECK(*s.length_shortest == Approx(s.length_centre - swing).margin(0.02 * mm));
        CHECK(*s.length_longest == Approx(s.length_centre + swing).margin(0.02 * mm));
    }
    for (std::size_t n = 0; n < 2; ++n) CHECK(*plan.clearances[n] == Approx(1.5 * mm).margin(1e-6));
    CHECK(count(plan, PlanWarning::close_osteotomies) == 0);
    CHECK(count(plan, PlanWarning::distal_margin) == 0);
    CHECK(count(plan, PlanWarning::proximal_margin) == 0);

    // Places of the user's own: what is too close is said.
    for (const FibulaSegment& s : plan.segments) inputs.along_line.push_back(s.along_line[0]);
    inputs.along_line[1] -= 1.0 * mm;
    const FibulaPlan close = plan_fibula(inputs);
    CHECK(*close.clearances[0] == Approx(0.5 * mm).margin(1e-6));
    CHECK(*close.clearances[1] == Approx(2.5 * mm).margin(1e-6));
    CHECK(count(close, PlanWarning::close_osteotomies) == 1);
}

TEST_CASE("dsp: a fibula plan warns of short segments and of little bone left and of joints that do not bisect") {
    FibulaInputs inputs = chin();
    inputs.donor = tube(inputs.line_point, glm::normalize(inputs.line_direction), 260.0 * mm);
    CHECK(count(plan_fibula(inputs), PlanWarning::proximal_margin) == 1);
    inputs.planes[1].normal = Vec3(1.0, -0.2, 0.0);
    CHECK(count(plan_fibula(inputs), PlanWarning::section_mismatch) == 1);
    inputs = chin();
    inputs.planes = {{Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)},
                     {Vec3(17, 0, 0) * mm, {}, {}},
                     {Vec3(30, 5, 0) * mm, {}, {}},
                     {Vec3(60, 5, 0) * mm, Vec3(1.0, 0.0, 0.0), {}}};
    const FibulaPlan plan = plan_fibula(inputs);
    CHECK(count(plan, PlanWarning::short_segment) == 1);
    CHECK(count(plan, PlanWarning::very_short_segment) == 1);
    CHECK(plan.warnings[0].segment == 0);
}

TEST_CASE("dsp: a fibula plan that cannot be is refused with its reason") {
    using Catch::Matchers::ContainsSubstring;
    const auto with = [](const std::function<void(FibulaInputs&)>& change) {
        FibulaInputs inputs = chin();
        change(inputs);
        return refusal(inputs);
    };
    CHECK(with([](FibulaInputs&) {}) == "accepted");
    CHECK_THAT(with([](FibulaInputs& i) { i.planes.resize(1); }), ContainsSubstring("1 planes"));
    CHECK_THAT(with([](FibulaInputs& i) { i.planes.resize(7, i.planes[0]); }), ContainsSubstring("7 planes"));
    CHECK_THAT(with([](FibulaInputs& i) { i.planes[1].origin = i.planes[0].origin; }),
               ContainsSubstring("less than 1 mm"));
    CHECK_THAT(with([](FibulaInputs& i) { i.planes[0].normal.reset(); }), ContainsSubstring("needs a normal"));
    CHECK_THAT(with([](FibulaInputs& i) { i.planes[0].normal = Vec3(0.0); }), ContainsSubstring("is no direction"));
    CHECK_THAT(with([](FibulaInputs& i) { i.planes[0].normal = Vec3(0.9, 0.4, 0.0); }), ContainsSubstring("tilted by"));
    CHECK_THAT(with([](FibulaInputs& i) { i.line_direction = Vec3(std::nan("")); }),
               ContainsSubstring("is no direction"));
    CHECK_THAT(with([](FibulaInputs& i) { i.planes[2].origin.x = std::nan(""); }), ContainsSubstring("origins"));
    CHECK_THAT(with([](FibulaInputs& i) { i.along_line = {0.0}; }), ContainsSubstring("1 places"));
    const Vec3 line = glm::normalize(chin().line_direction);
    CHECK_THAT(with([&](FibulaInputs& i) { i.donor = tube(i.line_point, line, 120.0 * mm); }),
               ContainsSubstring("misses the donor"));
    CHECK_THAT(with([&](FibulaInputs& i) {
                   i.donor = tube(i.line_point - line * 20.0 * mm, glm::normalize(line + Vec3(0.25, 0.0, 0.0)));
               }),
               ContainsSubstring("must be"));
}

TEST_CASE("dsp: a marrow cavity and a second bone do not change a fibula plan") {
    FibulaInputs inputs = chin();
    const Vec3 line = glm::normalize(inputs.line_direction);
    inputs.donor = tube(inputs.line_point, line);
    const FibulaPlan plain = plan_fibula(inputs);
    append(*inputs.donor, tube_of(inputs.line_point + line * (20.0 * mm), line, 290.0 * mm, 20, 30,
                                  [](double, double) { return 3.0 * mm; }));
    append(*inputs.donor, tube_of(
                              inputs.line_point - line * (30.0 * mm), line, 400.0 * mm, 20, 30,
                              [](double, double) { return 14.0 * mm; }, [](double) { return Vec3(0.04, 0.0, 0.0); }));
    const FibulaPlan leg = plan_fibula(inputs);
    for (std::size_t n = 0; n < 3; ++n) {
        CHECK(leg.segments[n].along_line[0] == Approx(plain.segments[n].along_line[0]).margin(1e-9));
        CHECK(*leg.segments[n].length_shortest == Approx(*plain.segments[n].length_shortest).margin(1e-9));
    }
    CHECK(*leg.left_distal == Approx(75.0 * mm).margin(1e-6));
    CHECK(*leg.left_proximal == Approx(*plain.left_proximal).margin(1e-9));
    CHECK(leg.warnings.size() == plain.warnings.size());
}

TEST_CASE("dsp: the centre of a section does not depend on how finely its sides are divided") {
    // Twenty points on the front, four on the back.
    geometry::TriangleSurface uneven;
    std::vector<double> turns;
    for (int n = 0; n < 20; ++n) turns.push_back(-0.5 * std::numbers::pi + std::numbers::pi * n / 20.0);
    for (int n = 0; n < 4; ++n) turns.push_back(0.5 * std::numbers::pi + std::numbers::pi * n / 4.0);
    const int count = static_cast<int>(turns.size());
    for (const double z : {0.0, 0.1})
        for (const double a : turns) uneven.vertices.emplace_back(7.0 * mm * std::cos(a), 7.0 * mm * std::sin(a), z);
    for (int n = 0; n < count; ++n) {
        const int m = (n + 1) % count;
        uneven.triangles.push_back({n, m, count + n});
        uneven.triangles.push_back({m, count + m, count + n});
    }
    const Section section = section_of(uneven, {Vec3(0.0, 0.0, 0.05), Vec3(0.0, 0.0, 1.0)});
    CHECK(glm::length(section.centre - Vec3(0.0, 0.0, 0.05)) < 0.4 * mm);
}

TEST_CASE("dsp: cuts of a tube have the area of their ellipses and meet in it") {
    FibulaInputs inputs = chin();
    inputs.donor = tube(inputs.line_point, glm::normalize(inputs.line_direction));
    const FibulaPlan plan = plan_fibula(inputs);
    double all = 0.0;
    for (const FibulaSegment& s : plan.segments)
        for (std::size_t end = 0; end < 2; ++end) {
            const double ellipse = 49.0 * std::numbers::pi * mm * mm / std::cos(s.tilt[end]);
            CHECK(*s.area[end] == Approx(ellipse).epsilon(0.005));
            all += *s.area[end];
            // The two leans are the tilt seen from two sides.
            CHECK(std::hypot(std::tan(s.lean_medial[end]), std::tan(s.lean_anterior[end])) ==
                  Approx(std::tan(s.tilt[end])).margin(1e-9));
        }
    CHECK(*plan.kerf_loss == Approx(0.4 * mm * all));
    // Joints that bisect: the whole faces meet, whatever the roll of a round bone.
    for (std::size_t n = 0; n < 2; ++n) CHECK(*plan.contact[n] == Approx(*plan.segments[n].area[1]).epsilon(0.01));
    // A joint that is turned by 30° against its bisector meets in less than its larger face.
    inputs.planes[1].normal = glm::angleAxis(0.5, Vec3(0.0, 0.0, 1.0)) *
                              glm::normalize(glm::normalize(inputs.planes[1].origin - inputs.planes[0].origin) +
                                             glm::normalize(inputs.planes[2].origin - inputs.planes[1].origin));
    const FibulaPlan skew = plan_fibula(inputs);
    CHECK(*skew.contact[0] < 0.97 * std::max(*skew.segments[0].area[1], *skew.segments[1].area[0]));
    inputs.kerf = -1.0;
    CHECK(refusal(inputs) == "the kerf must be 0 to 10 mm");
}

TEST_CASE("dsp: a fibula that is turned or reversed lies on the same axes") {
    FibulaInputs inputs = chin();
    const Vec3 line = glm::normalize(inputs.line_direction);
    inputs.donor = tube(inputs.line_point, line);
    const FibulaPlan plain = plan_fibula(inputs);
    inputs.roll = std::numbers::pi;
    const FibulaPlan turned = plan_fibula(inputs);
    inputs.roll = 0.0;
    inputs.reversed = true;
    const FibulaPlan reversed = plan_fibula(inputs);
    const Vec3 medial = glm::normalize(glm::cross(line, Vec3(0.0, 1.0, 0.0))), front = glm::cross(line, medial);
    for (std::size_t n = 0; n < 3; ++n) {
        const Pose &a = plain.segments[n].donor_to_target, &b = turned.segments[n].donor_to_target,
                   &c = reversed.segments[n].donor_to_target;
        CHECK(glm::length(a.rotate(line) - b.rotate(line)) < 1e-9);
        CHECK(glm::length(a.rotate(medial) + b.rotate(medial)) < 1e-9);
        CHECK(glm::length(a.rotate(line) + c.rotate(line)) < 1e-9);
        CHECK(glm::length(a.rotate(front) - c.rotate(front)) < 1e-9);
        CHECK(plain.segments[n].length_centre == Approx(reversed.segments[n].length_centre));
        CHECK(plain.segments[n].tilt[1] == Approx(reversed.segments[n].tilt[1]));
        for (std::size_t end = 0; end < 2; ++end)
            for (const FibulaPlan* plan : {&turned, &reversed})
                CHECK(glm::length(plan->segments[n].donor_to_target.apply(plan->segments[n].donor_plane[end].origin) -
                                  inputs.planes[n + end].origin) < 1e-9);
    }
    // The last segment is the lowest.
    CHECK(reversed.segments[2].along_line[1] < reversed.segments[2].along_line[0]);
    CHECK(reversed.segments[2].along_line[0] < reversed.segments[1].along_line[1]);
    CHECK(*reversed.left_distal == Approx(75.0 * mm).margin(1e-6));
    for (std::size_t n = 0; n < 2; ++n) CHECK(*reversed.clearances[n] == Approx(1.5 * mm).margin(1e-6));
}

TEST_CASE("dsp: a quarter of a turn between segments is reported as roll") {
    FibulaInputs inputs = chin();
    CHECK(plan_fibula(inputs).rolls[0] < 20.0 * degree);
    const Vec3 axis = glm::normalize(inputs.planes[2].origin - inputs.planes[1].origin);
    inputs.planes[1].y = glm::cross(axis, Vec3(0.0, 0.0, 1.0));
    CHECK(plan_fibula(inputs).rolls[0] > 70.0 * degree);
}

TEST_CASE("dsp: places of a fibula out of order and lines from the knee down are not taken as they are") {
    using Catch::Matchers::ContainsSubstring;
    FibulaInputs inputs = chin();
    const Vec3 line = glm::normalize(inputs.line_direction);
    inputs.donor = tube(inputs.line_point, line);
    inputs.along_line = {0.2, 0.12, 0.16};
    CHECK_THAT(refusal(inputs), ContainsSubstring("must increase"));
    inputs.along_line = {0.08, std::nan(""), 0.16};
    CHECK_THAT(refusal(inputs), ContainsSubstring("must increase"));
    // Overlap, with the longest reach before the last segment: margins count all segments.
    inputs.along_line = {0.08, 0.081, 0.082};
    const FibulaPlan overlap = plan_fibula(inputs);
    CHECK_THAT(overlap.warnings[0].text, ContainsSubstring("overlap by"));
    double top = 0.0;
    for (const FibulaSegment& s : overlap.segments)
        top = std::max(top, s.along_line[1] + 7.0 * mm * std::tan(s.tilt[1]));
    CHECK(*overlap.left_proximal == Approx(330.0 * mm - top).margin(0.05 * mm));
    inputs.along_line.clear();
    inputs.line_direction = -inputs.line_direction;
    const FibulaPlan down = plan_fibula(inputs);
    REQUIRE(count(down, PlanWarning::line_downwards) == 1);
    CHECK(down.warnings[0].segment == -1);
    inputs = chin();
    inputs.line_direction = Vec3(0.0, 1.0, 0.0);
    CHECK_THAT(refusal(inputs), ContainsSubstring("from front to back"));
    inputs = chin();
    inputs.planes[0] = {Vec3(-45, -60, -10) * mm, Vec3(0.01, 0.0, -1.0), {}};
    inputs.planes[1] = {Vec3(-44.5, -60, -50) * mm, Vec3(0.0, 0.0, -1.0), {}};
    CHECK_THAT(refusal(inputs), ContainsSubstring("give it a y"));
}

TEST_CASE("dsp: a joint that is off its bisector by two degrees is warned of whichever way it is turned") {
    FibulaInputs inputs = chin();
    const Vec3 before = glm::normalize(inputs.planes[1].origin - inputs.planes[0].origin),
               after = glm::normalize(inputs.planes[2].origin - inputs.planes[1].origin);
    const Vec3 bisector = glm::normalize(before + after);
    for (const Vec3& about : {glm::normalize(before - after), glm::normalize(glm::cross(before, after))}) {
        inputs.planes[1].normal = glm::angleAxis(2.0 * degree, about) * bisector;
        CHECK(plan_fibula(inputs).off_bisector[0] == Approx(2.0 * degree));
        CHECK(count(plan_fibula(inputs), PlanWarning::section_mismatch) == 1);
        inputs.planes[1].normal = glm::angleAxis(0.9 * degree, about) * bisector;
        CHECK(count(plan_fibula(inputs), PlanWarning::section_mismatch) == 0);
    }
}

TEST_CASE("dsp: sections overlap by their common area without the marrow cavity") {
    const Vec3 z(0.0, 0.0, 1.0);
    geometry::TriangleSurface hollow = tube(Vec3(0.0), z, 20.0 * mm);
    append(hollow, tube_of(Vec3(0.0), z, 20.0 * mm, 90, 5, [](double, double) { return 3.0 * mm; }));
    const Plane across{Vec3(0.0, 0.0, 10.3 * mm), z};
    const Section ring = section_of(hollow, across);
    CHECK(overlap_area(ring, ring, across) == Approx(pi * (49.0 - 9.0) * 1e-6).epsilon(0.005));
    Section aside = section_of(tube(Vec3(0.0), z, 20.0 * mm), across);
    for (Vec3& p : aside.points) p.x += 7.0 * mm;
    // Two discs of radius r whose centres are r apart share r² (2π/3 - √3/2); the hole lies half inside: 3 < 7.
    const double lens = 49.0 * (2.0 * pi / 3.0 - std::sqrt(3.0) / 2.0) * 1e-6;
    CHECK(overlap_area(section_of(tube(Vec3(0.0), z, 20.0 * mm), across), aside, across) ==
          Approx(lens).epsilon(0.005));
    for (Vec3& p : aside.points) p.x += 10.0 * mm;
    CHECK(overlap_area(ring, aside, across) == 0.0);
}

TEST_CASE("sections by slabs are those of the whole surface, to the bit") {
    const Vec3 from(0.1, 0.05, -0.3), axis = glm::normalize(Vec3(0.1, -0.05, 1.0));
    const geometry::TriangleSurface leg = lower_leg(from, axis);
    const Slabs slabs(leg, from, axis);
    const Random random{12};
    std::size_t met = 0;
    for (std::uint64_t n = 0; n < 400; ++n) {
        const Vec3 lean(random.normal(5 * n), random.normal(5 * n + 1), random.normal(5 * n + 2));
        const Plane plane{from + (-0.05 + 0.45 * random.uniform(5 * n + 3)) * axis,
                          glm::normalize(axis + random.uniform(5 * n + 4) * 1.5 * lean)};
        for (const Vec3* near : {static_cast<const Vec3*>(nullptr), &plane.origin}) {
            const Section a = section_of(leg, plane, near), b = slabs.section(plane, near);
            REQUIRE(a.points.size() == b.points.size());
            CHECK(a.points == b.points);
            CHECK(a.pieces == b.pieces);
            CHECK(a.centre == b.centre);
            CHECK(a.away == b.away);
            met += !a.points.empty();
        }
    }
    CHECK(met > 300);
}
