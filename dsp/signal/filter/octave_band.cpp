// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/octave_band.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::signal {

OctaveFilter::OctaveFilter(double low, double high, double rate) : rate_(rate) {
    if (!(low > 0.0 && low < high && high < 0.5 * rate))
        throw Error(fmt::format("a band of {:g} to {:g} Hz must lie between 0 Hz and half the sample rate, {:g} Hz",
                                low, high, 0.5 * rate));
    // In units of the rate, edges prewarped.
    const double below = 2.0 * std::tan(pi * low / rate), above = 2.0 * std::tan(pi * high / rate);
    const double half_width = 0.5 * (above - below), square = below * above;
    const double centre = rate / pi * std::atan(0.5 * std::sqrt(square));
    const auto section = [&](std::complex<double> prototype, double sign) {
        const std::complex<double> p = prototype * half_width;
        const std::complex<double> pole = p + sign * std::sqrt(p * p - square), z = (2.0 + pole) / (2.0 - pole);
        BiquadCoefficients c{1.0, 0.0, -1.0, -2.0 * z.real(), std::norm(z)};
        c.b0 = 1.0 / std::abs(c.response(centre, rate));
        c.b2 = -c.b0;
        return c;
    };
    const std::complex<double> upper = std::polar(1.0, 2.0 * pi / 3.0);
    sections_[0].coefficients = section(upper, 1.0);
    sections_[1].coefficients = section(upper, -1.0);
    sections_[2].coefficients = section(-1.0, 1.0);
}

std::complex<double> OctaveFilter::response(double frequency) const {
    std::complex<double> product = 1.0;
    for (const Biquad& one : sections_) product *= one.coefficients.response(frequency, rate_);
    return product;
}

void OctaveFilter::reset() noexcept {
    for (Biquad& one : sections_) one.s1 = one.s2 = 0.0;
}

OctaveBank::OctaveBank(int per_octave, double rate, std::size_t frames) : rate_(rate) {
    if (!(rate > 0.0)) throw Error("octave filters need a sample rate above 0 Hz");
    const int step = per_octave == 1 ? 3 : 1;  // of tenths of a decade
    const double half = std::pow(10.0, 0.05 * step), seconds = static_cast<double>(frames) / rate;
    for (int n = 0; n <= 60; n += step) {
        FilteredBand band;
        band.centre = std::pow(10.0, 0.1 * n);
        band.low = band.centre / half;
        band.high = band.centre * half;
        if ((band.high - band.low) * seconds < 4.0) continue;
        if (band.high > OctaveFilter::highest_edge * rate) break;
        lanes_.push_back({band, {band.low, band.high, rate}});
    }
}

void OctaveBank::push(std::span<const double> samples) {
    for (Lane& lane : lanes_) {
        double sum = 0.0;
        for (const double x : samples) {
            const double y = lane.filter(x);
            sum += y * y;
        }
        lane.band.power += sum;
    }
    count_ += samples.size();
}

void OctaveBank::gap() {
    for (Lane& lane : lanes_) lane.filter.reset();
}

std::vector<FilteredBand> OctaveBank::bands() const {
    std::vector<FilteredBand> out;
    const double seconds = static_cast<double>(count_) / rate_;
    for (const Lane& lane : lanes_) {
        FilteredBand band = lane.band;
        if (count_ > 0) band.power /= static_cast<double>(count_);
        // Of the power of noise: 1/√(B T) (Bendat and Piersol, random data).
        band.deviation_db = seconds > 0.0 ? 10.0 / std::log(10.0) / std::sqrt((band.high - band.low) * seconds) : 0.0;
        out.push_back(band);
    }
    return out;
}

}  // namespace tactus::signal
