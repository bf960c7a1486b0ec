// SPDX-License-Identifier: Apache-2.0
// How often the tests of experiments err, what their intervals cover, and how many trials adaptive methods need.
#include "assets/file/json.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/core/random.hpp"
#include "dsp/psychophysics/posterior.hpp"
#include "dsp/psychophysics/quest_plus.hpp"
#include "dsp/psychophysics/staircase.hpp"
#include "dsp/statistics/carry_over.hpp"
#include "dsp/statistics/orders.hpp"
#include "dsp/statistics/paired.hpp"
#include "tools/analysis/experiment/run_experiment.hpp"
#include "tools/bench/bench.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

constexpr double max_between_trials = 50e-3;  // s
constexpr double max_bias = 2.0;  // percent of the threshold
constexpr int min_trials_for_bias = 60;

struct ExperimentsChoice {
    int studies = 10'000, observers = 1000, subjects = 16, intervals = 100;
    bool json = false;
};

/// A rate with the range that it should be in.
struct Rate {
    std::string name;
    double percent = 0.0, low = 0.0, high = 100.0;
    bool ok() const { return percent >= low && percent <= high; }
};

/// Differences of one study; each study and comparison has numbers of its own.
std::vector<double> study_of(int subjects, double mean, std::uint64_t study, std::uint64_t comparison) {
    const Random random{mix(study) ^ mix(comparison + 77)};
    std::vector<double> differences;
    for (int i = 0; i < subjects; ++i) differences.push_back(mean + random.normal(static_cast<std::uint64_t>(i)));
    return differences;
}

/// A co-location study with this effect of the mode, and no carry-over.
statistics::CarryOver co_location_carry_over(int subjects, double effect, std::uint64_t study) {
    const Random random{mix(study) ^ mix(991)};
    std::vector<statistics::PeriodValue> values;
    for (int s = 0; s < subjects; ++s) {
        const auto subject = static_cast<std::size_t>(s);
        const auto periods = statistics::co_location_row(subject).periods();
        for (std::size_t period = 0; period < periods.size(); ++period) {
            const auto [display, mode] = periods[period];
            const double carried = period == 0 ? 0.0 : periods[period - 1][1] == 1 ? 0.5 : -0.5;
            values.push_back({subject, period, 2 * display + mode,
                              effect * static_cast<double>(mode) + random.normal(4 * subject + period), carried});
        }
    }
    return statistics::carry_over(values, {-0.5, 0.5, -0.5, 0.5});
}

