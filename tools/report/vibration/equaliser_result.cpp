// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/equaliser_result.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::report {

namespace {

using analysis::DistortionOrder;
using analysis::Equalisation;
using analysis::Flatness;
using analysis::Measurement;
using vibration::Headroom;
using vibration::Mode;

constexpr const char* kinds[] = {"displacement", "velocity", "acceleration"};
using Band = std::optional<std::pair<double, double>>;

const Fields<Flatness::Band>& band_fields() {
    using B = Flatness::Band;
    static const Fields<B> all = Fields<B>("third octave of a filter")
                                     .number("hz", "third octave", fixed(0, "Hz"), &B::hz)
                                     .number("filter_db", "filter", fixed(1, "dB"), &B::filter_db)
                                     .number("loudest_peak", "loudest sine, peak", significant(3), &B::loudest);
    return all;
}

const Fields<vibration::BandLoss>& loss_fields() {
    using L = vibration::BandLoss;
    static const Fields<L> all = Fields<L>("loss of a third octave by the limits of the actuator")
                                     .number("hz", "third octave", fixed(0, "Hz"), &L::hz)
                                     .number("db", "loses", fixed(1, "dB"), &L::lost_db);
    return all;
}

const Fields<Headroom>& headroom_fields() {
    static const Fields<Headroom> all =
        Fields<Headroom>("drive of a recording beside the limit")
            .number("peak_v", "peak", fixed(3, "V"), &Headroom::peak)
            .number("headroom_db", "limit above the peak", fixed(1, "dB"), &Headroom::headroom_db)
            .judged([](const Headroom& h) { return h.headroom_db >= 0.0 ? Severity::none : Severity::fail; })
            .number("limited_fraction", "samples that are cut", significant(2, "%", "1"), &Headroom::limited_fraction)
            .text("", "advice",
                  [](const Headroom& h) {
                      return h.headroom_db >= 0.0 ? std::string()
                                                  : fmt::format("play it {:.1f} dB softer", -h.headroom_db);
                  })
            .rows("lost", "bands", loss_fields(), &Headroom::losses);
    return all;
}

const Fields<analysis::Programme>& programme_fields() {
    using P = analysis::Programme;
    static const Fields<P> all = Fields<P>("drive of a recording")
                                     .child("before", "as recorded", headroom_fields(), &P::plain)
                                     .child("after", "equalised", headroom_fields(), &P::equalised);
    return all;
}

/// A frequency and a value there.
struct At {
    double hz, value;
};

Fields<At> at_fields(const char* about, const char* key, NumberFormat format) {
    return Fields<At>(about).number("hz", "", fixed(0, "Hz"), &At::hz).number(key, "", format, &At::value);
}

const Fields<Equalisation>& filter_fields() {
    using E = Equalisation;
    static const Fields<At> sine = at_fields("loudest sine at the weakest frequency", "peak", significant(3));
    static const Fields<At> boost = at_fields("largest gain of the filter", "db", fixed(1, "dB"));
    static const Fields<E> all =
        Fields<E>("filter for a response")
            .number("rate_hz", "", significant(6, "Hz"), [](const E& e) { return e.equaliser.rate; })
            .integer("taps", "taps", [](const E& e) { return e.equaliser.taps.size(); })
            .number("delay_s", "adds", fixed(2, "ms", "s"), [](const E& e) { return e.equaliser.delay; })
            .range("band_hz", "band", significant(6, "Hz"),
                   [](const E& e) { return Band({e.equaliser.lowest, e.equaliser.highest}); })
            .number("mean_gain", "", significant(4), [](const E& e) { return e.equaliser.mean_gain; })
            .text("unit", "", [](const E& e) { return e.equaliser.unit; })
            .number("deviation_before_db", "deviation without it", fixed(1, "dB"),
                    [](const E& e) { return e.flat.before_db; })
            .number("deviation_after_db", "deviation with it", fixed(1, "dB"),
                    [](const E& e) { return e.flat.after_db; })
            .number("deviation_after_hz", "deviation is largest at", fixed(0, "Hz"),
                    [](const E& e) { return e.flat.after_hz; })
            .child("loudest_sine", "", sine, [](const E& e) { return At{e.flat.loudest_hz, e.flat.loudest}; })
            .child("greatest_boost", "", boost, [](const E& e) { return At{e.flat.boost_hz, e.flat.boost_db}; })
            .text("", "boost",
                  [](const E& e) {
                      return fmt::format("{:.1f} dB at most, at {:.0f} Hz", e.flat.boost_db, e.flat.boost_hz);
                  })
            .text("actuator", "actuator", [](const E& e) { return std::string(e.actuator->name); })
            .number("voltage_limit_v", "voltage limit", significant(4, "V"),
                    [](const E& e) { return e.actuator->voltage_limit; })
            .number("current_limit_a", "current limit", significant(4, "A"),
                    [](const E& e) { return e.actuator->current_limit; })
            .number("", "resistance", significant(4, "ohm"), [](const E& e) { return e.actuator->resistance; })
            .text("", "loudest sine",
                  [](const E& e) {
                      return fmt::format("{:.3g}{}{} peak at {:.0f} Hz, where it is weakest", e.flat.loudest,
                                         e.unit.empty() ? "" : " ", e.unit.substr(0, e.unit.find(" per ")),
                                         e.flat.loudest_hz);
                  })
            .text("", "headroom",
                  [](const E& e) {
                      return e.programme ? fmt::format("under the limit of {:g} V", e.limit)
                                         : "unknown: give --signal FILE, --scale and --volts for what will be played";
                  })
            .child("headroom", "drive", programme_fields(), [](const E& e) -> const auto& { return e.programme; })
            .omitted()
            .rows("bands", "third octaves", band_fields(), [](const E& e) -> const auto& { return e.flat.bands; })
            .on_pages()
            .notes("notes", "note", &E::notes);
    return all;
}

/// Of a measurement, that of its response.
const Fields<MadeEqualiser>& made_fields() {
    using M = MadeEqualiser;
    static const Fields<M> all =
        Fields<M>("filter made of the response")
            .text("file", "file", [](const M& m) { return m.file.string(); })
            .range("band_hz", "band", significant(6, "Hz"),
                   [](const M& m) { return Band({m.made->equaliser.lowest, m.made->equaliser.highest}); })
            .number("deviation_before_db", "deviation without it", fixed(1, "dB"),
                    [](const M& m) { return m.made->flat.before_db; })
            .number("deviation_after_db", "deviation with it", fixed(1, "dB"),
                    [](const M& m) { return m.made->flat.after_db; });
    return all;
}

const Fields<Mode>& mode_fields() {
    static const Fields<Mode> all =
        Fields<Mode>("mode of a response")
            .number("hz", "frequency", fixed(2, "Hz"), &Mode::hz)
            .number("damping_ratio", "damping ratio", significant(3),
                    [](const Mode& m) {
                        Number ratio = m.damping;
                        ratio.uncertainty = m.damping * m.deviation;
                        return ratio;
                    })
            .number("", "Q", fixed(0), [](const Mode& m) { return 0.5 / m.damping; })
            .number("relative_deviation", "deviation", fixed(1, "%", "1"), &Mode::deviation)
            .number("bias_bound", "bias at most", fixed(1, "%", "1"), &Mode::truncation)
            .number("peak", "", significant(4), &Mode::peak)
            .number("", "peak", fixed(2, "dB"), [](const Mode& m) { return 20.0 * std::log10(m.peak); })
            .flag("resolved", "damping within 5 %", &Mode::is_resolved)
            .number("needed_duration_s", "needs --duration", fixed(0, "s"),
                    [](const Mode& m) { return std::ceil(m.needed_duration); });
    return all;
}

const Fields<DistortionOrder>& distortion_fields() {
    using D = DistortionOrder;
    static const Fields<D> all =
        Fields<D>("distortion of one order")
            .integer("order", "order", &D::order)
            .number("percent", "rms", fixed(3, "%"), [](const D& d) { return 100.0 * d.rms; })
            .number("worst_percent", "worst", fixed(3, "%"), [](const D& d) { return 100.0 * d.worst; })
            .number("worst_hz", "at", fixed(0, "Hz"), &D::worst_hz);
    return all;
}

const Fields<Measurement>& card_fields() {
    using M = Measurement;
    static const Fields<M> all =
        Fields<M>("sound card")
            .text("name", "name", [](const M& m) { return m.card->device; })
            .number("output_latency_s", "reports out", fixed(3, "ms", "s"),
                    [](const M& m) { return m.card->output_latency; })
            .number("input_latency_s", "reports in", fixed(3, "ms", "s"),
                    [](const M& m) { return m.card->input_latency; })
            .integer("underflows", "lost sound, times", [](const M& m) { return m.card->underflows; })
            .integer("clipped_samples", "", [](const M& m) { return m.clipped; });
    return all;
}

/// How the resonance was fitted.
const Fields<Measurement>& fit_fields() {
    using M = Measurement;
    static const Fields<M> all =
        Fields<M>("fit of the resonance")
            .text("kind", "",
                  [](const M& m) {
                      return m.resonance.hz > 0.0 ? std::optional<std::string>(kinds[m.resonance.order]) : std::nullopt;
                  })
            .number("error_db", "", fixed(2, "dB"), [](const M& m) {
                return m.resonance.hz > 0.0 ? std::optional(m.resonance.error_db) : std::nullopt;
            });
    return all;
}

std::vector<std::string> clipping(const Measurement& m) {
    if (m.clipped == 0) return {};
    return {fmt::format("the input was at full scale {} times: give a smaller --amplitude", m.clipped)};
}

const Fields<Measurement>& response_fields_of_measurement() {
    using M = Measurement;
    const auto if_found = [](auto member) {
        return
            [member](const M& m) { return m.resonance.hz > 0.0 ? std::optional(m.resonance.*member) : std::nullopt; };
    };
    using R = vibration::Resonance;
    static const Fields<M> all =
        Fields<M>("response to a sweep")
            .warnings("", clipping)
            .number("resonance_hz", "resonance", fixed(1, "Hz"), if_found(&R::hz))
            .number("damping_ratio", "damping ratio", fixed(3), if_found(&R::damping))
            .child("fit", "", fit_fields(), [](const M& m) -> const M& { return m; })
            .text("", "fit",
                  [](const M& m) {
                      return m.resonance.hz > 0.0 ? fmt::format("{} response, within {:.2f} dB",
                                                                kinds[m.resonance.order], m.resonance.error_db)
                                                  : std::string();
                  })
            .number("latency_s", "latency", fixed(3, "ms", "s"),
                    [](const M& m) { return m.response.identified.response.latency; })
            .number("coherence_mean", "coherence, mean", fixed(4), &M::coherence)
            .range("band_hz", "from", fixed(0, "Hz"), [](const M& m) { return Band({m.lowest, m.highest}); })
            .text("unit", "", [](const M& m) { return m.response.unit; })
            .rows("modes", "modes", mode_fields(),
                  [](const M& m) -> const auto& { return m.response.identified.modes; })
            .rows("thd", "distortion", distortion_fields(), &M::orders)
            .child("device", "sound card", card_fields(), [](const M& m) { return m.card ? &m : nullptr; })
            .omitted();
    return all;
}

}  // namespace

