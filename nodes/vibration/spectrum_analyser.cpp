// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/lines.hpp"
#include "dsp/signal/spectrum/live_fundamental.hpp"
#include "dsp/signal/spectrum/live_spectrum.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus::nodes {

struct SpectrumAnalyser {
    static constexpr auto about =
        "Analyses a signal while a patch runs: level, strongest spectral line and fundamental frequency, by the "
        "harmonic sums that 'tactus spectrum' uses for records, here of the running average: a rate that changes "
        "within "
        "'memory' is missed. Put it in a slow group of its own.";

    Batch<Signal> in{"the signal, wired 'as batch' from the audio group"};
    Out<double> level{"root mean square in the band, in the unit of the signal"};
    Out<double> strongest{"frequency of the strongest line in the band; 0: no line above the noise", "Hz"};
    Out<double> fundamental{"fundamental frequency of the harmonic lines; 0: none", "Hz"};
    Out<double> confidence{"of the fundamental, 0 to 1; uncertain below 0.25"};
    Param lowest{structural, "20 Hz", "1 Hz", "10 kHz", "lower limit of the band and of the fundamental"};
    Param highest{structural, "1 kHz", "2 Hz", "24 kHz", "upper limit of the band"};
    Param highest_rate{structural, "500 Hz", "1 Hz", "10 kHz", "upper limit of the fundamental"};
    Param segment{structural, "512 ms", "1 ms", "10 s", "segment length: resolves lines that are 4 / segment apart"};
    Param memory{structural, "2 s", "10 ms", "1000 s", "time constant of the averaging"};

    void prepare(const Setup& setup) {
        const double rate = rate_of(in.period);
        const auto samples = static_cast<std::size_t>(std::llround(rate * segment));
        if (samples < 16) setup.fail("a segment must hold at least 16 samples; make it longer");
        spectrum_ = signal::LiveSpectrum(rate, samples, memory);
        summer_.emplace(spectrum_.spectrum().power.size());
        found_ = {};
        name_ = setup.name;
        publish({});
    }

    void process(const Tick&) noexcept {
        if (spectrum_.push(in.values()) > 0) publish(spectrum_.spectrum());
    }

    void report(Report& report) const {
        const signal::Spectrum& now = spectrum_.spectrum();
        report.set(name_, "segments", static_cast<double>(now.segments));
        std::vector<double> hz, db;
        for (const signal::Band& band : signal::third_octaves(now)) {
            hz.push_back(band.centre);
            db.push_back(10.0 * std::log10(std::max(band.power, 1e-30)));
        }
        report.set(name_, "third_octave_hz", hz);
        report.set(name_, "third_octave_db", db);
        std::vector<double> orders;
        if (found_.frequency > 0.0)
            for (const signal::Harmonic& h : signal::harmonic_table(now, found_.frequency, 10))
                orders.push_back(h.present ? std::sqrt(2.0 * h.power) : 0.0);
        report.set(name_, "order_amplitudes", orders);
        report.set(name_, "fundamental_hz", found_.frequency);
        report.set(name_, "confidence", found_.confidence);
    }

private:
    void publish(const signal::Spectrum& now) noexcept {
        level = std::sqrt(signal::band_power(now, lowest, highest));
        signal::SpectralLine top;
        if (now.segments > 0)
            signal::each_line(now, lowest, highest, 0.0, [&](const signal::SpectralLine& line) {
                if (line.power > top.power) top = line;
            });
        strongest = top.frequency;
        found_ = now.segments > 0 ? signal::live_fundamental(*summer_, now, lowest, highest_rate)
                                  : signal::LiveFundamental{};
        fundamental = found_.frequency;
        confidence = found_.confidence;
    }

    signal::LiveSpectrum spectrum_;
    std::optional<signal::HarmonicSummer> summer_;
    signal::LiveFundamental found_;
    std::string name_;
};

TACTUS_NODE(SpectrumAnalyser, in, level, strongest, fundamental, confidence, lowest, highest, highest_rate, segment,
            memory)

}  // namespace tactus::nodes
