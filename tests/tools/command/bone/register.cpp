// SPDX-License-Identifier: Apache-2.0
// The verdict of 'register': the right pose, several poses that fit as well, or none.
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

/// A bar of 60 mm along x, as text; `radius` in mm over the place along the bar and the angle around it.
std::string bar_stl(const std::function<double(double, double)>& radius, bool is_turned) {
    constexpr int along = 60, around = 36;
    constexpr double turn = 6.283185307179586;
    const auto corner = [&](int i, int j) {
        const double x = i - 0.5 * along, a = turn * (j % around) / around;
        const double r = i == 0 || i == along ? 0.0 : radius(x, a);
        std::array<double, 3> p{x, r * std::cos(a), 0.7 * r * std::sin(a)};
        // A quarter turn about z, and away.
        if (is_turned) p = {-p[1] + 25.0, p[0] - 8.0, p[2] + 12.0};
        return fmt::format("vertex {} {} {}\n", p[0], p[1], p[2]);
    };
    std::string text = "solid bar\n";
    const auto facet = [&](const std::string& a, const std::string& b, const std::string& c) {
        if (a != b && b != c && c != a) text += "facet normal 0 0 0\nouter loop\n" + a + b + c + "endloop\nendfacet\n";
    };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            facet(corner(i, j), corner(i + 1, j + 1), corner(i + 1, j));
            facet(corner(i, j), corner(i, j + 1), corner(i + 1, j + 1));
        }
    return text + "endsolid bar\n";
}

double even(double x, double) { return 6.0 + 0.002 * x * x; }
/// Thicker at one end, and with a lump off the middle.
double lumpy(double x, double a) {
    const double around = a < 3.14159265 ? a : a - 6.283185307179586;
    return even(x, a) + 0.06 * (x + 30.0) + 8.0 * std::exp(-0.006 * (x - 15.0) * (x - 15.0) - around * around);
}

}  // namespace

TEST_CASE("register finds a bone that was turned by 90 degrees, names rival poses of an even bar, and exits with 1",
          "[slow]") {
    const test::Folder folder;
    folder.write("lumpy.stl", bar_stl(lumpy, false));
    folder.write("turned.stl", bar_stl(lumpy, true));
    folder.write("even.stl", bar_stl(even, false));
    folder.write("even_turned.stl", bar_stl(even, true));
    const auto registered = [&](const char* moving, const char* fixed) {
        return folder.tactus(fmt::format("register {0}/{1} {0}/{2} --json", folder.path.string(), moving, fixed));
    };
    const test::Outcome fit = registered("lumpy.stl", "turned.stl");
    INFO(fit.out << fit.err);
    CHECK(fit.code == 0);
    const json found = json::parse(fit.out);
    CHECK(found["verdict"] == "fit");
    CHECK(found.contains("rivals"));  // an empty list where none was found
    CHECK_FALSE(found.contains("region"));  // which was not searched
    CHECK(test::broken_schema(folder, "register", found) == "");
    // The origin of the bar goes to (25, -8, 12), and x to y.
    const json& pose = found["pose"];
    INFO(pose.dump());
    CHECK(std::abs(pose["position_mm"][0].get<double>() - 25.0) < 0.2);
    CHECK(std::abs(pose["position_mm"][1].get<double>() + 8.0) < 0.2);
    CHECK(std::abs(std::abs(pose["quaternion_wxyz"][3].get<double>()) - std::sqrt(0.5)) < 5e-3);

    const test::Outcome rivals = registered("even.stl", "even_turned.stl");
    INFO(rivals.out << rivals.err);
    CHECK(rivals.code == 1);
    const json several = json::parse(rivals.out);
    CHECK(several["verdict"] == "ambiguous");
    CHECK_FALSE(several["rivals"].empty());
    CHECK(test::broken_schema(folder, "register", several) == "");
}