std::vector<Rate> error_rates(const ExperimentsChoice& choice) {
    constexpr std::size_t family = 4;
    constexpr double margin = 0.9, effect = 0.6;
    int t = 0, permutation = 0, holm = 0, equivalence = 0, both = 0, crossed = 0, period = 0, covered = 0,
        cross_covered = 0, equivalent = 0, carried = 0, carry_effect = 0, carry_covered = 0;
    std::vector<bool> b_second;
    for (int i = 0; i < choice.subjects; ++i) b_second.push_back(i % 2 == 0);
    for (int s = 0; s < choice.studies; ++s) {
        const auto study = static_cast<std::uint64_t>(s);
        std::vector<double> p;
        for (std::uint64_t c = 0; c < family; ++c)
            p.push_back(statistics::paired_t(study_of(choice.subjects, 0.0, study, c)).p);
        t += p[0] < 0.05 ? 1 : 0;
        holm += std::ranges::any_of(statistics::holm(p), [](double one) { return one < 0.05; }) ? 1 : 0;
        const std::vector<double> null = study_of(choice.subjects, 0.0, study, 0);
        permutation += statistics::permutation_test(null, study).p < 0.05 ? 1 : 0;
        const statistics::CrossOver cross = statistics::cross_over(null, b_second);
        crossed += cross.p < 0.05 ? 1 : 0;
        period += cross.period_p < 0.05 ? 1 : 0;
        // Both errors that a study could make: an effect where there is none, or equivalence at the margin.
        const auto at_margin =
            statistics::standardised_equivalence(study_of(choice.subjects, margin, study, 9), margin);
        equivalence += at_margin.verdict == statistics::Equivalence::equivalent ? 1 : 0;
        both += statistics::equivalence_test(study_of(choice.subjects, margin, study, 9), margin).verdict ==
                        statistics::Equivalence::equivalent
                    ? 1
                    : 0;
        equivalent +=
            statistics::standardised_equivalence(null, margin).verdict == statistics::Equivalence::equivalent ? 1 : 0;
        const std::vector<double> real = study_of(choice.subjects, effect, study, 20);
        const statistics::PairedTest test = statistics::paired_t(real);
        covered += test.low <= effect && effect <= test.high ? 1 : 0;
        const statistics::CarryOver carry = co_location_carry_over(std::max(8, choice.subjects), effect, study);
        carried += carry.carried_p < 0.05 ? 1 : 0;
        carry_covered += carry.low <= effect && effect <= carry.high ? 1 : 0;
        carry_effect += co_location_carry_over(std::max(8, choice.subjects), 0.0, study).p < 0.05 ? 1 : 0;
        const statistics::CrossOver adjusted = statistics::cross_over(real, b_second);
        cross_covered += adjusted.low <= effect && effect <= adjusted.high ? 1 : 0;
    }
    const auto percent = [&](int count) { return 100.0 * count / choice.studies; };
    const double power =
        100.0 * statistics::power_of_standardised_equivalence(static_cast<std::size_t>(choice.subjects), margin);
    return {{"paired t, no effect: positives", percent(t), 4.3, 5.7},
            {"permutation, no effect: positives", percent(permutation), 4.3, 5.7},
            {"cross-over, no effect: positives", percent(crossed), 4.3, 5.7},
            {"period, no effect: positives", percent(period), 4.3, 5.7},
            {"Holm, 4 comparisons without effect: any", percent(holm), 0.0, 5.7},
            {"equivalence at the margin (0.9 sd, estimated)", percent(equivalence), 0.0, 5.7},
            {"equivalence at the margin (known)", percent(both), 0.0, 5.7},
            {fmt::format("equivalence shown without effect ({:.1f} % computed)", power), percent(equivalent),
             power - 1.0, power + 1.0},
            {"carry-over, none: positives", percent(carried), 4.3, 5.7},
            {"effect adjusted for carry-over, none: positives", percent(carry_effect), 4.3, 5.7},
            {"the same, 0.6 sd: intervals of 95 % that cover", percent(carry_covered), 94.3, 95.7},
            {"paired t, 0.6 sd: intervals of 95 % that cover", percent(covered), 94.3, 95.7},
            {"cross-over, 0.6 sd: intervals of 95 % that cover", percent(cross_covered), 94.3, 95.7}};
}

/// Errors of the threshold, log10, after each number of trials.
struct MethodErrors {
    std::vector<std::vector<double>> quest, stairs;
};
constexpr std::array<int, 6> trial_counts{20, 30, 40, 60, 80, 120};
constexpr std::array<double, 3> true_slopes{2.0, 3.0, 5.0};  // of one observer after another
constexpr std::size_t judged = 3;  // of trial_counts: a session
double true_slope(int observer) { return true_slopes[static_cast<std::size_t>(observer) % true_slopes.size()]; }

psychophysics::StaircaseRule two_down_one_up() {
    psychophysics::StaircaseRule rule;
    rule.start = 0.8;
    rule.min = -1.5;
    rule.max = 1.5;
    rule.step_up = rule.step_down = 0.05;
    rule.reversals = 1000;
    rule.max_trials = trial_counts.back();
    return rule;
}

