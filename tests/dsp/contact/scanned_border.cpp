// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/scanned_border.hpp"

#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using contact::SurfacePoint;
namespace surface_label = contact::surface_label;

namespace {

SurfacePoint at(double x, double y, double z, std::uint8_t label) {
    return {Vec3(x, y, z) * mm, Vec3(1.0, 0.0, 0.0), 1e-6, label};
}

}  // namespace

TEST_CASE("points near a scanned border are marked, as far as the voxels reach on each axis") {
    const contact::ScannedBorder border{{Vec3(0.0)}, Vec3(1.0, 1.0, 3.0) * mm};
    std::vector<SurfacePoint> points{at(1.2, 0.0, 0.0, surface_label::none), at(1.3, 0.0, 0.0, surface_label::none),
                                     at(0.0, 0.0, 3.6, surface_label::fracture), at(0.0, 0.0, 3.9, 7),
                                     at(0.9, 0.9, 0.0, surface_label::fracture)};
    CHECK(contact::mark_as_scanned(points, border) == 2);
    CHECK(points[0].label == surface_label::as_scanned);
    CHECK(points[1].label == surface_label::none);
    CHECK(points[2].label == surface_label::as_scanned);
    CHECK(points[3].label == 7);
    CHECK(points[4].label == surface_label::fracture);
    CHECK(contact::as_scanned_area(points) == Approx(2e-6));
    CHECK(contact::mark_as_scanned(points, {}) == 0);

    contact::remove_paint(points);
    CHECK(points[0].label == surface_label::as_scanned);
    CHECK(points[3].label == surface_label::none);
    CHECK(points[4].label == surface_label::none);
}
