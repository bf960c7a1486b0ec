// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/passivity/bounces.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tactus;

TEST_CASE("no contact on any simulated device returns more energy than its bound", "[slow]") {
    analysis::BounceMatrix matrix;
    matrix.nodes = {"sphere_contact",   "sphere_proxy", "quasi_static_coupling",
                    "dynamic_coupling", "plane_guide",  "point_guide"};
    matrix.stiffnesses = {2.5e3, 12.8e3};
    matrix.speeds = {0.2};
    matrix.masses = {0.1, 0.3};
    double without = 0.0;
    for (const analysis::BounceRow& row : analysis::throw_at_contacts(matrix, {})) {
        INFO(row.node << " on " << row.device << ", " << row.stiffness << " N/m, " << row.mass << " kg");
        CHECK(row.energy_ratio <= row.bound);
        without = std::max(without, row.energy_ratio_without);
    }
    CHECK(without > 2.0);
}
