// SPDX-License-Identifier: Apache-2.0
// Paint as strokes in a file: what is written and read back is the same paint.
#include "assets/plan/paint_file.hpp"
#include "assets/library/fragments.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <cstdint>
#include <string>
#include <vector>

using namespace tactus;

namespace {

std::vector<contact::SurfacePoint> broken_half(double spacing) {
    return library::make_fragments({.voxel = 0.6 * mm, .spacing = spacing})[0].points;
}

double painted_area(const std::vector<contact::SurfacePoint>& points) {
    double area = 0.0;
    for (const contact::SurfacePoint& p : points) area += p.label == contact::surface_label::fracture ? p.area : 0.0;
    return area;
}

}  // namespace

TEST_CASE("paint that is written to a file and read back is the same to the point", "[slow]") {
    const TemporaryFolder folder;
    const std::vector<contact::SurfacePoint> painted = broken_half(0.6 * mm);
    plan::write_paint_file(painted, "left", folder.path / "left.json");
    std::vector<contact::SurfacePoint> again = painted;
    for (contact::SurfacePoint& p : again) p.label = contact::surface_label::none;
    plan::paint_from_file(again, folder.path / "left.json");
    std::size_t same = 0;
    for (std::size_t n = 0; n < painted.size(); ++n) same += again[n].label == painted[n].label;
    CHECK(painted_area(painted) > 150e-6);
    CHECK(same == painted.size());
    // On other points of the same surface it is as large, without holes.
    std::vector<contact::SurfacePoint> finer = broken_half(0.35 * mm);
    const double wanted = painted_area(finer);
    plan::paint_from_file(finer, folder.path / "left.json");
    CHECK(painted_area(finer) == Approx(wanted).epsilon(0.03));
}

TEST_CASE("a stroke has the radius of its file, or one of its own") {
    std::vector<contact::SurfacePoint> row(11);
    for (std::size_t n = 0; n < row.size(); ++n) row[n].position = Vec3(mm * static_cast<double>(n), 0.0, 0.0);
    plan::paint_from_text(row, R"({"radius_mm": 1.5, "paint": [[2, 0, 0], [8, 0, 0, 0.5]]})", "row.json");
    for (std::size_t n = 0; n < row.size(); ++n)
        CHECK((row[n].label == contact::surface_label::fracture) == ((n >= 1 && n <= 3) || n == 8));
    for (const char* bad : {R"({"paint": [[1, 2, 3, 0]]})", R"({"paint": [[1, 2, 3, 4, 5]]})",
                            R"({"paint": [], "radius_mm": "wide"})", R"({"paint": [[1, 2, 3, 1e300]]})"})
        CHECK_THROWS_AS(plan::paint_from_text(row, bad, "row.json"), Error);
}