const Fields<MadeEqualiser>& equaliser_fields() {
    using M = MadeEqualiser;
    static const Fields<M> all = Fields<M>("filter for the equaliser node")
                                     .titled([](const M& m) {
                                         return fmt::format("{}: {} phase, {} taps at {:g} Hz, adds {:.2f} ms",
                                                            m.file.string(), m.kind, m.made->equaliser.taps.size(),
                                                            m.made->equaliser.rate, 1e3 * m.made->equaliser.delay);
                                     })
                                     .text("equaliser", "", [](const M& m) { return m.file.string(); })
                                     .text("kind", "phase", &M::kind)
                                     .part(filter_fields(), [](const M& m) -> const Equalisation& { return *m.made; });
    return all;
}

const Fields<MeasuredResponse>& measurement_fields() {
    using M = MeasuredResponse;
    static const Fields<M> all =
        Fields<M>("response of a patch or a sound card to a sweep")
            .titled([](const M& m) { return m.found->response.title; })
            .text("", "resonance",
                  [](const M& m) {
                      return m.found->resonance.hz > 0.0
                                 ? std::string()
                                 : fmt::format("none from {:.0f} to {:.0f} Hz", m.fit_lowest, m.found->fit_highest);
                  })
            .part(response_fields_of_measurement(), [](const M& m) -> const Measurement& { return *m.found; })
            .text("response_csv", "response", [](const M& m) { return m.csv.string(); })
            .child("equaliser", "equaliser", made_fields(), &M::equaliser)
            .omitted();
    return all;
}

}  // namespace tactus::report
