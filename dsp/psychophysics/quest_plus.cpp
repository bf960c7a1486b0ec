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

double entropy_of(double p) { return -plogp(p) - plogp(1.0 - p); }  // of an answer that is correct with p

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
    if (!(settings.target > settings.guess && settings.target < 1.0 - settings.lapses.back()))
        throw Error(fmt::format("the target {:.3g} must lie between guess ({:.3g}) and 1 - lapse ({:.3g})",
                                settings.target, settings.guess, 1.0 - settings.lapses.back()));
    for (const double level : settings.thresholds)
        for (const double slope : settings.slopes)
            for (const double lapse : settings.lapses) {
                Psychometric function{settings.form, 0.0, slope, settings.guess, lapse};
                function.threshold = level - function.level_of(settings.target);
                functions_.push_back(function);
            }
    posterior_.assign(functions_.size(), 1.0 / static_cast<double>(functions_.size()));
    likelihood_.reserve(functions_.size() * settings.levels.size());
    for (const double level : settings.levels)
        for (const Psychometric& function : functions_) likelihood_.push_back(function.at(level));
    choose();
}

void QuestPlus::choose() {
    // Expected entropy of the threshold = H(threshold) - information; the information is H(answer) - E[H(answer | threshold)].
    const std::size_t columns = nuisances(), rows = settings_.thresholds.size();
    std::vector<double> mass(rows);
    for (std::size_t t = 0; t < rows; ++t)
        for (std::size_t i = 0; i < columns; ++i) mass[t] += posterior_[t * columns + i];
    double best = -1.0;
    for (std::size_t l = 0; l < settings_.levels.size(); ++l) {
        const double* p = likelihood_.data() + l * posterior_.size();
        double correct = 0.0, given = 0.0;
        for (std::size_t t = 0; t < rows; ++t) {
            if (!(mass[t] > 0.0)) continue;
            double own = 0.0;  // correct, and this threshold
            for (std::size_t i = 0; i < columns; ++i) own += posterior_[t * columns + i] * p[t * columns + i];
            correct += own;
            given += mass[t] * entropy_of(own / mass[t]);
        }
        const double information = entropy_of(correct) - given;
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
        const double p = functions_[i].at(level);
        // An answer that a combination excludes may still be a slip: nothing becomes impossible.
        posterior_[i] *= std::max(correct ? p : 1.0 - p, 1e-12);
        sum += posterior_[i];
    }
    for (double& p : posterior_) p /= sum;
    choose();
}

double QuestPlus::entropy() const {
    const std::size_t columns = nuisances();
    double sum = 0.0;
    for (std::size_t t = 0; t < settings_.thresholds.size(); ++t) {
        double mass = 0.0;
        for (std::size_t i = 0; i < columns; ++i) mass += posterior_[t * columns + i];
        sum -= plogp(mass);
    }
    return sum;
}

}  // namespace tactus::psychophysics
