// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruct/fibula_plan.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruct;

namespace {

constexpr double mm = 1e-3, degree = std::numbers::pi / 180.0;

// A closed tube of radius 7 mm about the line, from 0 to 330 mm.
geometry::TriangleSurface tube(const Vec3& from, const Vec3& axis, double length = 330.0 * mm) {
    geometry::TriangleSurface out;
    const Vec3 side = glm::normalize(glm::cross(axis, Vec3(0.3, 1.0, 0.2))), other = glm::cross(axis, side);
    constexpr int round = 90, rings = 67;
    for (int ring = 0; ring < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            const double a = 2.0 * std::numbers::pi * n / round;
            out.vertices.push_back(from + axis * (length * ring / (rings - 1)) +
                                   7.0 * mm * (std::cos(a) * side + std::sin(a) * other));
        }
    const auto at = [](int ring, int n) { return ring * round + n % round; };
    for (int ring = 0; ring + 1 < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            out.triangles.push_back({at(ring, n), at(ring, n + 1), at(ring + 1, n)});
            out.triangles.push_back({at(ring, n + 1), at(ring + 1, n + 1), at(ring + 1, n)});
        }
    return out;
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
               ContainsSubstring("must be straight"));
}

TEST_CASE("dsp: a thousand random fibula plans are right or refused") {
    std::size_t accepted = 0;
    for (std::uint64_t trial = 0; trial < 1000; ++trial) {
        const Random random{trial + 1};
        std::uint64_t draw = 0;
        const auto normal = [&] { return random.normal(draw++); };
        FibulaInputs inputs;
        const std::size_t planes = 2 + random.bits(draw++) % 5;
        Vec3 at(0.0);
        Vec3 heading = glm::normalize(Vec3(normal(), normal(), normal()));
        for (std::size_t n = 0; n < planes; ++n) {
            inputs.planes.push_back({at, {}, {}});
            if (n == 0 || n + 1 == planes)
                inputs.planes.back().normal = heading + 0.4 * Vec3(normal(), normal(), normal());
            heading = glm::normalize(heading + 0.4 * Vec3(normal(), normal(), normal()));
            at += heading * mm * (4.0 + 40.0 * random.uniform(draw++));
        }
        inputs.line_point = Vec3(normal(), normal(), normal()) * 0.1;
        inputs.line_direction = Vec3(0.2 * normal(), 0.2 * normal(), 1.0);
        inputs.leg = random.bits(draw++) % 2 == 0 ? Leg::left : Leg::right;
        const Vec3 line = glm::normalize(inputs.line_direction);
        inputs.donor = tube(inputs.line_point, line, 0.33);
        FibulaPlan plan;
        try {
            plan = plan_fibula(inputs);
        } catch (const Error&) {
            continue;
        }
        ++accepted;
        const auto along = [&](const Vec3& p) { return glm::dot(p - inputs.line_point, line); };
        for (std::size_t n = 0; n < plan.segments.size(); ++n) {
            const FibulaSegment& s = plan.segments[n];
            for (std::size_t end = 0; end < 2; ++end)
                CHECK(glm::length(s.donor_to_target.apply(s.donor_plane[end].origin) - inputs.planes[n + end].origin) <
                      1e-9);
            const bool is_short = *s.length_shortest < 20.0 * mm;
            const bool is_warned = std::any_of(plan.warnings.begin(), plan.warnings.end(), [&](const FibulaWarning& w) {
                return w.segment == static_cast<int>(n) &&
                       (w.code == PlanWarning::short_segment || w.code == PlanWarning::very_short_segment);
            });
            CHECK(is_short == is_warned);
        }
        // The gap by all vertices of a fine tube that lie between the cuts, not by sections.
        for (std::size_t n = 0; n + 1 < plan.segments.size(); ++n) {
            const Plane &upper = plan.segments[n].donor_plane[1], &lower = plan.segments[n + 1].donor_plane[0];
            const auto reach = [&](const Plane& plane) {
                return 7.0 * mm * std::tan(std::acos(glm::dot(plane.normal, line)));
            };
            const double gap = along(lower.origin) - reach(lower) - along(upper.origin) - reach(upper);
            CHECK(*plan.clearances[n] == Approx(gap).margin(0.1 * mm));
        }
    }
    CHECK(accepted > 300);
}
