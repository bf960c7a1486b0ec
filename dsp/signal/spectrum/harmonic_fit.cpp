// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/harmonic_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tactus::signal {

namespace {

using Complex = std::complex<double>;

/// Sums of e^{iφt}, t·e^{iφt}/i and t²·e^{iφt} over n centred times −(n−1)/2 … (n−1)/2; all are real.
struct KernelSums {
    double zero, first, second;

    KernelSums(double angle, double n) {
        const double half = 0.5 * angle;
        if (std::abs(half * n) < 1e-3) {
            const double squares = n * (n * n - 1.0) / 12.0;
            zero = n - 2.0 * half * half * squares;
            first = 2.0 * half * squares;
            second = squares;
            return;
        }
        // D(φ) = sin(nφ/2)/sin(φ/2); the sums are D, −D′ and −D″.
        const double s = std::sin(half), c = std::cos(half), sn = std::sin(n * half), cn = std::cos(n * half);
        zero = sn / s;
        const double slope = 0.5 * (n * cn * s - sn * c) / (s * s);
        const double curve = 0.25 * ((1.0 - n * n) * sn / s - 2.0 * c * (n * cn * s - sn * c) / (s * s * s));
        first = -slope;
        second = -curve;
    }
};

/// In place: a·x = b for a Hermitian positive definite `a` (row-major), by Cholesky factors. Several right-hand sides.
class HermitianSolver {
public:
    explicit HermitianSolver(std::vector<Complex> a, std::size_t n) : l_(std::move(a)), n_(n) {
        for (std::size_t j = 0; j < n_; ++j) {
            for (std::size_t k = 0; k < j; ++k) at(j, j) -= std::norm(at(j, k));
            at(j, j) = std::sqrt(std::max(at(j, j).real(), 1e-9));
            for (std::size_t i = j + 1; i < n_; ++i) {
                for (std::size_t k = 0; k < j; ++k) at(i, j) -= at(i, k) * std::conj(at(j, k));
                at(i, j) /= at(j, j).real();
            }
        }
    }
    std::vector<Complex> operator()(std::vector<Complex> b) const {
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t k = 0; k < i; ++k) b[i] -= at(i, k) * b[k];
            b[i] /= at(i, i).real();
        }
        for (std::size_t i = n_; i-- > 0;) {
            for (std::size_t k = i + 1; k < n_; ++k) b[i] -= std::conj(at(k, i)) * b[k];
            b[i] /= at(i, i).real();
        }
        return b;
    }

private:
    Complex& at(std::size_t i, std::size_t j) { return l_[i * n_ + j]; }
    const Complex& at(std::size_t i, std::size_t j) const { return l_[i * n_ + j]; }
    std::vector<Complex> l_;
    std::size_t n_;
};

/// Σ x e^{−iωt} and Σ t x e^{−iωt} over centred times.
void correlate_at(std::span<const double> samples, double omega, Complex& zero, Complex& first) {
    constexpr std::size_t block = 256;  // the phasor is exact at the start of each
    const double middle = 0.5 * (static_cast<double>(samples.size()) - 1.0);
    const Complex step = std::polar(1.0, -omega);
    zero = first = 0.0;
    for (std::size_t start = 0; start < samples.size(); start += block) {
        const double from = static_cast<double>(start) - middle;
        const Complex base = std::polar(1.0, std::remainder(-omega * from, 2.0 * std::numbers::pi));
        Complex turn = 1.0, sum = 0.0, moment = 0.0;
        const std::size_t count = std::min(block, samples.size() - start);
        for (std::size_t i = 0; i < count; ++i) {
            const double re = samples[start + i] * turn.real(), im = samples[start + i] * turn.imag();
            sum += Complex(re, im);
            moment += static_cast<double>(i) * Complex(re, im);
            turn = {turn.real() * step.real() - turn.imag() * step.imag(),
                    turn.real() * step.imag() + turn.imag() * step.real()};
        }
        zero += base * sum;
        first += base * (from * sum + moment);
    }
}

}  // namespace

HarmonicFit fit_harmonics(std::span<const double> samples, double rate, double frequency, std::span<const int> orders,
                          std::span<const double> others) {
    const auto n = static_cast<double>(samples.size());
    const double to_angle = 2.0 * std::numbers::pi / rate;
    double energy = 0.0;
    for (const double x : samples) energy += x * x;
    HarmonicFit out{frequency, 0.0};
    const double start = frequency;
    const int top = orders.empty() ? 1 : *std::max_element(orders.begin(), orders.end());
    for (int round = 0; round < 6; ++round) {
        // Columns: the constant, then a pair of conjugates per line; `order` is 0 for those that do not move.
        std::vector<double> omega{0.0}, order{0.0};
        std::vector<Complex> zero(1), first(1);
        correlate_at(samples, 0.0, zero[0], first[0]);
        const auto add = [&](double f, double k) {
            Complex y, z;
            correlate_at(samples, f * to_angle, y, z);
            omega.insert(omega.end(), {f * to_angle, -f * to_angle});
            order.insert(order.end(), {k, -k});
            zero.insert(zero.end(), {y, std::conj(y)});
            first.insert(first.end(), {z, std::conj(z)});
        };
        for (const int k : orders) add(k * out.frequency, k);
        for (const double f : others) add(f, 0.0);
        const std::size_t m = omega.size();
        std::vector<Complex> gram(m * m);
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = 0; j < m; ++j) gram[i * m + j] = KernelSums(omega[j] - omega[i], n).zero;
        for (std::size_t i = 0; i < m; ++i) gram[i * m + i] *= 1.0 + 1e-12;
        const HermitianSolver solve(gram, m);
        const std::vector<Complex> c = solve(zero);
        // J = Σ c_k·i·k·t·e^{ikθt}: derivative of the model by the angle θ per sample.
        std::vector<Complex> slope(m), across(m);
        for (std::size_t k = 0; k < m; ++k) slope[k] = c[k] * Complex(0.0, order[k]);
        Complex square = 0.0, with_data = 0.0, with_model = 0.0;
        for (std::size_t i = 0; i < m; ++i) {
            for (std::size_t j = 0; j < m; ++j) {
                const KernelSums sums(omega[j] - omega[i], n);
                across[i] += slope[j] * Complex(0.0, sums.first);
                square += std::conj(slope[i]) * slope[j] * sums.second;
            }
            with_data += std::conj(slope[i]) * first[i];
        }
        for (std::size_t i = 0; i < m; ++i) with_model += std::conj(across[i]) * c[i];
        const std::vector<Complex> along = solve(across);
        for (std::size_t i = 0; i < m; ++i) square -= std::conj(across[i]) * along[i];
        double left = energy;
        for (std::size_t i = 0; i < m; ++i) left -= (std::conj(c[i]) * zero[i]).real();
        if (!(square.real() > 0.0)) return {start, rate / n};
        const double noise = std::max(left, 1e-15 * energy) / std::max(1.0, n - static_cast<double>(m) - 1.0);
        out.deviation = std::sqrt(noise / square.real()) / to_angle;
        const double limit = 0.3 * rate / n / top;
        const double step = std::clamp((with_data - with_model).real() / square.real() / to_angle, -limit, limit);
        out.frequency += step;
        if (std::abs(step) < 0.01 * out.deviation || std::abs(step) < 1e-9 * out.frequency) break;
    }
    return out;
}

}  // namespace tactus::signal