psychophysics::QuestSettings wide_prior() {
    psychophysics::QuestSettings settings;
    for (int i = 0; i <= 80; ++i) settings.thresholds.push_back(-0.8 + 0.02 * i);  // 1.6 decades
    for (int i = 0; i <= 40; ++i) settings.levels.push_back(-1.0 + 0.05 * i);
    settings.target = two_down_one_up().target();
    settings.slopes = psychophysics::usual_slopes(settings.form);
    return settings;
}

psychophysics::PosteriorSettings posterior_settings() {
    const psychophysics::StaircaseRule rule = two_down_one_up();
    const psychophysics::Form form = psychophysics::Form::weibull;
    return psychophysics::threshold_prior(form, 0.5, 0.02, psychophysics::usual_slopes(form), rule.min, rule.max);
}

MethodErrors adaptive_errors(int observers) {
    MethodErrors errors{std::vector<std::vector<double>>(trial_counts.size()),
                        std::vector<std::vector<double>>(trial_counts.size())};
    const psychophysics::StaircaseRule rule = two_down_one_up();
    const psychophysics::PosteriorSettings settings = posterior_settings();
    for (int o = 0; o < observers; ++o) {
        const auto seed = static_cast<std::uint64_t>(o);
        const double threshold = -0.5 + Random{mix(seed + 5)}.uniform(0);
        const psychophysics::Psychometric truth{psychophysics::Form::weibull, threshold, true_slope(o), 0.5, 0.02};
        // Both are judged at the level about which this staircase settles.
        const double wanted = truth.level_of(rule.target());
        const auto run = [&](auto&& level_of, auto&& answer, std::uint64_t stream,
                             std::vector<std::vector<double>>& into) {
            const Random random{mix(seed) ^ stream};
            std::vector<double> levels;
            std::vector<bool> correct;
            std::size_t next = 0;
            for (int trial = 1; trial <= trial_counts.back(); ++trial) {
                levels.push_back(level_of());
                correct.push_back(random.uniform(static_cast<std::uint64_t>(trial)) < truth.at(levels.back()));
                answer(levels.back(), correct.back());
                if (trial != trial_counts[next]) continue;
                const auto level = psychophysics::posterior_level(psychophysics::count_levels(levels, correct),
                                                                  settings, rule.target());
                into[next++].push_back(level.median - wanted);
            }
        };
        psychophysics::QuestPlus quest(wide_prior());
        run([&] { return quest.level(); }, [&](double level, bool right) { quest.answer(level, right); }, 1,
            errors.quest);
        psychophysics::Staircase stairs(rule);
        run([&] { return stairs.level(); }, [&](double, bool right) { stairs.answer(right); }, 2, errors.stairs);
    }
    return errors;
}

/// How often intervals of 95 % cover the threshold, percent.
struct Coverage {
    double bootstrap = 0.0, posterior = 0.0;
};
struct Covered {
    Coverage constant, quest, stairs;
    double next_level = 0.0;  ///< the most processor time in which QUEST+ chose the next level, s
};

/// The most processor time between the end of a trial and the beginning of the next one, s: measures, answer, record, next level, and
/// its patch compiled.
double between_trials() {
    constexpr int trials = 40;
    const run::ScratchFolder scratch;
    analysis::ExperimentChoice choice;
    choice.protocol = experiment::load_protocol(run::find_experiment("stiffness"));
    choice.out = scratch.path() / "data";
    choice.subject = "P01";
    std::atomic<bool> stop{false};
    const std::atomic<bool> never{false};
    compile::AssetCache assets;
    double worst = 0.0, ended = -1.0;
    int done_trials = 0;
    analysis::ExperimentHooks hooks;
    hooks.say = [](const std::string&) {};
    hooks.confirm = [](const std::string&, char) { return true; };
    hooks.ask = [&](const experiment::Protocol&) { return analysis::Answered{done_trials % 2, 0.3}; };
    hooks.progress = [&](const analysis::TrialSpec&, int, int) { stop = ++done_trials == trials; };
    hooks.perform = [&](const run::RunChoice& run, const experiment::Condition&, std::atomic<bool>&,
                        analysis::TurnedLevel*) {
        (void)run::load_plan(run, assets);
        if (ended >= 0.0) worst = std::max(worst, thread_seconds() - ended);
        analysis::LiveEnd end{run::render_run(run, assets, never, [](double) {}).summary, {}, false};
        ended = thread_seconds();
        return end;
    };
    run_experiment(choice, hooks, stop);
    return worst;
}

