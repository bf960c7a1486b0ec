// SPDX-License-Identifier: Apache-2.0
// The C functions that analyse records in memory.
#include "dsp/signal/exposure/hand_arm.hpp"
#include "dsp/signal/exposure/weighting.hpp"
#include "dsp/signal/spectrum/comparison.hpp"
#include "dsp/signal/spectrum/welch.hpp"
#include "tools/embed/c_errors.hpp"
#include "tools/embed/tactus.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

using namespace tactus;

namespace {

constexpr double max_rate = 1e7;  // Hz: memory for a second

std::span<const double> record_of(const double* samples, std::size_t count, double rate, const char* what) {
    if (!samples || count == 0) throw Error(fmt::format("the {} has no samples", what));
    if (!(rate > 0.0 && rate <= max_rate))
        throw Error(fmt::format("the {}'s rate, {} Hz, is not between 0 and 10 MHz", what, rate));
    const std::span<const double> record(samples, count);
    for (std::size_t i = 0; i < count; ++i)
        if (!std::isfinite(record[i]))
            throw Error(fmt::format("the {}'s sample {} is not finite: {}", what, i, record[i]));
    return record;
}

double or_none(const std::optional<double>& value) { return value.value_or(std::numeric_limits<double>::quiet_NaN()); }

}  // namespace

extern "C" {

size_t tactus_spectrum(const double* samples, size_t count, double rate, size_t segment, double* frequencies,
                       double* density, size_t most, tactus_error* error) {
    return embed::guarded<size_t>(error, 0, [&]() -> size_t {
        const std::span<const double> record = record_of(samples, count, rate, "record");
        const std::size_t length = segment == 0 ? signal::suggested_segment(rate, count) : std::min(segment, count);
        if (most == 0) return length / 2 + 1;
        if (!frequencies || !density) throw Error("there is no room for the spectrum: NULL was given");
        const signal::Spectrum spectrum = signal::welch(record, signal::WelchSettings::hann(rate, length, length / 2));
        const std::size_t bins = std::min(most, spectrum.power.size());
        for (std::size_t k = 0; k < bins; ++k) {
            frequencies[k] = spectrum.frequency(k);
            density[k] = spectrum.power[k];
        }
        return bins;
    });
}

int tactus_compare(const double* reference, size_t reference_count, double reference_rate, const double* output,
                   size_t output_count, double output_rate, tactus_comparison* comparison, tactus_error* error) {
    return embed::guarded(error, -1, [&] {
        if (!comparison) throw Error("there is no room for the comparison: NULL was given");
        const signal::Take first(record_of(reference, reference_count, reference_rate, "reference"), reference_rate);
        const signal::Take second(record_of(output, output_count, output_rate, "output"), output_rate);
        const signal::Comparison found = signal::compare(first, second);
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        const bool aligned = found.alignment.significant;
        *comparison = {aligned ? found.alignment.delay : none,
                       aligned ? found.alignment.correlation : none,
                       found.lowest,
                       found.highest,
                       found.reference_rms,
                       found.output_rms,
                       found.gain_db,
                       found.lsd_db,
                       found.cosine_1000,
                       found.touch_cosine,
                       found.touch_gap_db,
                       found.spectrogram_similarity,
                       or_none(found.st_sim),
                       or_none(found.spqi),
                       or_none(found.signal_to_noise_db),
                       or_none(found.coherence_mean),
                       found.reference_hz,
                       found.output_hz};
        return 0;
    });
}

int tactus_hand_arm_exposure(const double* const axes[3], size_t count, double rate, double seconds_a_day,
                             tactus_exposure* exposure, tactus_error* error) {
    return embed::guarded(error, -1, [&] {
        if (!axes || !exposure) throw Error("there are no axes, or there is no room for the exposure: NULL was given");
        if (!(seconds_a_day >= 0.0 && seconds_a_day <= 24.0 * 3600.0))
            throw Error(fmt::format("a day has no {} s; give the seconds of contact from 0 to 86400", seconds_a_day));
        tactus_exposure made{};
        for (int axis = 0; axis < 3; ++axis) {
            const std::span<const double> record = record_of(axes[axis], count, rate, "record of an axis");
            const double mean = std::accumulate(record.begin(), record.end(), 0.0) / static_cast<double>(count);
            signal::WeightedRecord weighted(signal::weighting_h, rate, mean);
            weighted.push(record);
            weighted.end_piece();
            made.weighted[axis] = weighted.by_transform();
        }
        made.total = signal::vibration_total(made.weighted);
        const signal::HandArmOperation day{made.total, seconds_a_day};
        made.a8 = signal::daily_exposure({&day, 1});
        made.seconds_to_action = signal::time_to_reach(signal::hand_arm_limits.action, made.total);
        made.seconds_to_limit = signal::time_to_reach(signal::hand_arm_limits.limit, made.total);
        *exposure = made;
        return 0;
    });
}

}  // extern "C"
