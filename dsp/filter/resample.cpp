// SPDX-License-Identifier: Apache-2.0
#include "dsp/filter/resample.hpp"

#include "dsp/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double half_width = 20.0;   // zero crossings of the sinc on each side
constexpr double attenuation = 80.0;  // dB
constexpr int most_phases = 1024;

/// Modified Bessel function of order 0.
double bessel(double x) {
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 50; ++k) {
        term *= (0.5 * x / k) * (0.5 * x / k);
        sum += term;
    }
    return sum;
}

/// Low-pass of gain 1 with its edge at `cutoff` cycles per sample (Kaiser window), tabulated.
class Kernel {
public:
    explicit Kernel(double cutoff) : reach_(half_width / (2.0 * cutoff)) {
        const double beta = 0.1102 * (attenuation - 8.7);
        table_.resize(table_size + 2);
        for (std::size_t i = 0; i < table_size; ++i) {
            const double u = static_cast<double>(i) / table_size, angle = pi * half_width * u;
            const double window = bessel(beta * std::sqrt(1.0 - u * u)) / bessel(beta);
            table_[i] = 2.0 * cutoff * window * (i == 0 ? 1.0 : std::sin(angle) / angle);
        }
    }
    double reach() const { return reach_; }
    /// At a distance in samples. The table is fine enough for −100 dB.
    double operator()(double x) const {
        const double u = std::abs(x) / reach_ * table_size;
        if (u >= table_size) return 0.0;
        const auto i = static_cast<std::size_t>(u);
        return table_[i] + (table_[i + 1] - table_[i]) * (u - static_cast<double>(i));
    }

private:
    static constexpr std::size_t table_size = 16384;
    double reach_;
    std::vector<double> table_;
};

/// The kernel's values around a position that lies `fraction` of a sample after a sample.
void fill(const Kernel& kernel, double fraction, std::ptrdiff_t reach, std::vector<double>& taps) {
    taps.clear();
    double sum = 0.0;
    for (std::ptrdiff_t j = 1 - reach; j <= reach; ++j) {
        taps.push_back(kernel(static_cast<double>(j) - fraction));
        sum += taps.back();
    }
    for (double& tap : taps) tap /= sum;
}

template <class Sample>
std::vector<double> resampled(std::span<const Sample> samples, double from, double to, double start) {
    if (!(from > 0.0 && to > 0.0 && std::isfinite(from) && std::isfinite(to) && std::isfinite(start)))
        throw Error("resampling needs two positive rates");
    // The Kaiser window's transition is this wide, in cycles per lower rate; its end may just touch 0.6.
    const double lower = std::min(1.0, to / from);
    const Kernel kernel(0.5 * lower);
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kernel.reach())) + 1;
    const double step = from / to, begin = start * from;
    const double last = static_cast<double>(samples.size()) - 1.0;
    const auto count = static_cast<std::size_t>(std::max(0.0, std::floor((last - begin) / step + 1e-9) + 1.0));
    // How many outputs until the fraction comes back, if that is soon.
    int phases = 0;
    if (begin == std::floor(begin))
        for (int n = 1; n <= most_phases && phases == 0; ++n)
            if (std::abs(n * step - std::round(n * step)) < 1e-9) phases = n;

    std::vector<std::vector<double>> table(static_cast<std::size_t>(phases));
    for (int p = 0; p < phases; ++p) {
        const double position = p * step;
        const double whole = std::floor(position + 1e-9);
        fill(kernel, std::max(0.0, position - whole), reach, table[static_cast<std::size_t>(p)]);
    }
    std::vector<double> out(count), own;
    const auto size = static_cast<std::ptrdiff_t>(samples.size());
    for (std::size_t k = 0; k < count; ++k) {
        const double position = begin + static_cast<double>(k) * step;
        const double whole = std::floor(position + 1e-9);
        if (phases == 0) fill(kernel, std::max(0.0, position - whole), reach, own);
        const std::vector<double>& taps = phases > 0 ? table[k % static_cast<std::size_t>(phases)] : own;
        const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(whole) + 1 - reach;
        const std::ptrdiff_t a = std::max<std::ptrdiff_t>(0, -first);
        const std::ptrdiff_t b = std::min<std::ptrdiff_t>(2 * reach, size - first);
        // Four partial sums in a fixed order: faster, and the same bits everywhere.
        double sums[4] = {};
        std::ptrdiff_t j = a;
        for (; j + 4 <= b; j += 4)
            for (std::ptrdiff_t lane = 0; lane < 4; ++lane)
                sums[lane] += taps[static_cast<std::size_t>(j + lane)] *
                              static_cast<double>(samples[static_cast<std::size_t>(first + j + lane)]);
        for (; j < b; ++j)
            sums[0] +=
                taps[static_cast<std::size_t>(j)] * static_cast<double>(samples[static_cast<std::size_t>(first + j)]);
        out[k] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    }
    return out;
}

}  // namespace

std::vector<double> resample(std::span<const float> samples, double from, double to, double start) {
    return resampled(samples, from, to, start);
}

std::vector<double> resample(std::span<const double> samples, double from, double to, double start) {
    return resampled(samples, from, to, start);
}

}  // namespace tactus
