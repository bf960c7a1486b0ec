// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/training/measures.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tactus;

namespace {

analysis::ScoredRun attempt(const std::string& task, double rms, double closest) {
    analysis::ScoredRun run;
    run.task.title = task;
    run.score.rms_mm = rms;
    run.score.spared = {{"nerve", 0.0, closest}};
    return run;
}

const analysis::Measure& measure(const std::string& name) {
    const auto all = analysis::measures();
    const auto found = std::ranges::find(all, name, &analysis::Measure::name);
    REQUIRE(found != all.end());
    return *found;
}

}  // namespace

TEST_CASE("a learning curve that is a power law has its exponent, per task") {
    std::vector<analysis::ScoredRun> runs;
    for (int n = 1; n <= 5; ++n) {
        runs.push_back(attempt("one", 2.0 * std::pow(n, -0.4), 1.0));
        runs.push_back(attempt("other", 1.0 + n, 1.0));
    }
    const auto curves = analysis::learning_curves(runs);
    const auto one =
        std::ranges::find_if(curves, [](const auto& c) { return c.task == "one" && c.measure == "plane.rms_mm"; });
    REQUIRE(one != curves.end());
    REQUIRE(one->values.size() == 5);
    REQUIRE(one->exponent);
    CHECK(std::abs(*one->exponent + 0.4) < 1e-9);
    const auto zero = std::ranges::find_if(
        curves, [](const auto& c) { return c.task == "one" && c.measure == "spared.injured_mm3"; });
    REQUIRE(zero != curves.end());
    CHECK_FALSE(zero->exponent);
    CHECK(std::ranges::none_of(curves, [](const auto& c) { return c.measure == "plane.angle_deg"; }));
}

TEST_CASE("a percentile is the share of the group that did worse, also where more is better") {
    std::vector<analysis::ScoredRun> group;
    for (const double v : {0.2, 0.4, 0.6, 0.8}) group.push_back(attempt("one", v, v));
    const auto reference = analysis::reference_of(group);
    const auto of = [&](const char* name, double value) {
        const auto found = std::ranges::find(reference, name, &analysis::ReferenceMeasure::measure);
        REQUIRE(found != reference.end());
        return analysis::percentile(measure(name), value, *found);
    };
    CHECK(of("plane.rms_mm", 0.1) == 100.0);
    CHECK(of("plane.rms_mm", 0.5) == 50.0);
    CHECK(of("plane.rms_mm", 0.6) == 37.5);
    CHECK(of("plane.rms_mm", 0.9) == 0.0);
    CHECK(of("spared.closest_mm", 0.9) == 100.0);
    CHECK(of("spared.closest_mm", 0.1) == 0.0);
    CHECK_FALSE(of("strokes", 3.0));
    CHECK_FALSE(analysis::percentile(measure("plane.angle_deg"), 1.0, reference[2]));
    CHECK(std::abs(reference[0].mean - 0.5) < 1e-12);
    CHECK(std::abs(reference[0].deviation.value() - 0.2581988897) < 1e-9);
}
