// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/passivity/z_width.hpp"

#include "tests/support/catch.hpp"
#include "tools/report/figures/z_width_figure.hpp"

using namespace tactus;

TEST_CASE("the z-width of an ideal device has the bound, the border by motion and the simulated one together",
          "[slow]") {
    DeviceInfo info;
    info.damping = 4.0;
    analysis::ZWidthGrid grid;
    grid.rates = {1000.0};
    grid.dampings = {0.0, 1.0, 2.0};
    const std::vector<analysis::ZWidthCurve> curves = analysis::z_width({analysis::ideal_device("hand", info)}, grid);
    REQUIRE(curves.size() == 2);
    for (const analysis::ZWidthCurve& curve : curves)
        for (const analysis::ZWidthPoint& point : curve.points) {
            INFO(curve.delay << " s, " << point.damping << " N s/m");
            if (curve.delay == 0.0) CHECK(point.passive == Approx(point.bound).epsilon(0.1));
            // What is passive does not oscillate; a wall that is damped itself may stay calm beyond.
            CHECK(point.simulated.stiffness >= 0.9 * point.bound);
        }
    const std::string svg = report::draw_z_width(curves).svg();
    CHECK(svg.find("Colgate") != std::string::npos);
    CHECK(svg.find("hand") != std::string::npos);
}
