// SPDX-License-Identifier: Apache-2.0
// Random fibula plans against a check in Python that cuts the donor's triangles by itself.
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "tests/dsp/reconstruction/donors.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/quaternion.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

std::string text(const Vec3& v) { return fmt::format("[{:.17g},{:.17g},{:.17g}]", v.x, v.y, v.z); }

FibulaInputs random_inputs(std::uint64_t trial, const Vec3& point, const Vec3& line) {
    const Random random{trial + 1};
    std::uint64_t draw = 0;
    const auto normal = [&] { return random.normal(draw++); };
    const auto uniform = [&] { return random.uniform(draw++); };
    FibulaInputs inputs;
    const std::size_t planes = 2 + random.bits(draw++) % 4;
    Vec3 at(0.0), heading = glm::normalize(Vec3(normal(), normal(), 0.5 * normal()));
    for (std::size_t n = 0; n < planes; ++n) {
        inputs.planes.push_back({at, {}, {}});
        if (n == 0 || n + 1 == planes || uniform() < 0.2)
            inputs.planes.back().normal = heading + 0.25 * Vec3(normal(), normal(), normal());
        if (uniform() < 0.3) inputs.planes.back().y = Vec3(normal(), normal(), normal());
        heading = glm::normalize(heading + 0.25 * Vec3(normal(), normal(), 0.5 * normal()));
        at += heading * mm * (9.0 + 35.0 * uniform());
    }
    inputs.line_point = point;
    // The same bone, with the line drawn from either end.
    inputs.line_direction = uniform() < 0.15 ? -3.0 * line : 3.0 * line;
    inputs.leg = uniform() < 0.5 ? Leg::left : Leg::right;
    inputs.reversed = uniform() < 0.3;
    if (uniform() < 0.3) inputs.roll = 2.0 * std::numbers::pi * uniform();
    inputs.between = 3.0 * mm * uniform();
    inputs.kerf = mm * uniform();
    inputs.distal_margin = (40.0 + 60.0 * uniform()) * mm;
    inputs.proximal_margin = (40.0 + 160.0 * uniform()) * mm;
    if (uniform() < 0.4) {
        const double low = inputs.line_direction.z > 0.0 ? 0.0 : -330.0 * mm;
        double s = low + (30.0 + 80.0 * uniform()) * mm;
        for (std::size_t n = 0; n + 1 < planes; ++n) {
            inputs.along_line.push_back(s);
            s += mm * 60.0 * uniform();
        }
        if (inputs.reversed) std::ranges::reverse(inputs.along_line);
    }
    return inputs;
}

std::string line_of(const FibulaInputs& inputs, const FibulaPlan& plan) {
    std::vector<std::string> planes, segments, warnings;
    for (const JawPlane& p : inputs.planes)
        planes.push_back(
            fmt::format(R"({{"origin":{},"normal":{}}})", text(p.origin / mm), p.normal ? text(*p.normal) : "null"));
    for (const FibulaSegment& s : plan.segments) {
        const Mat3 turn = glm::mat3_cast(s.donor_to_target.orientation);
        std::vector<std::string> rows;
        for (int row = 0; row < 3; ++row)
            rows.push_back(fmt::format("[{:.17g},{:.17g},{:.17g},{:.17g}]", turn[0][row], turn[1][row], turn[2][row],
                                       s.donor_to_target.position[row] / mm));
        segments.push_back(fmt::format(R"({{"donor_to_target":[{}],"shortest":{},"longest":{}}})", fmt::join(rows, ","),
                                       *s.length_shortest / mm, *s.length_longest / mm));
    }
    for (const FibulaWarning& w : plan.warnings)
        warnings.push_back(fmt::format(R"(["{}",{}])", name_of(w.code), w.segment));
    std::vector<double> clearances, off, wedges;
    for (const auto& gap : plan.clearances) clearances.push_back(gap.value() / mm);
    for (const double angle : plan.off_bisector) off.push_back(angle / degree);
    for (const double angle : plan.wedges) wedges.push_back(angle / degree);
    return fmt::format(
        R"({{"inputs":{{"planes":[{}],"point":{},"direction":{},"reversed":{},"between":{},"distal_margin":{},)"
        R"("proximal_margin":{},"kerf":{}}},"plan":{{"segments":[{}],"warnings":[{}],"clearances":[{}],"off_bisector":[{}],)"
        R"("wedges":[{}],"left":[{},{}]}}}})",
        fmt::join(planes, ","), text(inputs.line_point / mm), text(inputs.line_direction), inputs.reversed,
        inputs.between / mm, inputs.distal_margin / mm, inputs.proximal_margin / mm, inputs.kerf / mm,
        fmt::join(segments, ","), fmt::join(warnings, ","), fmt::join(clearances, ","), fmt::join(off, ","),
        fmt::join(wedges, ","), *plan.left_distal / mm, *plan.left_proximal / mm);
}

/// The first plans of a random sequence that are accepted.
void compare_plans(std::size_t count) {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
        return tactus::test::skip("no python3 with numpy here");
    const Vec3 point = Vec3(90, 10, -120) * mm, line = glm::normalize(Vec3(0.09, -0.02, 1.0));
    const geometry::TriangleSurface donor = lower_leg(point, line);
    const auto file = std::filesystem::temp_directory_path() / fmt::format("tactus_plans_{}", ::getpid());
    std::size_t accepted = 0;
    {
        std::ofstream out(file);
        std::vector<std::string> vertices, triangles;
        for (const Vec3& v : donor.vertices) vertices.push_back(text(v / mm));
        for (const auto& t : donor.triangles) triangles.push_back(fmt::format("[{},{},{}]", t[0], t[1], t[2]));
        out << fmt::format("{{\"vertices\":[{}],\"triangles\":[{}]}}\n", fmt::join(vertices, ","),
                           fmt::join(triangles, ","));
        for (std::uint64_t trial = 0; accepted < count && trial < 5 * count; ++trial) {
            FibulaInputs inputs = random_inputs(trial, point, line);
            inputs.donor = donor;
            try {
                out << line_of(inputs, plan_fibula(inputs)) << "\n";
                ++accepted;
            } catch (const Error&) {
                // Refused: planes that meet inside the bone, a bone that is too short.
            }
        }
    }
    CHECK(accepted == count);
    const std::string script = (tactus::test::source_folder() / "tests/dsp/reconstruction/check_plans.py").string();
    CHECK(std::system(fmt::format("/usr/bin/python3 '{}' '{}'", script, file.string()).c_str()) == 0);
    std::filesystem::remove(file);
}

}  // namespace

TEST_CASE("random fibula plans have the numbers and warnings that triangles cut in Python give", "[slow]") {
    compare_plans(200);
}

TEST_CASE("a thousand random fibula plans have the numbers and warnings that triangles cut in Python give", "[long]") {
    compare_plans(1000);
}
