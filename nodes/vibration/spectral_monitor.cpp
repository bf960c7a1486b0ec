// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/live_comparison.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <string>

namespace tactus::nodes {

struct SpectralMonitor {
    static constexpr auto about =
        "Compares the spectra of an output and a reference while a patch runs; delays do not matter. Put it in a slow "
        "group of its own.";

    Batch<Signal> reference{"the reference, wired 'as batch' from the audio group"};
    Batch<Signal> output{"the output, wired 'as batch' from the audio group"};
    Out<bool> alike{"distance, likeness and worst band are within their limits"};
    Out<double> distance{"log-spectral distance, 40 to 500 Hz, dB"};
    Out<double> likeness{"cosine similarity of the amplitude spectra, 40 to 500 Hz; 1: same shape"};
    Out<double> worst_band{"largest error of a third-octave band, 40 to 1000 Hz, dB"};
    Out<double> gain{"that gives the output the power of the reference, dB"};
    Param most_distance{"2", "0", "100", "limit of 'distance' for 'alike', dB"};
    Param least_likeness{"0.98", "0", "1", "limit of 'likeness' for 'alike'"};
    Param most_band_error{"4.5", "0", "100", "limit of 'worst_band' for 'alike', dB"};
    Param memory{structural, "2 s", "10 ms", "1000 s", "time constant of the averaging"};

    void prepare(const Setup& setup) {
        const double reference_rate = rate_of(reference.period), output_rate = rate_of(output.period);
        if (!(std::min(reference_rate, output_rate) >= min_rate))
            setup.fail("the signals' rate is below 223 Hz, too low to compare vibrations; use a faster group");
        comparison_ = signal::LiveComparison(reference_rate, output_rate, memory);
        name_ = setup.name;
        scores_ = comparison_.scores();
        publish();
    }

    void process(const Tick& tick) noexcept {
        const int whole = comparison_.push_reference(reference.values()) + comparison_.push_output(output.values());
        if (whole > 0) scores_ = comparison_.scores();
        publish();
        if (scores_.heard) heard_s_ += tick.elapsed_seconds();
        if (alike.get()) alike_s_ += tick.elapsed_seconds();
    }

    void report(Report& report) const {
        report.set(name_, "heard_s", heard_s_);
        report.set(name_, "alike_s", alike_s_);
        report.set(name_, "lsd_db", scores_.lsd_db);
        report.set(name_, "cosine_40_500", scores_.cosine_500);
        report.set(name_, "third_octave_max_db", scores_.third_octave_max_db);
        report.set(name_, "gain_db", scores_.gain_db);
    }

private:
    static constexpr double min_rate = 223.0;  // Hz

    void publish() noexcept {
        distance = scores_.lsd_db;
        likeness = scores_.cosine_500;
        worst_band = scores_.third_octave_max_db;
        gain = scores_.gain_db;
        alike = scores_.heard && scores_.lsd_db <= most_distance && scores_.cosine_500 >= least_likeness &&
                scores_.third_octave_max_db <= most_band_error;
    }

    signal::LiveComparison comparison_;
    signal::LiveScores scores_;
    std::string name_;
    double heard_s_ = 0.0, alike_s_ = 0.0;
};

TACTUS_NODE(SpectralMonitor, reference, output, alike, distance, likeness, worst_band, gain, most_distance,
            least_likeness, most_band_error, memory)

}  // namespace tactus::nodes
