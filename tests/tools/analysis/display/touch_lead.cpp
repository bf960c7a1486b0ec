// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/display/touch_lead.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::analysis;

namespace {

std::vector<display::Touch> steps() {
    std::vector<display::Touch> all(5);
    for (std::size_t i = 0; i < 3; ++i) all[i].of = display::Touch::Of::mirror;
    for (std::size_t i = 3; i < 5; ++i) all[i] = {display::Touch::Of::screen, "left", {}, {}, {}};
    return all;
}

Touched at(double x) { return {Vec3(x, 0.0, 0.0), Vec3(0.0), 0.0, 200, 0}; }

}  // namespace

TEST_CASE("a lead goes from step to step, and checks each part when it is complete") {
    std::vector<std::size_t> checked;
    TouchLead lead(steps(), false, [&](std::span<const display::Touch> done) { checked.push_back(done.size()); });
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(lead.due() == i);
        CHECK_FALSE(lead.is_done());
        CHECK(lead.take(at(0.1 * static_cast<double>(i))).empty());
    }
    CHECK(lead.is_done());
    CHECK(checked == std::vector<std::size_t>{3, 5});
    CHECK(lead.steps()[4].reading.x == 0.4);
    CHECK_THROWS_WITH(TouchLead({}, false, {}), Catch::Matchers::ContainsSubstring("nothing"));
}

TEST_CASE("a touch that moved, or that the others contradict, is asked for again, and a third time ends it") {
    const auto check = [](std::span<const display::Touch> done) {
        for (std::size_t i = 0; i < done.size(); ++i)
            if (done[i].reading.x < 0.0) throw display::BadTouch(i, "that one is off");
    };
    TouchLead lead(steps(), false, check);
    CHECK(lead.take({Vec3(0.0), Vec3(0.0), 2e-3, 200, 0}).find("2.0 mm") != std::string::npos);
    CHECK(lead.due() == 0);
    for (const double x : {0.1, -0.1, 0.3}) lead.take(at(x));
    CHECK(lead.due() == 1);
    CHECK(lead.take(at(-0.1)) == "that one is off");
    CHECK(lead.due() == 1);
    SECTION("made right, it goes on after the part") {
        CHECK(lead.take(at(0.2)).empty());
        CHECK(lead.due() == 3);
        // The last part as well: nothing is done before it agrees.
        lead.take(at(0.4));
        CHECK(lead.take(at(-1.0)) == "that one is off");
        CHECK_FALSE(lead.is_done());
        lead.take(at(0.5));
        CHECK(lead.is_done());
    }
    SECTION("wrong again, it ends") { CHECK_THROWS_AS(lead.take(at(-0.1)), display::BadTouch); }
}

TEST_CASE("a touch is the mean of where the tip was, and few samples are asked for again, and a third time end it") {
    std::vector<Vec3> tips(20, Vec3(1e-3, 0.0, 0.0));
    tips[7].y = 20e-3;
    const Touched touched = touch_of(tips, {});
    CHECK(touched.tip.y == Approx(1e-3));
    CHECK(touched.moved == Approx(19e-3));
    tips.resize(5);
    TouchLead lead(steps(), false, [](std::span<const display::Touch>) {});
    CHECK(lead.take(touch_of(tips, {})).find("5 valid samples") != std::string::npos);
    CHECK(lead.take(touch_of({}, {})).find("no valid samples") != std::string::npos);
    CHECK(lead.due() == 0);
    CHECK_THROWS_WITH(lead.take(touch_of({}, {})), Catch::Matchers::ContainsSubstring("no valid samples"));
}

TEST_CASE("where the tracker says the place, a touch that it did not see is asked for again") {
    std::vector<display::Touch> all = steps();
    all[0].of = display::Touch::Of::workspace;
    TouchLead lead(all, true, [](std::span<const display::Touch>) {});
    const std::vector<Vec3> tips(20, Vec3(1e-3, 0.0, 0.0)), tracked(3, Vec3(0.0, 0.2, 0.0));
    CHECK(lead.take(touch_of(tips, {})).find("tracker") != std::string::npos);
    CHECK(lead.due() == 0);
    CHECK(lead.take(touch_of(tips, tracked)).empty());
    CHECK(lead.steps()[0].place.y == Approx(0.2));
    // Nothing else needs it.
    CHECK(lead.take(touch_of(tips, {})).empty());
}
