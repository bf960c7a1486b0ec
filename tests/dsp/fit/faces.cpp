// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/faces.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

/// Three sides of a cube of 12 mm that meet in a corner, rough, all painted; and a fourth that is not.
std::vector<contact::SurfacePoint> corner() {
    std::vector<contact::SurfacePoint> points;
    const Random random{3};
    std::uint64_t draw = 0;
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < 24; ++i)
            for (int j = 0; j < 24; ++j) {
                const double u = 0.5 * mm * (i + 0.5), v = 0.5 * mm * (j + 0.5);
                const int axis = side % 3;
                contact::SurfacePoint p;
                p.position[axis] = side == 3 ? 12.0 * mm : 0.0;
                p.position[(axis + 1) % 3] = u;
                p.position[(axis + 2) % 3] = v;
                Vec3 n(0.3 * random.normal(draw), 0.3 * random.normal(draw + 1), 0.3 * random.normal(draw + 2));
                draw += 3;
                n[axis] += side == 3 ? 1.0 : -1.0;
                p.normal = glm::normalize(n);
                p.area = 0.25 * mm * mm;
                p.label = side == 3 ? contact::surface_label::none : contact::surface_label::fracture;
                points.push_back(p);
            }
    return points;
}

}  // namespace

TEST_CASE("painted surfaces that meet at edges are faces of their own, however rough each is") {
    const auto points = corner();
    const auto faces = fit::split_faces(points);
    REQUIRE(faces.size() == 3);
    std::size_t all = 0;
    for (const auto& face : faces) {
        CHECK(face.size() == Approx(24 * 24).epsilon(0.1));
        all += face.size();
        // Nearly all of a face lies on one side of the cube.
        std::size_t sides[3] = {};
        for (const std::size_t n : face) ++sides[n / (24 * 24)];
        CHECK(std::max({sides[0], sides[1], sides[2]}) > 9 * face.size() / 10);
    }
    CHECK(all == 3 * 24 * 24);
}

TEST_CASE("without paint there are no faces, and crumbs are none") {
    auto points = corner();
    for (contact::SurfacePoint& p : points) p.label = contact::surface_label::none;
    CHECK(fit::split_faces(points).empty());
    for (std::size_t n = 0; n < 10; ++n) points[n].label = contact::surface_label::fracture;
    CHECK(fit::split_faces(points).empty());
    CHECK(fit::split_faces({}).empty());
}
