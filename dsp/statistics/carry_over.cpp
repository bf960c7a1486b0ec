// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/carry_over.hpp"

#include "dsp/core/error.hpp"
#include "dsp/statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::statistics {

namespace {

using Column = std::vector<double>;

/// Normal equations, factorised by Cholesky.
class LeastSquares {
public:
    /// Throws Error when a column depends on those before it.
    explicit LeastSquares(const std::vector<Column>& columns) : count_(columns.size()), root_(count_ * count_, 0.0) {
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = 0.0;
                for (std::size_t row = 0; row < columns[i].size(); ++row) sum += columns[i][row] * columns[j][row];
                const double diagonal = sum;
                for (std::size_t k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
                if (i != j) {
                    at(i, j) = sum / at(j, j);
                    continue;
                }
                if (!(sum > 1e-9 * diagonal))
                    throw Error("the orders of these subjects do not separate treatments, periods and carry-over");
                at(i, i) = std::sqrt(sum);
            }
    }

    /// Solution of the normal equations with this right side.
    std::vector<double> solve(std::vector<double> right) const {
        for (std::size_t i = 0; i < count_; ++i) {
            for (std::size_t k = 0; k < i; ++k) right[i] -= at(i, k) * right[k];
            right[i] /= at(i, i);
        }
        for (std::size_t i = count_; i-- > 0;) {
            for (std::size_t k = i + 1; k < count_; ++k) right[i] -= at(k, i) * right[k];
            right[i] /= at(i, i);
        }
        return right;
    }

    /// Variance of a weighted sum of the coefficients, for residuals of variance 1.
    double variance(const std::vector<double>& weights) const {
        const std::vector<double> solved = solve(weights);
        double sum = 0.0;
        for (std::size_t i = 0; i < count_; ++i) sum += weights[i] * solved[i];
        return sum;
    }

private:
    double& at(std::size_t i, std::size_t j) { return root_[i * count_ + j]; }
    double at(std::size_t i, std::size_t j) const { return root_[i * count_ + j]; }

    std::size_t count_;
    std::vector<double> root_;  // lower triangle
};

}  // namespace

CarryOver carry_over(std::span<const PeriodValue> values, const std::vector<double>& contrast, double confidence) {
    std::size_t subjects = 0, periods = 0;
    for (const PeriodValue& one : values) {
        subjects = std::max(subjects, one.subject + 1);
        periods = std::max(periods, one.period + 1);
        if (one.treatment >= contrast.size()) throw Error("a treatment has no weight in the contrast");
        if (!std::isfinite(one.value)) throw Error("a value is not a finite number");
    }
    // A column for each subject; the first period and the first treatment are the reference.
    std::vector<Column> columns;
    std::vector<double> weights;
    const auto add = [&](double weight, auto&& of) {
        columns.emplace_back();
        for (const PeriodValue& one : values) columns.back().push_back(of(one));
        weights.push_back(weight);
    };
    const auto is = [](bool yes) { return yes ? 1.0 : 0.0; };
    for (std::size_t s = 0; s < subjects; ++s) add(0.0, [&](const PeriodValue& one) { return is(one.subject == s); });
    for (std::size_t p = 1; p < periods; ++p) add(0.0, [&](const PeriodValue& one) { return is(one.period == p); });
    for (std::size_t t = 1; t < contrast.size(); ++t)
        add(contrast[t], [&](const PeriodValue& one) { return is(one.treatment == t); });
    const double plain = LeastSquares(columns).variance(weights);
    add(0.0, [](const PeriodValue& one) { return one.carried; });
    const LeastSquares model(columns);
    CarryOver result;
    result.freedom = static_cast<double>(values.size()) - static_cast<double>(columns.size());
    if (!(result.freedom >= 1.0))
        throw Error("too few values for the terms of subjects, periods, treatments and carry-over");
    std::vector<double> right;
    for (const Column& column : columns) {
        double sum = 0.0;
        for (std::size_t row = 0; row < values.size(); ++row) sum += column[row] * values[row].value;
        right.push_back(sum);
    }
    const std::vector<double> solution = model.solve(right);
    double residual = 0.0, total = 0.0;
    for (std::size_t row = 0; row < values.size(); ++row) {
        double fitted = 0.0;
        for (std::size_t i = 0; i < columns.size(); ++i) fitted += solution[i] * columns[i][row];
        residual += (values[row].value - fitted) * (values[row].value - fitted);
        total += values[row].value * values[row].value;
    }
    const double variance = residual / result.freedom;
    if (!(residual > 1e-24 * total)) throw Error("the values have no residual: no test is possible");
    std::vector<double> last(columns.size(), 0.0);
    last.back() = 1.0;
    const double factor = model.variance(weights);
    result.variance_factor = factor / plain;
    for (std::size_t i = 0; i < columns.size(); ++i) result.effect += weights[i] * solution[i];
    result.carried = solution.back();
    const double error = std::sqrt(variance * factor), carried_error = std::sqrt(variance * model.variance(last));
    const double quantile = student_quantile(0.5 + 0.5 * confidence, result.freedom);
    result.low = result.effect - error * quantile;
    result.high = result.effect + error * quantile;
    result.p = student_two_sided(result.effect / error, result.freedom);
    result.carried_low = result.carried - carried_error * quantile;
    result.carried_high = result.carried + carried_error * quantile;
    result.carried_p = student_two_sided(result.carried / carried_error, result.freedom);
    return result;
}

}  // namespace tactus::statistics
