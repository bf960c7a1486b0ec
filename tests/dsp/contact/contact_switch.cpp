// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/contact_switch.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace tactus;

TEST_CASE("contact begins above one force, ends below a smaller one, and ignores residues") {
    contact::ContactSwitch now;
    CHECK_FALSE(now.update(1e-9));
    CHECK_FALSE(now.update(0.049));
    CHECK(now.update(0.051));
    CHECK(now.update(0.03));
    CHECK(now.update(0.021));
    CHECK_FALSE(now.update(0.019));
    CHECK_FALSE(now.update(0.03));
    CHECK_FALSE(now.update(std::numeric_limits<double>::quiet_NaN()));
}
