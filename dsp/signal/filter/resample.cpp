// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/resample.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/filter/bessel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::signal {

namespace {

constexpr double half_width = 20.0;   // zero crossings of the sinc on each side
constexpr double attenuation = 80.0;  // dB
constexpr std::size_t max_phases = 1024;

constexpr std::size_t table_size = 16384;

/// One side of a low-pass kernel of gain 1 with its edge at `cutoff` cycles per sample (Kaiser window), tabulated so
/// finely that linear interpolation has an error of −100 dB.
std::vector<double> kernel_table(double cutoff) {
    const double beta = 0.1102 * (attenuation - 8.7);
    std::vector<double> table(table_size + 2);
    for (std::size_t i = 0; i < table_size; ++i) {
        const double u = static_cast<double>(i) / table_size, angle = pi * half_width * u;
        const double window = bessel_i0(beta * std::sqrt(1.0 - u * u)) / bessel_i0(beta);
        table[i] = 2.0 * cutoff * window * (i == 0 ? 1.0 : std::sin(angle) / angle);
    }
    return table;
}

/// The kernel at a distance in samples from the middle; it ends at `reach`.
double value_at(const std::vector<double>& table, double reach, double x) {
    const double u = std::abs(x) / reach * table_size;
    if (u >= table_size) return 0.0;
    const auto i = static_cast<std::size_t>(u);
    return table[i] + (table[i + 1] - table[i]) * (u - static_cast<double>(i));
}

/// The taps of the kernel for a position `fraction` of a sample after a sample.
void fill(const std::vector<double>& table, double kernel_reach, double fraction, std::ptrdiff_t reach,
          std::vector<double>& taps) {
    taps.clear();
    double sum = 0.0;
    for (std::ptrdiff_t j = 1 - reach; j <= reach; ++j) {
        taps.push_back(value_at(table, kernel_reach, static_cast<double>(j) - fraction));
        sum += taps.back();
    }
    for (double& tap : taps) tap /= sum;
}

template <class Sample>
std::vector<double> resampled(std::span<const Sample> samples, double from, double to, double start) {
    ResamplingStream stream(samples.size(), from, to, start);
    std::vector<double> out;
    out.reserve(stream.frames());
    stream.push(samples, out);
    return out;
}

}  // namespace

ResamplingStream::ResamplingStream(std::size_t frames, double from, double to, double start)
    : begin_(start * from), step_(from / to), size_(static_cast<std::ptrdiff_t>(frames)) {
    if (!(from > 0.0 && to > 0.0 && std::isfinite(from) && std::isfinite(to) && std::isfinite(start)))
        throw Error("resampling needs two positive rates");
    // Width of the Kaiser window's transition, in cycles per lower rate; its end may just reach 0.6.
    const double cutoff = 0.5 * std::min(1.0, to / from);
    kernel_ = kernel_table(cutoff);
    kernel_reach_ = half_width / (2.0 * cutoff);
    reach_ = static_cast<std::ptrdiff_t>(std::ceil(kernel_reach_)) + 1;
    const double last = static_cast<double>(frames) - 1.0;
    count_ = static_cast<std::size_t>(std::max(0.0, std::floor((last - begin_) / step_ + 1e-9) + 1.0));
    std::size_t phases = 0;
    for (std::size_t n = 1; n <= max_phases && phases == 0; ++n) {
        const double position = static_cast<double>(n) * step_;
        if (std::abs(position - std::round(position)) < 1e-9) phases = n;
    }
    period_ = std::llround(static_cast<double>(phases) * step_);
    phases_.resize(phases);
    for (std::size_t p = 0; p < phases; ++p) {
        const double position = begin_ - std::floor(begin_) + static_cast<double>(p) * step_;
        const double whole = std::floor(position + 1e-9);
        phases_[p].whole = static_cast<std::ptrdiff_t>(std::floor(begin_) + whole);
        fill(kernel_, kernel_reach_, std::max(0.0, position - whole), reach_, phases_[p].taps);
    }
}

template <class Sample>
void ResamplingStream::push(std::span<const Sample> samples, std::vector<double>& out) {
    held_.insert(held_.end(), samples.begin(), samples.end());
    const std::ptrdiff_t end = held_from_ + static_cast<std::ptrdiff_t>(held_.size());
    std::ptrdiff_t first = held_from_;
    for (; done_ < count_; ++done_) {
        std::ptrdiff_t whole = 0;
        const double* taps = nullptr;
        double fraction = 0.0;
        if (!phases_.empty()) {
            const Phase& phase = phases_[done_ % phases_.size()];
            whole = phase.whole + static_cast<std::ptrdiff_t>(done_ / phases_.size()) * period_;
            taps = phase.taps.data();
        } else {
            const double position = begin_ + static_cast<double>(done_) * step_;
            whole = static_cast<std::ptrdiff_t>(std::floor(position + 1e-9));
            fraction = std::max(0.0, position - static_cast<double>(whole));
        }
        first = whole + 1 - reach_;
        if (first + 2 * reach_ > end && end < size_) break;
        if (taps == nullptr) {
            fill(kernel_, kernel_reach_, fraction, reach_, own_);
            taps = own_.data();
        }
        const std::ptrdiff_t a = std::max<std::ptrdiff_t>(0, -first);
        const std::ptrdiff_t count = std::min<std::ptrdiff_t>(2 * reach_, size_ - first) - a;
        const double* at = held_.data() + (first + a - held_from_);
        taps += a;
        // Four partial sums in a fixed order: faster, with the same bits everywhere.
        double sums[4] = {};
        std::ptrdiff_t j = 0;
        for (; j + 4 <= count; j += 4)
            for (std::ptrdiff_t lane = 0; lane < 4; ++lane) sums[lane] += taps[j + lane] * at[j + lane];
        for (; j < count; ++j) sums[0] += taps[j] * at[j];
        out.push_back((sums[0] + sums[1]) + (sums[2] + sums[3]));
    }
    if (done_ == count_) first = end;
    const std::ptrdiff_t used = std::clamp<std::ptrdiff_t>(first - held_from_, 0, end - held_from_);
    held_.erase(held_.begin(), held_.begin() + used);
    held_from_ += used;
}

template void ResamplingStream::push<float>(std::span<const float>, std::vector<double>&);
template void ResamplingStream::push<double>(std::span<const double>, std::vector<double>&);

std::vector<double> resample(std::span<const float> samples, double from, double to, double start) {
    return resampled(samples, from, to, start);
}

std::vector<double> resample(std::span<const double> samples, double from, double to, double start) {
    return resampled(samples, from, to, start);
}

}  // namespace tactus::signal
