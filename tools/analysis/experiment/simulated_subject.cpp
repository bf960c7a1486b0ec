// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/simulated_subject.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/core/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <vector>

namespace tactus::analysis {

using experiment::ResponseKind;

namespace {

/// Streams of random numbers that a subject uses.
enum Stream : std::uint64_t { of_subject = 1, of_answer, of_time, of_hand, of_match };

constexpr int most_presses = 12;  // between two presentations

}  // namespace

SimulatedSubject::SimulatedSubject(const experiment::ObserverModel& model, const experiment::Protocol& protocol,
                                   const std::string& pseudonym)
    : model_(model), protocol_(protocol) {
    Hash hash;
    hash.add_word(model.seed);
    hash.add_text(pseudonym);
    seed_ = hash.value();
    const std::string file = model.file.string();
    if (protocol.is_psychophysics() && !model.has_observer)
        throw Error(fmt::format("{}: this experiment needs a simulated observer: add a table [observer]", file));
    if (!protocol.is_psychophysics() && !model.has_hand)
        throw Error(fmt::format("{}: this experiment needs a simulated hand: add a table [hand]", file));
    std::vector<std::string> conditions;
    for (const auto& condition : protocol.conditions) conditions.push_back(condition.name);
    for (const auto& [condition, threshold] : model.observer.thresholds)
        if (std::ranges::find(conditions, condition) == conditions.end())
            throw Error(fmt::format("{}: the experiment has no condition '{}'{}", file, condition,
                                    did_you_mean(condition, conditions)));
    if (protocol.is_psychophysics() && protocol.stimulus->is_log)
        for (std::size_t i = 0; i < protocol.conditions.size(); ++i)
            if (!(threshold(i) > 0.0))
                throw Error(
                    fmt::format("{}: the threshold of condition '{}' must be above 0: levels are on a log scale", file,
                                conditions[i]));
    for (const experiment::HandEffect& effect : model.hand.effects) {
        const bool is_known = std::ranges::any_of(protocol.conditions, [&](const experiment::Condition& condition) {
            const auto found = condition.factors.find(effect.factor);
            return found != condition.factors.end() && found->second == effect.level;
        });
        if (!is_known)
            throw Error(fmt::format("{}: no condition has the factor {} = \"{}\"", file, effect.factor, effect.level));
    }
}

double SimulatedSubject::threshold(std::size_t condition) const {
    const auto& observer = model_.observer;
    const auto own = observer.thresholds.find(protocol_.conditions[condition].name);
    const double threshold = own == observer.thresholds.end() ? observer.threshold : own->second;
    return threshold * std::pow(10.0, observer.spread * Random{seed_ ^ mix(of_subject)}.normal(0));
}

SimulatedAnswer SimulatedSubject::answer(const TrialSpec& spec, std::optional<double> rendered_level) const {
    const auto& observer = model_.observer;
    const experiment::Stimulus& stimulus = *protocol_.stimulus;
    const bool is_choice = protocol_.response.kind == ResponseKind::choice;
    psychophysics::Psychometric function;
    function.form = observer.form;
    function.threshold = stimulus.axis(threshold(spec.condition));
    function.slope = observer.slope;
    function.guess = is_choice ? protocol_.response.guess() : observer.false_alarms;
    function.lapse = observer.lapse;
    const bool is_there = spec.interval > 0 && rendered_level && (!stimulus.is_log || *rendered_level > 0.0);
    const double p = is_there ? function.at(stimulus.axis(*rendered_level)) : function.guess;
    const Random random{seed_ ^ mix(of_answer)};
    const auto index = static_cast<std::uint64_t>(spec.number) * 4;
    const bool detects = random.uniform(index) < p;
    SimulatedAnswer answer;
    if (is_choice) {
        // Without a detected difference it guesses among the wrong ones, since `p` includes the lucky guesses.
        const int others = protocol_.response.intervals - 1;
        const int right = spec.interval - 1;
        answer.answer =
            detects ? right
                    : (right + 1 + static_cast<int>(random.uniform(index + 1) * others)) % protocol_.response.intervals;
    } else {
        answer.answer = detects ? 1 : 0;
    }
    // Log-normal with a spread of 0.3.
    answer.response_time = observer.response_time * std::exp(0.3 * Random{seed_ ^ mix(of_time)}.normal(index));
    return answer;
}

int SimulatedSubject::presses(const TrialSpec& spec, std::optional<double> rendered_level) const {
    const auto& observer = model_.observer;
    const experiment::Stimulus& stimulus = *protocol_.stimulus;
    if (!rendered_level || (stimulus.is_log && !(*rendered_level > 0.0))) return most_presses;
    const double noise = Random{seed_ ^ mix(of_match)}.normal(static_cast<std::uint64_t>(spec.number));
    const double wanted = stimulus.axis(threshold(spec.condition)) + observer.match_spread * noise +
                          (protocol_.begins_above(spec.level) ? observer.match_lag : -observer.match_lag);
    const double missing = std::round((wanted - stimulus.axis(*rendered_level)) / protocol_.method.step);
    return static_cast<int>(std::clamp(missing, -double{most_presses}, double{most_presses}));
}

std::string SimulatedSubject::hand_targets(const TrialSpec& spec) const {
    const experiment::Task& task = protocol_.tasks[spec.task];
    const auto& condition = protocol_.conditions[spec.condition];
    const auto& hand = model_.hand;
    if (task.ideal.empty())
        throw Error(fmt::format("{}: task '{}' has no ideal movement, so no simulated subject can do it",
                                protocol_.file.string(), task.name));
    const Random random{seed_ ^ mix(of_hand) ^ mix(static_cast<std::uint64_t>(spec.number))},
        person{seed_ ^ mix(of_subject)};
    double time = hand.time * std::exp(hand.spread_time * person.normal(1) + hand.trial_time * random.normal(1)),
           error = hand.error * std::exp(hand.spread_error * person.normal(2) + hand.trial_error * random.normal(2));
    for (const experiment::HandEffect& effect : hand.effects) {
        const auto found = condition.factors.find(effect.factor);
        if (found == condition.factors.end() || found->second != effect.level) continue;
        if (!effect.task.empty() && effect.task != task.name) continue;
        time *= effect.time;
        error *= effect.error;
    }
    if (!task.is_self_paced) time = 1.0;
    std::istringstream lines(file::read_whole_file(task.ideal));
    std::string text;
    std::uint64_t index = 10;
    Vec3 last(std::numeric_limits<double>::infinity());
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (line.empty() || line.front() == '#') continue;
        double at = 0.0, x = 0.0, y = 0.0, z = 0.0;
        int used = 0;
        // "1.5 s: X Y Z mm | trigger"
        if (std::sscanf(line.c_str(), "%lf s: %lf %lf %lf mm%n", &at, &x, &y, &z, &used) != 4 || used == 0)
            throw Error(SourceLocation{task.ideal.string(), number, 1}, "a target is TIME s: X Y Z mm | BUTTON");
        // Presses repeat the target that they confirm: the hand stays where it is.
        const Vec3 ideal(x, y, z);
        if (ideal != last) index += 3;
        last = ideal;
        const double mm = 1e3 * error;
        text += fmt::format("{:.6f} s: {:.6f} {:.6f} {:.6f} mm{}\n", time * at + (at > 0.0 ? hand.lag : 0.0),
                            x + mm * random.normal(index), y + mm * random.normal(index + 1),
                            z + mm * random.normal(index + 2), line.substr(static_cast<std::size_t>(used)));
    }
    return text;
}

}  // namespace tactus::analysis
