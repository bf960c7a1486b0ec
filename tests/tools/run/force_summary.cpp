// SPDX-License-Identifier: Apache-2.0
// What a summary says of a force that the hand did not feel.
#include "tools/run/force_summary.hpp"

#include "tests/support/catch.hpp"

using namespace tactus;
using Catch::Matchers::Contains;

namespace {

Report sawing() {
    Report report;
    report.set("contact", "fraction", 0.9);
    report.set("contact", "max_penetration_mm", 5.2);
    report.set("force", "thrust_mean_N", 104.8);
    report.set("force", "felt_mean_N", 7.1);
    report.set("force", "off_s", 0.0);
    return report;
}

}  // namespace

TEST_CASE("a thrust is told as the mean when forces were on all the time") {
    CHECK_THAT(run::force_text(sawing()), Contains("thrust 104.80 N mean") && !Contains("off"));
}

TEST_CASE("after a fade the summary says since when forces were off and not a thrust that nobody felt") {
    Report report = sawing();
    report.set("force", "off_s", 5.8);
    report.set("force", "off_from_s", 2.041);
    report.set("force", "off_until_s", 7.999);
    report.set("force", "faults", 1.0);
    report.set("force", "fault", std::string("a tick came too late"));
    CHECK_THAT(run::force_text(report), Contains("off for 5.8 s") &&
                                            Contains("from 2.041 s to 7.999 s (a tick came too late)") &&
                                            Contains("7.10 N mean") && !Contains("104.8"));
}
