// SPDX-License-Identifier: Apache-2.0
// Deviation of a reconstruction from the mirrored healthy side, or from the jaw of another person.
#include "tests/support/catch.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"
#include "tests/tools/json_schema.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

constexpr double jaw_radius = 40.0;  // mm

/// Symmetric in x, and uneven along the arch, so that only one place fits.
geometry::TriangleSurface uneven_ring() {
    geometry::TriangleSurface ring =
        reconstruction::closed_tube(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 1.0, 40, 121, [](double turn, double s) {
            const double along = 2.0 * std::numbers::pi * (s - 0.5);
            return 6e-3 * (1.0 + 0.15 * std::cos(4.0 * along) * std::cos(turn) + 0.1 * std::cos(7.0 * along));
        });
    for (Vec3& v : ring.vertices) {
        const double a = std::numbers::pi * v.z;
        v = (jaw_radius * 1e-3 + v.x) * Vec3(-std::cos(a), -std::sin(a), 0.0) + Vec3(0.0, 0.0, -v.y);
    }
    if (mesh::volume_of(ring) < 0.0)
        for (auto& t : ring.triangles) std::swap(t[1], t[2]);
    return ring;
}

struct TargetCase : test::JawCase {
    TargetCase() {
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{uneven_ring(), {}}}, folder.path / "jaw.stl");
        REQUIRE(run(inputs()).code == 0);
    }
    test::Outcome verb(const std::string& name, const std::string& rest = "") const {
        return folder.tactus("plan " + name + " " + plan + " " + rest);
    }
    json deviation(const std::string& name = "show") const {
        const json shown = json::parse(verb(name, "--json").out);
        return shown.contains("deviation") ? shown["deviation"] : json();
    }
    std::string jaw() const { return (folder.path / "jaw.stl").string() + " jaw-1"; }
};

}  // namespace

TEST_CASE("segments deviate from the mirrored jaw as chords from their arc, and more when they are moved off",
          "[slow]") {
    const TargetCase made;
    CHECK(made.deviation().is_null());
    const test::Outcome laid = made.verb("mirror", made.jaw());
    INFO(laid.out << laid.err);
    REQUIRE(laid.code == 0);
    const json planned = made.deviation();
    REQUIRE(planned.size() == 2);
    CHECK(made.deviation("check") == planned);
    // The planes lie at 0.8, 1.57 and 2.2 rad. A short stump holds the far end of the target to some millimetres only.
    const double sagitta = jaw_radius * (1.0 - std::cos(0.5 * 0.77));
    const json& first = planned[0]["curve_mm"];
    CHECK(first["greatest"].get<double>() > 0.5 * sagitta);
    CHECK(first["greatest"].get<double>() < 2.5 * sagitta);
    CHECK(first["rms"].get<double>() < first["greatest"].get<double>());
    CHECK(planned[0]["contour_mm"]["highest"].get<double>() < 7.0);
    CHECK_THAT(made.verb("show").out, ContainsSubstring("curve, rms, mm") && ContainsSubstring("contour, rms, mm"));
    // 10 mm up, which is across the arch.
    const json shown = json::parse(made.verb("show", "--json").out);
    CHECK(test::broken_schema(made.folder, "plan-show", shown) == "");
    CHECK(test::broken_schema(made.folder, "plan-check", json::parse(made.verb("check", "--json").out)) == "");
    for (const json& fragment : shown["fragments"]) {
        if (fragment["name"] != "segment-1") continue;
        const json &p = fragment["pose"]["position_mm"], &q = fragment["pose"]["quaternion_wxyz"];
        std::string pose;
        for (const double part : {p[0].get<double>(), p[1].get<double>(), p[2].get<double>() + 10.0, q[0].get<double>(),
                                  q[1].get<double>(), q[2].get<double>(), q[3].get<double>()})
            pose += (pose.empty() ? "" : ",") + json(part).dump();
        REQUIRE(made.verb("move", "segment-1 --pose " + pose).code == 0);
    }
    const json moved = made.deviation();
    CHECK(moved[0]["curve_mm"]["rms"].get<double>() > first["rms"].get<double>() + 4.0);
    CHECK(moved[1] == planned[1]);
}

TEST_CASE("a jaw of the same side is a target without a mirror, and one that does not lie there is refused", "[slow]") {
    const TargetCase made;
    REQUIRE(made.verb("mirror", made.jaw() + " --same-side").code == 0);
    const json shown = json::parse(made.verb("show", "--json").out);
    CHECK(shown["mirror"]["mirrored"] == false);
    CHECK(shown["mirror"]["residual_mm"].get<double>() < 0.5);
    CHECK(shown["deviation"].size() == 2);
    const test::Outcome other =
        made.verb("mirror", (made.folder.path / "fibula.stl").string() + " jaw-1 --same-side --max-residual 0.5");
    CHECK(other.code == 1);
    CHECK_THAT(other.out,
               ContainsSubstring("the same side lies more than 0.5 mm away") && ContainsSubstring("--max-residual"));
}
