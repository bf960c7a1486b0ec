// SPDX-License-Identifier: Apache-2.0
// Adaptive methods against simulated observers, whose thresholds are off the grids.
#include "dsp/psychophysics/posterior.hpp"
#include "dsp/psychophysics/quest_plus.hpp"
#include "dsp/psychophysics/staircase.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

using namespace tactus;
using namespace tactus::psychophysics;

namespace {

StaircaseRule two_down() {
    StaircaseRule rule;
    rule.start = 0.8;
    rule.min = -1.5;
    rule.max = 1.5;
    rule.step_up = rule.step_down = 0.05;
    rule.reversals = 1000;
    rule.max_trials = 60;
    return rule;
}

QuestSettings quest_settings() {
    QuestSettings settings;
    settings.target = two_down().target();
    for (int i = 0; i <= 80; ++i) settings.thresholds.push_back(-0.8 + 0.02 * i);  // 1.6 decades
    for (int i = 0; i <= 40; ++i) settings.levels.push_back(-1.0 + 0.05 * i);
    settings.slopes = usual_slopes(Form::weibull);
    return settings;
}

struct Observer {
    Psychometric function;
    Random random;
    std::uint64_t next = 0;
    bool answers(double level) { return random.uniform(next++) < function.at(level); }
};

}  // namespace

TEST_CASE("the targets of staircase rules are those of their authors") {
    StaircaseRule rule;
    CHECK(rule.target() == Approx(std::sqrt(0.5)));  // Levitt: 70.7 %
    rule.down = 3;
    CHECK(rule.target() == Approx(0.7937).epsilon(1e-4));
    rule.kind = StaircaseRule::Kind::weighted;
    rule.step_up = 0.3;
    rule.step_down = 0.1;
    CHECK(rule.target() == Approx(0.75));  // Kaernbach: 75 %
}

TEST_CASE("a staircase moves as its rule says and keeps its limits") {
    StaircaseRule rule;
    rule.start = 0.0;
    rule.step_up = 0.1;
    rule.step_down = 0.1;
    rule.first_factor = 2.0;
    rule.min = -0.25;
    rule.max = 0.5;
    rule.reversals = 4;
    Staircase stairs(rule);
    stairs.answer(true);
    CHECK(stairs.level() == 0.0);
    stairs.answer(true);
    CHECK(stairs.level() == Approx(-0.2));
    stairs.answer(true);
    stairs.answer(true);
    CHECK(stairs.level() == Approx(-0.25));  // the limit
    stairs.answer(false);
    CHECK(stairs.reversals().size() == 1);
    CHECK(stairs.level() == Approx(-0.15));  // the first reversal halves the steps
    stairs.answer(true);
    stairs.answer(false);  // two in a row are needed: this is one more rise
    CHECK(stairs.reversals().size() == 1);
    for (int i = 0; i < 3; ++i) {
        stairs.answer(true);
        stairs.answer(true);
        stairs.answer(false);
    }
    CHECK(stairs.is_done());
}

TEST_CASE("a staircase refuses rules that cannot work") {
    const auto refuses = [](auto change) {
        StaircaseRule rule;
        change(rule);
        CHECK_THROWS_AS(Staircase(rule), Error);
    };
    refuses([](StaircaseRule& r) { r.step_up = 0.0; });
    refuses([](StaircaseRule& r) { r.step_down = std::nan(""); });
    refuses([](StaircaseRule& r) { r.start = 2.0; });
    refuses([](StaircaseRule& r) { r.down = 0; });
    refuses([](StaircaseRule& r) { r.reversals = 1; });
}

