// SPDX-License-Identifier: Apache-2.0
#include "tools/window/training/score_card.hpp"

#include "tests/support/catch.hpp"

using namespace tactus;
using namespace tactus::window;

namespace {

analysis::ScoredRun attempt(double seconds, double force_N, double closest_mm) {
    analysis::ScoredRun run;
    run.task.hash = 7;
    run.task.limits.force = 10.0;
    run.task.limits.time = 30.0;
    run.task.cuts.resize(1);
    run.task.cuts.front().tolerance = 1e-3;
    run.task.spared.emplace_back();
    run.task.spared.back().name = "nerve";
    run.task.spared.back().margin = 1e-3;
    run.score.seconds = seconds;
    run.max_N = force_N;
    run.score.spared = {{"nerve", 0.0, closest_mm}};
    return run;
}

}  // namespace

TEST_CASE("a folder of results that is gone gives no score and a reason") {
    const ScoreCard card = score_of("/nowhere/at/all");
    CHECK(card.problem.starts_with("no score: "));
    CHECK(card.problem.size() > 12);
    CHECK(card.rows.empty());
}

TEST_CASE("a score has the limits of its task, and every warning that stood live with its time") {
    analysis::ScoredRun run = attempt(20.0, 9.0, 0.5);
    run.score.device_scale = 2.0;
    run.score.warnings_s[static_cast<std::size_t>(training::Warning::over_force)] = 2.5;
    const ScoreCard card = card_of(run);
    REQUIRE(card.row("force on the hand"));
    // The device gives twice the force of the blade.
    CHECK(card.row("force on the hand")->value == 18.0);
    CHECK(card.row("force on the hand")->is_bad);
    CHECK(card.row("force of the blade")->value == 9.0);
    CHECK(card.row("time")->limit == 30.0);
    CHECK_FALSE(card.row("time")->is_bad);
    CHECK(card.row("nerve")->is_bad);
    CHECK(card.row("! too much force")->value == 2.5);
    CHECK(card.row("! too much force")->is_bad);
    CHECK(card.row("! over time")->note == "never");
    // No limit, no warning.
    CHECK(card.row("! too hot") == nullptr);
    CHECK(value_text(*card.row("time")) == "20.0 s");
    CHECK(value_beside_limit(*card.row("time")) == "20.0 of 30 s");
    CHECK(value_beside_limit(*card.row("nerve")) == "0.5 mm, at least 1");
    CHECK(value_beside_limit(*card.row("cut too much")) == "0.0 mm³");
}

TEST_CASE("the best of earlier attempts is that of the same task, less time and more distance to what is spared") {
    const std::vector<ScoreCard> earlier{card_of(attempt(25.0, 9.0, 2.0)), card_of(attempt(18.0, 12.0, 0.2)), [] {
                                             analysis::ScoredRun other = attempt(1.0, 1.0, 9.0);
                                             other.task.hash = 8;
                                             return card_of(other);
                                         }()};
    const ScoreCard now = card_of(attempt(20.0, 8.5, 1.1));
    CHECK(best_of(earlier, now, *now.row("time"))->value == 18.0);
    CHECK(best_of(earlier, now, *now.row("nerve"))->value == 2.0);
    CHECK(best_of({}, now, *now.row("time")) == nullptr);
    CHECK(now.row("force on the hand")->is_close());
}
