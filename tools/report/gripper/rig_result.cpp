// SPDX-License-Identifier: Apache-2.0
#include "tools/report/gripper/rig_result.hpp"

#include "tools/report/figures/rig_figures.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace tactus::report {

namespace {

using analysis::RigAssumption;
using analysis::RigCell;
using analysis::RigCrossover;
using analysis::RigFinding;
using analysis::RigLead;
using analysis::RigReport;
using analysis::RigRow;
using control::Fidelity;

bool is_wall(const RigCell& cell) { return cell.object.kind == control::ObjectKind::wall; }

const Fields<RigCell>& cell_fields() {
    using C = RigCell;
    const auto if_soft = [](double value, const C& c) { return is_wall(c) ? std::nullopt : std::optional(value); };
    static const Fields<C> all =
        Fields<C>("condition on the rig")
            .text("motor", "motor", &C::motor)
            .text("object", "object", [](const C& c) { return c.object.name; })
            .number("stiffness_N_per_mm", "", significant(4, "N/mm"),
                    [=](const C& c) { return if_soft(c.object.stiffness * 1e-3, c); })
            .number("damping_Ns_per_mm", "", significant(4, "N s/mm"),
                    [=](const C& c) { return if_soft(c.object.damping * 1e-3, c); })
            .number("rate_hz", "rate", significant(6, "Hz"), &C::rate)
            .number("amplitude_mm", "amplitude", significant(6, "mm"), [](const C& c) { return c.amplitude * 1e3; });
    return all;
}

/// Of a row that was judged.
template <class Read>
auto judged(Read read) {
    return [read](const RigRow& row) {
        return row.failure.empty() ? std::optional<double>(std::invoke(read, row.fidelity)) : std::nullopt;
    };
}

/// Of a row that was judged with a yielding object.
template <class Read>
auto unless_wall(Read read) {
    return [read](const RigRow& row) { return is_wall(row.cell) ? std::nullopt : judged(read)(row); };
}

const Fields<RigRow>& row_fields() {
    using F = Fidelity;
    const auto stiffness = [](const F& f) { return f.rendered_stiffness * 1e-3; };
    const auto damping = [](const F& f) { return f.rendered_damping * 1e-3; };
    const auto fidelity = [](auto member) { return [member](const RigRow& row) { return row.fidelity.*member; }; };
    static const Fields<RigRow> all =
        Fields<RigRow>("fidelity of one condition")
            .part(cell_fields(), [](const RigRow& r) -> const RigCell& { return r.cell; })
            .number("gain_error_db", "gain", fixed(2, "dB"), fidelity(&F::gain_error_db))
            .number("phase_error_deg", "phase", fixed(1, "°"), fidelity(&F::phase_error_deg))
            .number("nrmse", "NRMSE", fixed(1, "%", "1"), fidelity(&F::nrmse))
            .number("rendered_stiffness_N_per_mm", "", significant(4, "N/mm"), judged(stiffness))
            .number("rendered_damping_Ns_per_mm", "", significant(3, "N s/mm"), judged(damping))
            .number("", "k", significant(4, "N/mm"), unless_wall(stiffness))
            .number("", "b", significant(3, "N s/mm"), unless_wall(damping))
            .flag("slip", "", [](const RigRow& r) { return r.fidelity.slip_share > 0.0; })
            .flag("saturated", "", [](const RigRow& r) { return r.fidelity.saturated_share > 0.0; })
            .number("slip_share", "slips", fixed(0, "%", "1"), judged(&F::slip_share))
            .number("saturated_share", "saturated", fixed(0, "%", "1"), judged(&F::saturated_share))
            .number("penetration_mm", "gave", significant(3, "mm"),
                    [](const RigRow& r) {
                        return is_wall(r.cell) && r.failure.empty() ? std::optional(r.fidelity.penetration * 1e3)
                                                                    : std::nullopt;
                    })
            .number("position_error_rms_mm", "", significant(3, "mm"),
                    judged([](const F& f) { return f.position_rms_error * 1e3; }))
            .number("limit_cycle_rms_mm", "hunting", significant(3, "mm"),
                    judged([](const F& f) { return f.limit_cycle_rms * 1e3; }))
            .number("force_N", "", significant(4, "N"), judged([](const F& f) { return std::abs(f.force); }))
            .number("position_mm", "", significant(4, "mm"),
                    judged([](const F& f) { return std::abs(f.position) * 1e3; }))
            .number("peak_speed_mm_s", "", significant(4, "mm/s"),
                    judged([](const F& f) { return f.speed_peak * 1e3; }))
            .text("failure", "not judged",
                  [](const RigRow& r) { return r.failure.empty() ? std::nullopt : std::optional(r.failure); })
            .omitted()
            .judged([](const RigRow& r) { return r.failure.empty() ? Severity::none : Severity::fail; });
    return all;
}

const Fields<RigCrossover>& crossover_fields() {
    using C = RigCrossover;
    static const Fields<C> all =
        Fields<C>("rate above which the second motor is the better one")
            .number("stiffness_N_per_mm", "object", significant(6, "N/mm"),
                    [](const C& c) { return c.stiffness * 1e-3; })
            .number("amplitude_mm", "amplitude", significant(3, "mm"), [](const C& c) { return c.amplitude * 1e3; })
            .number("rate_hz_low", "from", fixed(2, "Hz"), &C::low)
            .number("rate_hz_high", "to", fixed(2, "Hz"), &C::high)
            .integer("crossed", "crossed", &C::crossed)
            .integer("of", "of assumptions", &C::of);
    return all;
}

const Fields<RigFinding>& finding_fields() {
    using F = RigFinding;
    static const Fields<F> all = Fields<F>("statement of the thesis")
                                     .text("claim", "claim", &F::claim)
                                     .integer("holds", "holds in", &F::holds)
                                     .integer("of", "of assumptions", &F::of);
    return all;
}

const Fields<RigLead>& lead_fields() {
    using L = RigLead;
    static const Fields<L> all =
        Fields<L>("loop of the thesis beside one with feed-forward")
            .part(cell_fields(), [](const L& l) -> const RigCell& { return l.cell; })
            .number("nrmse", "NRMSE", fixed(1, "%", "1"), &L::nrmse)
            .number("nrmse_feed_forward", "with feed-forward", fixed(1, "%", "1"), &L::led_nrmse)
            .number("ratio", "ratio", fixed(1), &L::ratio);
    return all;
}

std::string lead_text(const RigReport& report) {
    if (report.leads.empty()) return {};
    const auto [least, most] = std::ranges::minmax_element(report.leads, {}, &RigLead::ratio);
    return fmt::format("error of the thesis loop is {:.1f} to {:.1f} times as large", least->ratio(), most->ratio());
}

const Fields<RigAssumption>& assumption_fields() {
    using A = RigAssumption;
    static const Fields<A> all = Fields<A>("range of an assumption")
                                     .text("motor", "motor", &A::motor)
                                     .text("option", "option", &A::option)
                                     .text("low", "from", &A::low)
                                     .text("high", "to", &A::high);
    return all;
}

struct Fact {
    const char *what, *value, *source;
};

constexpr Fact facts[] = {
    {"rate of the control loop", "150 Hz", "thesis 6.3.3"},
    {"object", "spring and damper in parallel, F = k x + b ẋ", "thesis 6.3.3"},
    {"rig", "cord swung by 50 mm from end to end, two springs of 0.19 N/mm: 0.38 N/mm at the finger", "thesis 6.3.4.1"},
    {"walking motor: fastest finger", "70 mm/s, with a leverage of 4.5", "thesis 6.3.1"},
    {"walking motor: drive", "at most 3 kHz; so 5.19 µm of the rod per cycle", "thesis 2.5.2.2; the step follows"},
    {"walking motor: encoder", "16 000 pulses per mm of the rod: 0.28 µm at the finger", "thesis 6.3.1"},
    {"traveling-wave motor: encoder", "4000 pulses per turn, direct drive", "thesis 6.3.2"},
    {"traveling-wave motor: speed", "decreases off resonance and off 90°; the sign of the phase is the direction",
     "thesis 2.5.2.1"},
    {"walking motor: holding force", "4.4 N at the finger: 20 N of the motor through the leverage", "assumed"},
    {"walking motor: lag", "2 ms", "assumed"},
    {"traveling-wave motor: fastest, slowest, dead zone", "600, 30 and 15 mm/s of the finger", "assumed"},
    {"traveling-wave motor: lag, holding force", "4 ms, 3 N", "assumed"},
    {"traveling-wave motor: lever", "70 mm from axis to finger: 0.11 mm per pulse", "assumed, as the other gripper's"},
    {"slip", "beyond the holding force the finger yields with 20 N s/m", "assumed"},
    {"strain gauge", "5 mN per count, 10 mN of noise", "assumed"},
    {"delay", "one tick from sample to motion", "assumed"},
    {"gain of the loop", "half of the stability limit, from the eigenvalues of loop, motor and rig",
     "thesis: as high as is stable"},
};

const Fields<Fact>& fact_fields() {
    static const Fields<Fact> all = Fields<Fact>("fact about the grippers, unless the patch says otherwise")
                                        .text("", "fact", &Fact::what)
                                        .text("", "value", &Fact::value)
                                        .text("", "source", &Fact::source);
    return all;
}

/// The facts of a simulated study, as JSON groups them.
const Fields<RigReport>& facts_fields() {
    using R = RigReport;
    static const Fields<R> all =
        Fields<R>("facts and findings of a study")
            .number("peak_cord_speed_mm_s", "peak speed of the cord at 1 Hz", fixed(2, "mm/s"),
                    [](const R& r) { return r.peak_cord_speed * 1e3; })
            .number("saturation_hz", "free motion saturates from", fixed(3, "Hz"), &R::saturation_rate)
            .number("saturation_closed_form_hz", "the same in closed form", fixed(3, "Hz"), &R::saturation_closed_form)
            .text("", "feed-forward", lead_text)
            .rows("crossover", "where the second motor is the better one", crossover_fields(), &R::crossover)
            .rows("findings", "findings", finding_fields(), &R::findings)
            .rows("feed_forward", "feed-forward", lead_fields(), &R::leads)
            .on_pages()
            .rows("assumed", "ranges of the assumptions", assumption_fields(), &R::assumptions)
            .on_pages();
    return all;
}

}  // namespace

