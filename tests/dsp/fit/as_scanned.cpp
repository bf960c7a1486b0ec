// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/as_scanned.hpp"

#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using namespace tactus::test;

TEST_CASE("dsp: halves that one border cut apart repeat the scan where it has them, and nowhere else") {
    const Relief relief = rough_relief(3);
    const Half left = bar_half(-1.0, relief), right = bar_half(1.0, relief);
    const contact::Voxmap other = contact::make_voxmap(left.distance);
    CHECK(fit::is_as_scanned(right.points, {}, other));
    CHECK(fit::is_as_scanned(right.points, beside(0.3 * mm, 0.01, 1), other));
    CHECK_FALSE(fit::is_as_scanned(right.points, beside(3.0 * mm, 0.0, 1), other));
    CHECK_FALSE(fit::is_as_scanned(right.points, beside(0.0, 0.3, 2), other));
}

TEST_CASE("dsp: a half that was displaced before the scan does not repeat it where it fits") {
    const Relief relief = rough_relief(3);
    const Half left = bar_half(-1.0, relief);
    const contact::Voxmap other = contact::make_voxmap(left.distance);
    for (const Vec3& far : {Vec3(2.0, 0.0, 0.0), Vec3(-1.0, 5.0, 3.0), Vec3(40.0, 0.0, 0.0)}) {
        const Half right = bar_half(1.0, relief, {.far = far * mm});
        INFO(far.x << " " << far.y << " " << far.z);
        CHECK_FALSE(fit::is_as_scanned(right.points, {-far * mm, {1.0, 0.0, 0.0, 0.0}}, other));
    }
    CHECK_FALSE(fit::is_as_scanned({}, {}, other));
}