TEST_CASE("the expected entropy of QUEST+ is that of the posteriors themselves") {
    QuestSettings settings;
    settings.levels = {-0.4, -0.1, 0.0, 0.2, 0.7};
    settings.thresholds = {-0.3, 0.0, 0.3};
    settings.slopes = {2.0, 4.0};
    QuestPlus quest(settings);
    // Brute force: the entropy after each answer, weighted by its probability.
    double least = 1e9, at = 0.0;
    for (const double level : settings.levels) {
        QuestPlus right(settings), wrong(settings);
        right.answer(level, true);
        wrong.answer(level, false);
        double p = 0.0;
        for (const double threshold : settings.thresholds)
            for (const double slope : settings.slopes) {
                Psychometric function{Form::weibull, 0.0, slope, 0.5, 0.02};
                function.threshold = threshold - function.level_of(settings.target);
                p += function.at(level) / 6.0;
            }
        const double expected = p * right.entropy() + (1.0 - p) * wrong.entropy();
        if (expected < least - 1e-12) {
            least = expected;
            at = level;
        }
    }
    CHECK(quest.level() == at);
    CHECK(quest.entropy() == Approx(std::log(3.0)));  // of the threshold alone
}

TEST_CASE("QUEST+ survives answers that contradict each other and levels off its list") {
    QuestPlus quest(quest_settings());
    for (int i = 0; i < 300; ++i) {
        quest.answer(5.0, false);
        quest.answer(-5.0, true);
        CHECK(std::isfinite(quest.level()));
        CHECK(std::isfinite(quest.entropy()));
    }
    CHECK_THROWS_AS(quest.answer(std::nan(""), true), Error);
    QuestSettings bad = quest_settings();
    bad.levels.clear();
    CHECK_THROWS_AS(QuestPlus(bad), Error);
    bad = quest_settings();
    bad.thresholds = {1.0, 0.5};
    CHECK_THROWS_AS(QuestPlus(bad), Error);
    bad = quest_settings();
    bad.guess = 0.99;
    CHECK_THROWS_AS(QuestPlus(bad), Error);
    bad = quest_settings();
    bad.target = 0.5;  // chance: every level has it
    CHECK_THROWS_AS(QuestPlus(bad), Error);
}

TEST_CASE("each reversal halves the first steps of a staircase down to the final one") {
    StaircaseRule rule;
    rule.step_up = rule.step_down = 0.01;
    rule.first_factor = 4.0;
    rule.down = 1;
    Staircase stairs(rule);
    double before = stairs.level(), direction = -1.0;
    bool right = true;
    for (const double step : {0.04, 0.02, 0.01, 0.01}) {
        stairs.answer(right);
        CHECK(stairs.level() - before == Approx(direction * step));
        before = stairs.level();
        right = !right;
        direction = -direction;
    }
}

TEST_CASE("staircases and QUEST+ find random thresholds off the grid with little bias, and their intervals cover them",
          "[slow]") {
    constexpr int subjects = 300;
    constexpr std::array slopes{2.0, 3.0, 5.0};
    std::array<double, slopes.size()> slope_error{};  // of the staircase
    double quest_error = 0.0, stairs_error = 0.0, stairs_square = 0.0;
    int quest_covers = 0, stairs_covers = 0;
    const PosteriorSettings settings =
        threshold_prior(Form::weibull, 0.5, 0.02, usual_slopes(Form::weibull), two_down().min, two_down().max);
    for (int subject = 0; subject < subjects; ++subject) {
        const Random where{static_cast<std::uint64_t>(500 + subject)};
        const double threshold = -0.5 + where.uniform(0);
        const std::size_t slope = static_cast<std::size_t>(subject) % slopes.size();
        Observer observer{{Form::weibull, threshold, slopes[slope], 0.5, 0.02},
                          Random{static_cast<std::uint64_t>(subject)}};
        const StaircaseRule rule = two_down();
        const double wanted = observer.function.level_of(rule.target());
        const auto error_of = [&](auto& method, int& covers) {
            std::vector<double> levels;
            std::vector<bool> correct;
            for (int trial = 0; trial < rule.max_trials; ++trial) {
                levels.push_back(method.level());
                correct.push_back(observer.answers(levels.back()));
                if constexpr (std::is_same_v<decltype(method), Staircase&>) method.answer(correct.back());
                else method.answer(levels.back(), correct.back());
            }
            const PosteriorLevel level = posterior_level(count_levels(levels, correct), settings, rule.target());
            covers += level.interval.low <= wanted && wanted <= level.interval.high ? 1 : 0;
            return level.median - wanted;
        };
        QuestPlus quest(quest_settings());
        quest_error += error_of(quest, quest_covers);
        Staircase stairs(rule);
        const double error = error_of(stairs, stairs_covers);
        stairs_error += error;
        slope_error[slope] += error * slopes.size() / subjects;
        stairs_square += error * error;
    }
    // After 60 trials: 2 % of the threshold is 0.0086 in log10.
    CHECK(std::abs(quest_error / subjects) < 0.0086);
    CHECK(std::abs(stairs_error / subjects) < 0.0086);
    // The mean over slopes hides a bias of each: the prior of the slopes attracts the median.
    for (const double error : slope_error) CHECK(std::abs(error) < 0.035);
    CHECK(std::sqrt(stairs_square / subjects) < 0.11);
    CHECK(quest_covers >= 0.93 * subjects);
    CHECK(stairs_covers >= 0.93 * subjects);
}