const Fields<RigReport>& rig_fields() {
    using R = RigReport;
    const auto has_rows = [](const R& r) { return !r.rows.empty(); };
    static const Fields<R> all =
        Fields<R>("fidelity of grippers on the test rig")
            .titled([](const R& r) { return r.title; })
            .text("", "study", &R::source)
            .figure(
                "Error of the position against the ideal object under the measured force, relative to its motion, over "
                "the samples without slip. For a wall: the penetration",
                has_rows, draw_rig_errors)
            .figure("Measured admittance over the object's, 1/(k + jωb), at the rate of the rig", has_rows,
                    draw_rig_response)
            .figure(
                "Position over force, last cycle; dashed: the object", [](const R& r) { return !r.examples.empty(); },
                draw_rig_examples)
            .figure(
                "Which motor is better; bands: all combinations of the limits of the assumptions about a motor",
                [](const R& r) { return !r.crossover.empty(); }, draw_rig_crossover)
            .figure(
                "Error of the loop of the thesis, which had no feed-forward, over the error with the object's velocity "
                "fed forward; above 1 feed-forward is better",
                [](const R& r) { return !r.leads.empty(); }, draw_rig_leads)
            .rows("rows", "cells", row_fields(), &R::rows)
            .child("facts", "facts and findings", facts_fields(), [](const R& r) -> const R& { return r; })
            .rows("", "facts of the thesis (Olsson 2015) and assumptions", fact_fields(),
                  [](const R& r) {
                      return r.assumptions.empty() ? std::vector<Fact>()
                                                   : std::vector<Fact>(std::begin(facts), std::end(facts));
                  })
            .on_pages()
            .notes("notes", "note", &R::notes);
    return all;
}

std::string rig_table(const RigReport& report) {
    std::vector<file::Json> rows;
    std::vector<std::string> columns;
    for (const RigRow& row : report.rows) {
        rows.push_back(json_of(row_fields().of(row)));
        if (columns.empty())
            for (const auto& [key, value] : rows.back().items())
                if (key != "failure") columns.push_back(key);
    }
    return rows.empty() ? std::string() : csv_table(columns, rows);
}

}  // namespace tactus::report