Covered covered_thresholds(int observers) {
    Covered covered;
    psychophysics::FitSettings settings;
    settings.lapse = 0.02;
    const psychophysics::StaircaseRule rule = two_down_one_up();
    const int trials = rule.max_trials;
    for (int o = 0; o < observers; ++o) {
        const auto seed = static_cast<std::uint64_t>(o);
        const psychophysics::Psychometric truth{psychophysics::Form::weibull, -0.5 + Random{mix(seed + 9)}.uniform(0),
                                                true_slope(o), 0.5, 0.02};
        const double p = rule.target(), wanted = truth.level_of(p);
        const auto count_covers = [&](auto&& level_of, auto&& answer, std::uint64_t stream, Coverage& coverage) {
            const Random random{mix(seed) ^ mix(stream)};
            std::vector<double> levels;
            std::vector<bool> correct;
            for (int trial = 0; trial < trials; ++trial) {
                levels.push_back(level_of(trial));
                correct.push_back(random.uniform(static_cast<std::uint64_t>(trial)) < truth.at(levels.back()));
                answer(levels.back(), correct.back());
            }
            const auto counts = psychophysics::count_levels(levels, correct);
            const auto fit = psychophysics::fit_psychometric(counts, settings);
            const auto add = [&](const psychophysics::Interval& interval, double& percent) {
                percent += interval.low <= wanted && wanted <= interval.high ? 100.0 / observers : 0.0;
            };
            add(psychophysics::bootstrap_fit(counts, settings, fit, p, 199, 0.95, seed).threshold, coverage.bootstrap);
            add(psychophysics::posterior_level(counts, posterior_settings(), p).interval, coverage.posterior);
        };
        psychophysics::QuestPlus quest(wide_prior());
        count_covers([&](int) { return quest.level(); },
                     [&](double level, bool right) {
                         const double begin = thread_seconds();
                         quest.answer(level, right);
                         covered.next_level = std::max(covered.next_level, thread_seconds() - begin);
                     },
                     11, covered.quest);
        psychophysics::Staircase stairs(rule);
        count_covers([&](int) { return stairs.level(); }, [&](double, bool right) { stairs.answer(right); }, 12,
                     covered.stairs);
        count_covers([&](int trial) { return truth.threshold - 0.3 + 0.15 * (trial % 5); }, [](double, bool) {}, 13,
                     covered.constant);
    }
    return covered;
}

double rms(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum / static_cast<double>(values.size()));
}

double bias_percent(const std::vector<double>& values) {
    return 100.0 * (std::pow(10.0, statistics::moments(values).mean) - 1.0);
}

/// Of the observers with one of the true slopes.
double bias_percent(const std::vector<double>& errors, std::size_t slope) {
    std::vector<double> own;
    for (std::size_t o = slope; o < errors.size(); o += true_slopes.size()) own.push_back(errors[o]);
    return bias_percent(own);
}

/// Trials with which QUEST+ has the error that the staircase has after `trial_counts[at]`, interpolated in logarithms.
double trials_of_quest(const std::vector<double>& quest, double wanted) {
    for (std::size_t i = 0; i + 1 < quest.size(); ++i)
        if (quest[i + 1] <= wanted) {
            if (quest[i] <= wanted) return trial_counts[i];
            const double share = std::log(quest[i] / wanted) / std::log(quest[i] / quest[i + 1]);
            return trial_counts[i] * std::pow(static_cast<double>(trial_counts[i + 1]) / trial_counts[i], share);
        }
    return trial_counts.back();
}