TEST_CASE("usual slopes have the same widths in each form, and the prior of the analysis spans more") {
    for (const double scale : {1.0, 3.5})
        for (const Form form : {Form::weibull, Form::logistic, Form::normal}) {
            const std::vector<double> slopes = usual_slopes(form, scale);
            REQUIRE(slopes.size() == 4);
            constexpr std::array widths{0.683, 0.342, 0.195, 0.137};
            for (std::size_t i = 0; i < widths.size(); ++i) {
                const Psychometric function{form, 0.0, slopes[i], 0.0, 0.0};
                CHECK((function.level_of(0.75) - function.level_of(0.25)) / scale == Approx(widths[i]).epsilon(0.005));
            }
            const PosteriorSettings prior = threshold_prior(form, 0.5, 0.02, slopes, -1.0, 0.0);
            CHECK(prior.low == -1.5);
            CHECK(prior.high == 0.5);
            CHECK(prior.slopes.front() == Approx(slopes.front()));
            CHECK(prior.slopes.back() == Approx(4.0 * slopes.back()));
        }
    CHECK_THROWS_AS(threshold_prior(Form::weibull, 0.5, 0.02, {}, -1.0, 0.0), Error);
}

TEST_CASE("the posterior of a level is that of brute force, and refuses what has none") {
    const std::vector<LevelCount> counts{{-0.2, 10, 6}, {0.0, 12, 9}, {0.3, 8, 8}};
    PosteriorSettings settings{Form::logistic, 0.5, 0.01, {5.0, 12.0}, -1.0, 1.0};
    const PosteriorLevel found = posterior_level(counts, settings, 0.75);
    double below = 0.0, low = 0.0, high = 0.0, total = 0.0;
    for (int i = 0; i < 20'000; ++i)
        for (const double slope : settings.slopes) {
            const double level = -1.0 + 1e-4 * (i + 0.5);
            Psychometric function{Form::logistic, 0.0, slope, 0.5, 0.01};
            function.threshold = level - function.level_of(0.75);
            double likelihood = 1.0;
            for (const LevelCount& count : counts)
                likelihood *= std::pow(function.at(count.level), count.correct) *
                              std::pow(1.0 - function.at(count.level), count.trials - count.correct);
            total += likelihood;
            below += level < found.median ? likelihood : 0.0;
            low += level < found.interval.low ? likelihood : 0.0;
            high += level < found.interval.high ? likelihood : 0.0;
        }
    CHECK(below / total == Approx(0.5).margin(1e-3));
    CHECK(low / total == Approx(0.025).margin(1e-3));
    CHECK(high / total == Approx(0.975).margin(1e-3));
    CHECK_THROWS_AS(posterior_level({}, settings, 0.75), Error);
    CHECK_THROWS_AS(posterior_level(counts, settings, 0.4), Error);
    settings.slopes.clear();
    CHECK_THROWS_AS(posterior_level(counts, settings, 0.75), Error);
}
