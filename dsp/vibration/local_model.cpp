// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/local_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::vibration {

namespace {

using Complex = std::complex<double>;
constexpr std::size_t model_unknowns = 4;  // b0, b1, b2, a1
using Terms = std::array<Complex, model_unknowns>;
using Equations = std::array<std::array<Complex, model_unknowns + 1>, model_unknowns>;  // with the right side

/// By elimination with pivots; false when singular.
bool solve_model(Equations& m, Terms& solution) {
    for (std::size_t i = 0; i < model_unknowns; ++i) {
        std::size_t pivot = i;
        for (std::size_t k = i + 1; k < model_unknowns; ++k)
            if (std::abs(m[k][i]) > std::abs(m[pivot][i])) pivot = k;
        if (!(std::abs(m[pivot][i]) > 0.0)) return false;
        std::swap(m[i], m[pivot]);
        for (std::size_t k = i + 1; k < model_unknowns; ++k) {
            const Complex factor = m[k][i] / m[i][i];
            for (std::size_t c = i; c <= model_unknowns; ++c) m[k][c] -= factor * m[i][c];
        }
    }
    for (std::size_t i = model_unknowns; i-- > 0;) {
        Complex sum = m[i][model_unknowns];
        for (std::size_t c = i + 1; c < model_unknowns; ++c) sum -= m[i][c] * solution[c];
        solution[i] = sum / m[i][i];
    }
    return true;
}

/// Normal equations of the linearised problem with the weights of the last denominator.
Equations normal_equations(std::span<const ResponseBin> bins, const LocalModel& model) {
    Equations m{};
    for (const ResponseBin& bin : bins) {
        const double x = (bin.hz - model.centre) / model.half_width;
        const double weight = bin.weight / std::max(1e-12, std::norm(1.0 + model.denominator * x));
        const Terms row{1.0, x, x * x, -x * bin.gain};
        for (std::size_t i = 0; i < model_unknowns; ++i) {
            for (std::size_t k = 0; k < model_unknowns; ++k) m[i][k] += weight * std::conj(row[i]) * row[k];
            m[i][model_unknowns] += weight * std::conj(row[i]) * bin.gain;
        }
    }
    return m;
}

/// Normal equations of the differences from a model, for a step of Gauss and Newton.
Equations step_equations(std::span<const ResponseBin> bins, const LocalModel& model) {
    Equations m{};
    for (const ResponseBin& bin : bins) {
        const double x = (bin.hz - model.centre) / model.half_width;
        const Complex below = 1.0 + model.denominator * x, value = model(bin.hz);
        if (!(std::abs(below) > 1e-6)) continue;
        const Terms row{1.0 / below, x / below, x * x / below, -x * value / below};
        for (std::size_t i = 0; i < model_unknowns; ++i) {
            for (std::size_t k = 0; k < model_unknowns; ++k) m[i][k] += bin.weight * std::conj(row[i]) * row[k];
            m[i][model_unknowns] += bin.weight * std::conj(row[i]) * (bin.gain - value);
        }
    }
    return m;
}

/// Weighted sum of squares of measured less model.
double residual_of(std::span<const ResponseBin> bins, const LocalModel& model) {
    double sum = 0.0;
    for (const ResponseBin& bin : bins) sum += bin.weight * std::norm(bin.gain - model(bin.hz));
    return sum;
}

/// The linearised problem is biased by noise, as the measured values are among its regressors; the least squares of the
/// model itself are not. A step that does not lower them is halved.
void descend(std::span<const ResponseBin> bins, LocalModel& model) {
    double best = residual_of(bins, model);
    for (int round = 0; round < 8; ++round) {
        Equations m = step_equations(bins, model);
        Terms step{};
        if (!solve_model(m, step)) return;
        bool is_better = false;
        for (double length = 1.0; length > 0.05 && !is_better; length *= 0.5) {
            LocalModel next = model;
            for (std::size_t i = 0; i < next.numerator.size(); ++i) next.numerator[i] += length * step[i];
            next.denominator += length * step[model_unknowns - 1];
            if (const double left = residual_of(bins, next); left < best) {
                is_better = true;
                const bool is_done = left > (1.0 - 1e-6) * best;
                best = left;
                model = next;
                if (is_done) return;
            }
        }
        if (!is_better) return;
    }
}

}  // namespace

Complex LocalModel::operator()(double hz) const {
    const double x = (hz - centre) / half_width;
    return (numerator[0] + x * (numerator[1] + x * numerator[2])) / (1.0 + denominator * x);
}

bool LocalModel::is_significant() const {
    if (bins < 8.0 || !(std::abs(denominator) > 0.0) || !(pole().imag() > 0.0)) return false;
    // 6 real parameters more than a constant; the F distribution with 6 and many degrees exceeds 8 once in a million.
    return (constant - residual) * (2.0 * bins - 8.0) > 6.0 * 8.0 * residual;
}

LocalModel fit_local_model(std::span<const ResponseBin> bins, double centre, double half_width, double oversampling) {
    LocalModel model;
    model.centre = centre;
    model.half_width = half_width;
    double sum = 0.0, squares = 0.0;
    Complex mean = 0.0;
    for (const ResponseBin& bin : bins) {
        sum += bin.weight;
        squares += bin.weight * bin.weight;
        mean += bin.weight * bin.gain;
    }
    if (!(sum > 0.0)) return model;
    model.bins = sum * sum / squares / oversampling;
    mean /= sum;
    if (model.bins < 8.0) return model;
    for (int round = 0; round < 4; ++round) {
        Equations m = normal_equations(bins, model);
        Terms solution{};
        if (!solve_model(m, solution)) return model;
        model.numerator = {solution[0], solution[1], solution[2]};
        model.denominator = solution[3];
    }
    descend(bins, model);
    model.residual = residual_of(bins, model) / sum;
    for (const ResponseBin& bin : bins) model.constant += bin.weight * std::norm(bin.gain - mean) / sum;
    // Variance of a1: the residual per bin times the last diagonal element of the inverse of the normal matrix.
    Equations m = step_equations(bins, model);
    for (std::size_t i = 0; i < model_unknowns; ++i) m[i][model_unknowns] = i + 1 == model_unknowns ? 1.0 : 0.0;
    if (Terms column{}; solve_model(m, column)) {
        const double variance =
            model.residual * sum / std::max(1.0, model.bins - 4.0) * oversampling * column[model_unknowns - 1].real();
        model.pole_deviation = half_width / std::norm(model.denominator) * std::sqrt(0.5 * std::max(0.0, variance));
    }
    return model;
}

}  // namespace tactus::vibration