/// Percent of trials saved at the error of a staircase of 60 trials: the value, and the lower bound of 95 % by a bootstrap over
/// observers.
std::pair<double, double> saved_trials(const MethodErrors& errors) {
    constexpr std::size_t at = judged;
    const std::size_t observers = errors.quest.front().size();
    const auto saved = [&](auto&& index) {
        std::vector<double> quest;
        for (const auto& one : errors.quest) {
            std::vector<double> drawn;
            for (std::size_t o = 0; o < observers; ++o) drawn.push_back(one[index(o)]);
            quest.push_back(rms(drawn));
        }
        std::vector<double> drawn;
        for (std::size_t o = 0; o < observers; ++o) drawn.push_back(errors.stairs[at][index(o)]);
        return 100.0 * (1.0 - trials_of_quest(quest, rms(drawn)) / trial_counts[at]);
    };
    std::vector<double> all;
    for (std::uint64_t sample = 0; sample < 500; ++sample) {
        const Random random{sample + 1};
        all.push_back(saved([&](std::size_t o) {
            return static_cast<std::size_t>(random.uniform(o) * static_cast<double>(observers));
        }));
    }
    std::ranges::sort(all);
    return {saved([](std::size_t o) { return o; }), all[25]};
}

/// Of either method, from a number of trials on that a session has.
double max_bias_percent(const MethodErrors& errors) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < trial_counts.size(); ++i)
        if (trial_counts[i] >= min_trials_for_bias)
            greatest = std::max({greatest, std::abs(bias_percent(errors.quest[i])),
                                 std::abs(bias_percent(errors.stairs[i]))});
    return greatest;
}

