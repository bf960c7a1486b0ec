// SPDX-License-Identifier: Apache-2.0
#include "tools/study/passivity/z_width.hpp"

#include "tests/support/catch.hpp"
#include "tools/picture/report/z_width_figure.hpp"

using namespace tactus;

TEST_CASE("the z-width of an ideal device has the bound, the border by motion and the simulated one together",
          "[slow]") {
    DeviceInfo info;
    info.damping = 4.0;
    study::ZWidthGrid grid;
    grid.rates = {1000.0};
    grid.dampings = {0.0, 1.0, 2.0};
    const std::vector<study::ZWidthCurve> curves = study::z_width({study::ideal_device("hand", info)}, grid);
    REQUIRE(curves.size() == 2);
    for (const study::ZWidthCurve& curve : curves)
        for (const study::ZWidthPoint& point : curve.points) {
            INFO(curve.delay << " s, " << point.damping << " N s/m");
            if (curve.delay == 0.0) CHECK(point.passive == Approx(point.bound).epsilon(0.1));
            // What is passive does not oscillate; a wall that is damped itself may stay calm beyond.
            CHECK(point.simulated.stiffness >= 0.9 * point.bound);
        }
    const std::string svg = picture::draw_z_width(curves).svg();
    CHECK(svg.find("Colgate") != std::string::npos);
    CHECK(svg.find("hand") != std::string::npos);
}
