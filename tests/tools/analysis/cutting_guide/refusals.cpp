// SPDX-License-Identifier: Apache-2.0
// Refusals of guides: their words and limits.
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tools/analysis/cutting_guide/guide_limits.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include <set>
#include <string>
#include <string_view>

using namespace tactus;
using namespace tactus::analysis;
using Catch::Matchers::ContainsSubstring;

namespace {

/// Measures of a guide that passes each check.
PlannedGuide flawless() {
    PlannedGuide guide;
    guide.topology.components = 1;
    guide.volume = 1e-5;
    guide.seat.min_distance = guide.design.settings.offset;
    guide.seat.contact_area = 1e-4;
    return guide;
}

std::string refusal(const PlannedGuide& guide) {
    try {
        refuse_guide(guide);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a guide that touches a vessel is not said to overlap it by 0.00 mm") {
    CHECK(refusal(flawless()) == "");
    for (const double away : {0.09 * mm, 0.04 * mm, 0.0, -0.004 * mm}) {
        PlannedGuide guide = flawless();
        guide.vessels.push_back({"vessel 'artery'", away});
        CHECK_THAT(refusal(guide), ContainsSubstring("the guide touches vessel 'artery', at"));
    }
    PlannedGuide beside = flawless();
    beside.vessels.push_back({"vessel 'artery'", 0.11 * mm});
    CHECK(refusal(beside) == "");
    beside.choice.limits.touch = 0.2 * mm;
    CHECK_THAT(refusal(beside), ContainsSubstring("touches"));
    PlannedGuide guide = flawless();
    guide.vessels.push_back({"vessel 'artery'", -0.31 * mm});
    CHECK_THAT(refusal(guide), ContainsSubstring("the guide overlaps vessel 'artery' by 0.31 mm, at"));
}

TEST_CASE("a guide that lost more than a twentieth as too thin is refused with what to change") {
    PlannedGuide guide = flawless();
    guide.made.thin_share = 0.049;
    CHECK(refusal(guide) == "");
    guide.made.thin_share = 0.062;
    CHECK_THAT(refusal(guide), ContainsSubstring("6.2 % of the guide's volume are left out as thinner than 2.0 mm"));
    CHECK_THAT(refusal(guide), ContainsSubstring("--thickness"));
    CHECK_THAT(refusal(guide), ContainsSubstring("--min-wall"));
    guide.choice.limits.max_thin_share = 0.08;
    CHECK(refusal(guide) == "");
}

TEST_CASE("each limit of a guide is a value of its own with a default in range and a source") {
    GuideChoice choice;
    std::set<const double*> places;
    std::set<std::string_view> keys;
    for (const GuideLimit& limit : guide_limits()) {
        INFO(limit.option);
        CHECK(places.insert(&limit.in(choice)).second);
        CHECK(keys.insert(limit.key).second);
        CHECK(limit.of(choice) / limit.si >= limit.low);
        CHECK(limit.of(choice) / limit.si <= limit.high);
        CHECK(!limit.source.empty());
    }
}