int bench_experiments(const ExperimentsChoice& choice) {
    const std::vector<Rate> rates = error_rates(choice);
    const MethodErrors errors = adaptive_errors(choice.observers);
    const auto [saved, saved_low] = saved_trials(errors);
    const Covered covered = covered_thresholds(choice.intervals);
    const double between = between_trials();
    const double bias = max_bias_percent(errors);
    const bool ok = std::ranges::all_of(rates, &Rate::ok) && saved_low >= 20.0 && between <= max_between_trials &&
                    bias < max_bias;
    if (choice.json) {
        Json json{{"ok", ok}, {"rates", Json::array()}, {"adaptive", Json::array()}, {"slopes", Json::array()}};
        for (const Rate& rate : rates)
            json["rates"].push_back(
                {{"name", rate.name}, {"percent", rate.percent}, {"low", rate.low}, {"high", rate.high}});
        for (std::size_t i = 0; i < trial_counts.size(); ++i)
            json["adaptive"].push_back({{"trials", trial_counts[i]},
                                        {"quest_rmse_log10", rms(errors.quest[i])},
                                        {"quest_bias_percent", bias_percent(errors.quest[i])},
                                        {"staircase_rmse_log10", rms(errors.stairs[i])},
                                        {"staircase_bias_percent", bias_percent(errors.stairs[i])}});
        for (std::size_t slope = 0; slope < true_slopes.size(); ++slope)
            json["slopes"].push_back({{"slope", true_slopes[slope]},
                                      {"quest_bias_percent", bias_percent(errors.quest[judged], slope)},
                                      {"staircase_bias_percent", bias_percent(errors.stairs[judged], slope)}});
        json["max_bias_percent"] = bias;
        json["bootstrap_covers_percent"] = {{"constant", covered.constant.bootstrap},
                                            {"quest_plus", covered.quest.bootstrap},
                                            {"staircase", covered.stairs.bootstrap}};
        json["posterior_covers_percent"] = {{"constant", covered.constant.posterior},
                                            {"quest_plus", covered.quest.posterior},
                                            {"staircase", covered.stairs.posterior}};
        json["quest_plus_next_level_max_ms"] = 1e3 * covered.next_level;
        json["between_trials_max_ms"] = 1e3 * between;
        json["trials_saved_percent"] = saved;
        json["trials_saved_low_percent"] = saved_low;
        fmt::print("{}\n", json.dump(2));
        return ok ? done : answer_is_no;
    }
    fmt::print("{} simulated studies of {} subjects\n", choice.studies, choice.subjects);
    for (const Rate& rate : rates)
        fmt::print("{:<58} {:>6.2f} %   {:.1f} to {:.1f}{}\n", rate.name, rate.percent, rate.low, rate.high,
                   rate.ok() ? "" : "  BEYOND");
    fmt::print(
        "\n{} simulated observers, thresholds over 1 decade, slopes {}; prior of QUEST+ 1.6 decades, of the median 6; "
        "two-alternative choice\n{:>7} "
        "{:>22} {:>26}\n",
        choice.observers, fmt::join(true_slopes, ", "), "trials", "QUEST+ rmse, bias", "2-down 1-up rmse, bias");
    for (std::size_t i = 0; i < trial_counts.size(); ++i)
        fmt::print("{:>7} {:>13.4f} {:>+6.2f} % {:>17.4f} {:>+6.2f} %\n", trial_counts[i], rms(errors.quest[i]),
                   bias_percent(errors.quest[i]), rms(errors.stairs[i]), bias_percent(errors.stairs[i]));
    for (std::size_t slope = 0; slope < true_slopes.size(); ++slope)
        fmt::print("bias after {} trials of observers with a slope of {}: QUEST+ {:+.2f} %, staircase {:+.2f} %\n",
                   trial_counts[judged], true_slopes[slope], bias_percent(errors.quest[judged], slope),
                   bias_percent(errors.stairs[judged], slope));
    fmt::print(
        "QUEST+ needs {:.0f} % fewer trials than a staircase of {} (at least {:.0f} %, one-sided bound of 95 %, wanted: 20 %){}\n",
        saved, trial_counts[judged], saved_low, saved_low >= 20.0 ? "" : "  BEYOND");
    fmt::print("largest bias from {} trials on: {:.2f} %   below {:.0f} %{}\n", min_trials_for_bias, bias, max_bias,
               bias < max_bias ? "" : "  BEYOND");
    fmt::print("\nintervals of 95 % after {} trials that cover, {} observers\n{:<18} {:>11} {:>11}\n", trial_counts.back(),
               choice.intervals, "", "bootstrap", "posterior");
    for (const auto& [name, coverage] :
         {std::pair{"constant stimuli", covered.constant}, {"QUEST+", covered.quest}, {"staircase", covered.stairs}})
        fmt::print("{:<18} {:>9.1f} % {:>9.1f} %\n", name, coverage.bootstrap, coverage.posterior);
    fmt::print("QUEST+ chose the next level within {:.2f} ms of processor time\n", 1e3 * covered.next_level);
    fmt::print("between two trials of 'stiffness': at most {:.1f} ms of processor time (wanted: {:.0f} ms)\n",
               1e3 * between, 1e3 * max_between_trials);
    return ok ? done : answer_is_no;
}

}  // namespace

Verb experiments_verb() {
    return {
        "experiments",
        "errors of the tests of experiments over simulated studies, and trials that adaptive methods need; exit code 1: "
        "one is beyond its range",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<ExperimentsChoice>();
            verb.add("--studies", choice->studies, "simulated studies").range(100, 1'000'000).shows_default();
            verb.add("--subjects", choice->subjects, "of a study").range(4, 20).shows_default();
            verb.add("--observers", choice->observers, "of each adaptive method").range(20, 100'000).shows_default();
            verb.add("--intervals", choice->intervals,
                     "observers whose thresholds get intervals by the bootstrap and by the posterior")
                .range(10, 100'000)
                .shows_default();
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_experiments(*choice); };
        }};
}

}  // namespace tactus::bench
