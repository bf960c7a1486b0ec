// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/quest_plus.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::psychophysics {

namespace {

double plogp(double p) { return p > 0.0 ? p * std::log(p) : 0.0; }

void check_list(const std::vector<double>& list, const char* name) {
    if (list.empty()) throw Error(fmt::format("QUEST+ needs at least one value of {}", name));
    if (!std::ranges::all_of(list, [](double v) { return std::isfinite(v); }) ||
        std::ranges::adjacent_find(list, [](double a, double b) { return !(a < b); }) != list.end())
        throw Error(fmt::format("the values of {} must be finite and ascending", name));
}

}  // namespace

QuestPlus::QuestPlus(const QuestSettings& settings) : settings_(settings) {
    check_list(settings.levels, "levels");
    check_list(settings.thresholds, "thresholds");
    check_list(settings.slopes, "slopes");
    check_list(settings.lapses, "lapses");
    if (!(settings.slopes.front() > 0.0)) throw Error("slopes must be positive");
    if (!(settings.guess >= 0.0 && settings.lapses.front() >= 0.0 && settings.guess + settings.lapses.back() < 1.0))
        throw Error("guess and lapse rates must be at least 0 and together below 1");
    const std::size_t count = settings.thresholds.size() * settings.slopes.size() * settings.lapses.size();
    posterior_.assign(count, 1.0 / static_cast<double>(count));
    likelihood_.reserve(count * settings.levels.size());
    likelihood_entropy_.reserve(count * settings.levels.size());
    for (const double level : settings.levels)
        for (std::size_t i = 0; i < count; ++i) {
            const double p = parameters(i).at(level);
            likelihood_.push_back(p);
            likelihood_entropy_.push_back(-plogp(p) - plogp(1.0 - p));
        }
    choose();
}

Psychometric QuestPlus::parameters(std::size_t index) const {
    const std::size_t slopes = settings_.slopes.size(), lapses = settings_.lapses.size();
    return {settings_.form, settings_.thresholds[index / (slopes * lapses)], settings_.slopes[index / lapses % slopes],
            settings_.guess, settings_.lapses[index % lapses]};
}

void QuestPlus::choose() {
    // Expected entropy of the posterior = H(prior) − mutual information; the information is H(answer) − E[H(answer | parameters)],
    // so one pass without logarithms over the combinations suffices.
    double best = -1.0;
    for (std::size_t l = 0; l < settings_.levels.size(); ++l) {
        const double* p = likelihood_.data() + l * posterior_.size();
        const double* h = likelihood_entropy_.data() + l * posterior_.size();
        double correct = 0.0, given = 0.0;
        for (std::size_t i = 0; i < posterior_.size(); ++i) {
            correct += posterior_[i] * p[i];
            given += posterior_[i] * h[i];
        }
        const double information = -plogp(correct) - plogp(1.0 - correct) - given;
        // Rounding must not decide between levels that are equally informative.
        if (information > best + 1e-12) {
            best = information;
            next_ = l;
        }
    }
}

void QuestPlus::answer(double level, bool correct) {
    if (!std::isfinite(level)) throw Error("the level of an answer is not a finite number");
    double sum = 0.0;
    for (std::size_t i = 0; i < posterior_.size(); ++i) {
        const double p = parameters(i).at(level);
        // An answer that a combination excludes may still be a slip: nothing becomes impossible.
        posterior_[i] *= std::max(correct ? p : 1.0 - p, 1e-12);
        sum += posterior_[i];
    }
    for (double& p : posterior_) p /= sum;
    choose();
}

Psychometric QuestPlus::mean() const {
    Psychometric mean{settings_.form, 0.0, 0.0, settings_.guess, 0.0};
    for (std::size_t i = 0; i < posterior_.size(); ++i) {
        const Psychometric one = parameters(i);
        mean.threshold += posterior_[i] * one.threshold;
        mean.slope += posterior_[i] * std::log(one.slope);
        mean.lapse += posterior_[i] * one.lapse;
    }
    mean.slope = std::exp(mean.slope);
    return mean;
}

double QuestPlus::threshold_deviation() const {
    const double mean_threshold = mean().threshold;
    double sum = 0.0;
    for (std::size_t i = 0; i < posterior_.size(); ++i) {
        const double from_mean = parameters(i).threshold - mean_threshold;
        sum += posterior_[i] * from_mean * from_mean;
    }
    return std::sqrt(sum);
}

double QuestPlus::entropy() const {
    double sum = 0.0;
    for (const double p : posterior_) sum -= plogp(p);
    return sum;
}

}  // namespace tactus::psychophysics
