// SPDX-License-Identifier: Apache-2.0
#include "tools/report/patch/check_result.hpp"

#include "engine/run/demotions.hpp"
#include "tools/counted.hpp"
#include "tools/report/figures/z_width_figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace tactus::report {

namespace {

using namespace analysis;

const NumberFormat n_per_mm = significant(3, "N/mm");

const Fields<Error>& error_fields() {
    static const Fields<Error> all = Fields<Error>("error in a file")
                                         .text("file", "", [](const Error& e) { return e.where().file; })
                                         .integer("line", "", [](const Error& e) { return e.where().line; })
                                         .integer("column", "", [](const Error& e) { return e.where().column; })
                                         .text("message", "", [](const Error& e) { return e.message(); });
    return all;
}

const Fields<CheckedGroup>& group_fields() {
    using G = CheckedGroup;
    static const Fields<G> all = Fields<G>("group of nodes with one rate")
                                     .text("name", "group", &G::name)
                                     .number("rate_hz", "", significant(6, "Hz"), &G::rate)
                                     .number("latency_ms", "latency", significant(4, "ms"), &G::latency_ms)
                                     .texts("nodes", "", &G::nodes)
                                     .text("", "nodes", [](const G& g) { return counted(g.nodes.size(), "node"); });
    return all;
}

const Fields<DeviceProcess>& process_fields() {
    using P = DeviceProcess;
    static const Fields<P> all = Fields<P>("device with a process of its own")
                                     .text("device", "device", &P::device)
                                     .number("rate_hz", "rate", significant(4, "Hz"), &P::rate_hz)
                                     .number("added_latency_ms", "force later by up to", significant(4, "ms"),
                                             [](const P& p) { return p.added_s * 1e3; });
    return all;
}

std::string ends_of(const std::string& from, const std::string& to) { return from + " -> " + to; }

/// Of loops through a hand.
template <class Read>
auto of_loop(Read read) {
    return [read](const CheckedPath& p) {
        using Value = decltype(std::invoke(read, *p.loop));
        return p.loop ? std::optional<std::remove_cvref_t<Value>>(std::invoke(read, *p.loop)) : std::nullopt;
    };
}

std::string judged_text(const CheckedPath& p) {
    if (!p.loop || !p.loop->declared) return {};
    const double declared = p.loop->declared->newton_per_metre;
    if (p.loop->max_stiffness > 0.0 && declared > p.loop->max_stiffness)
        return fmt::format("TOO STIFF: the device states {:.3g} N/mm", p.loop->max_stiffness * 1e-3);
    switch (p.loop->verdict()) {
        case analyse::Verdict::stable: return "ok";
        case analyse::Verdict::unknown: return "UNKNOWN: the device states no damping, and a hand alone damps less";
        default: return "TOO STIFF";
    }
}

const Fields<analyse::ForceLoop>& loop_stiffness_fields() {
    using L = analyse::ForceLoop;
    static const Fields<L> all =
        Fields<L>("stiffness of a loop through a hand")
            .number("damping_N_s_per_m", "", significant(4, "N s/m"), &L::damping)
            .number("stiffness_limit_N_per_mm", "", n_per_mm, [](const L& l) { return l.limit * 1e-3; })
            .number(
                "max_stiffness_N_per_mm", "", n_per_mm,
                [](const L& l) { return l.max_stiffness > 0.0 ? std::optional(l.max_stiffness * 1e-3) : std::nullopt; })
            .number("declared_N_per_mm", "", n_per_mm,
                    [](const L& l) {
                        return l.declared ? std::optional(l.declared->newton_per_metre * 1e-3) : std::nullopt;
                    })
            .text("declared_by", "",
                  [](const L& l) { return l.declared ? std::optional(l.declared->param) : std::nullopt; })
            .flag("ok", "", [](const L& l) {
                return l.verdict() == analyse::Verdict::unknown
                           ? std::nullopt
                           : std::optional(l.verdict() == analyse::Verdict::stable);
            });
    return all;
}

Fields<CheckedPath> latency_fields(const char* about) {
    using P = CheckedPath;
    return Fields<P>(about)
        .text("", "path, on the patch's device", [](const P& p) { return ends_of(p.path.from, p.path.to); })
        .text("from", "", [](const P& p) { return p.path.from; })
        .text("to", "", [](const P& p) { return p.path.to; })
        .number("latency_ms", "latency", significant(4, "ms"), &P::latency_ms)
        .texts("via", "", [](const P& p) { return p.path.via; });
}

const Fields<CheckedPath>& path_fields() {
    using P = CheckedPath;
    using L = analyse::ForceLoop;
    static const Fields<P> loop =
        latency_fields("loop through a hand")
            .part(loop_stiffness_fields(), [](const P& p) -> const L& { return *p.loop; })
            .number("", "may feel", n_per_mm, of_loop([](const L& l) { return l.limit * 1e-3; }))
            .number("", "declared", n_per_mm,
                    [](const P& p) {
                        return p.loop->declared ? std::optional(p.loop->declared->newton_per_metre * 1e-3)
                                                : std::nullopt;
                    })
            .text("", "by", [](const P& p) { return p.loop->declared ? p.loop->declared->param : std::string(); })
            .text("", "verdict", judged_text)
            .judged(
                [](const P& p) { return judged_text(p).starts_with("TOO STIFF") ? Severity::fail : Severity::none; });
    static const Fields<P> all =
        latency_fields("path from a hand to an output").otherwise([](const P& p) { return p.loop.has_value(); }, loop);
    return all;
}

std::string law_text(const NodeContactLaw& law) {
    return law.by_point ? fmt::format("per point: {:.4g} N/mm for each", law.stiffness * 1e-3)
                        : fmt::format("per area: {:.4g} N/mm for each mm^2", law.stiffness * 1e-9);
}

std::string felt_text(const NodeContactLaw& law) {
    return !law.is_felt ? "nothing: no device gets its force"
           : law.felt   ? fmt::format("{:.4g} N/mm, its spring", *law.felt * 1e-3)
                        : "all of it, unless a later node reduces it";
}

const Fields<NodeContactLaw>& contact_fields() {
    using L = NodeContactLaw;
    const auto stiffness_if = [](bool by_point, double scale) {
        return [=](const L& l) { return l.by_point == by_point ? std::optional(l.stiffness * scale) : std::nullopt; };
    };
    static const Fields<L> all =
        Fields<L>("contact law of a node")
            .text("node", "contact", &L::node)
            .text("law", "", [](const L& l) { return l.by_point ? "point" : "area"; })
            .text("", "law", law_text)
            .number("stiffness_N_per_mm_per_point", "", significant(4, "N/mm"), stiffness_if(true, 1e-3))
            .omitted()
            .number("stiffness_N_per_mm_per_mm2", "", significant(4, "N/mm^3"), stiffness_if(false, 1e-9))
            .omitted()
            .flag("is_felt", "", &L::is_felt)
            .number("felt_at_most_N_per_mm", "", n_per_mm,
                    [](const L& l) { return l.felt ? std::optional(*l.felt * 1e-3) : std::nullopt; })
            .text("", "a hand feels at most", felt_text);
    return all;
}

const Fields<ClassVerdict>& class_fields() {
    using V = ClassVerdict;
    static const Fields<V> all =
        Fields<V>("the patch on a device of another class")
            .text("from", "", &V::from)
            .text("to", "", &V::to)
            .text("class", "device", [](const V& v) { return std::string(v.device.name); })
            .text("", "path", [](const V& v) { return ends_of(v.from, v.to); })
            .number("assumed_damping_N_s_per_m", "damping", significant(3, "N s/m"),
                    [](const V& v) { return v.device.damping; })
            .number("assumed_delay_ms", "", significant(3, "ms"), [](const V& v) { return v.device.delay * 1e3; })
            .number("may_feel_N_per_mm", "may feel", n_per_mm, [](const V& v) { return v.may_feel * 1e-3; })
            .flag("ok", "", &V::ok)
            .text("", "verdict", [](const V& v) { return v.ok ? "" : "would be too stiff"; });
    return all;
}

const Fields<CheckedLoop>& loop_fields() {
    using L = CheckedLoop;
    static const Fields<L> all =
        Fields<L>("position loop of an admittance controller")
            .text("node", "admittance loop", &L::node)
            .number("gain_per_s", "gain", significant(4, "1/s"), &L::gain)
            .number("gain_limit_per_s", "unstable from", significant(4, "1/s"), &L::gain_limit)
            .number("hand_stiffness_N_per_mm", "in a hand of", n_per_mm,
                    [](const L& l) { return l.hand_stiffness * 1e-3; })
            .flag("ok", "", &L::is_stable)
            .text("", "verdict", [](const L& l) { return l.is_stable() ? "ok" : "UNSTABLE"; })
            .judged([](const L& l) { return l.is_stable() ? Severity::none : Severity::fail; });
    return all;
}

/// Of groups whose cost was measured.
template <class Read>
auto if_measured(Read read) {
    return [read](const CheckedSchedule& s) {
        return s.is_measured ? std::optional<double>(std::invoke(read, s.group)) : std::nullopt;
    };
}

const Fields<CheckedSchedule>& schedule_fields() {
    using S = CheckedSchedule;
    using G = analyse::ScheduledGroup;
    const auto response = [](const S& s) {
        return s.is_measured && s.group.response_s ? std::optional(*s.group.response_s * 1e6) : std::nullopt;
    };
    static const Fields<S> all =
        Fields<S>("group in the order of its priority")
            .text("group", "group", [](const S& s) { return s.group.group; })
            .text("class", "class", [](const S& s) { return std::string(analyse::describe(s.group.criticality)); })
            .number("calls_per_s", "calls", significant(4, "Hz"), [](const S& s) { return 1.0 / s.group.period_s; })
            .integer("priority", "priority", &S::priority)
            .number("may_use_percent", "may use", fixed(0, "%"), [](const S& s) { return s.may_use * 100.0; })
            .number("cost_us", "cost", significant(3, "µs"), if_measured([](const G& g) { return g.cost_s * 1e6; }))
            .number("load_percent", "", fixed(1, "%"), if_measured([](const G& g) { return g.load() * 100.0; }))
            .number("response_us", "ends in", significant(3, "µs"), response)
            .flag("fits", "", [](const S& s) { return s.is_measured ? std::optional(s.group.fits()) : std::nullopt; })
            .text("", "verdict",
                  [](const S& s) { return s.is_measured && !s.group.fits() ? "TOO LATE" : std::string(); });
    return all;
}

const Fields<CheckedOutput>& output_fields() {
    using O = CheckedOutput;
    static const Fields<O> all =
        Fields<O>("output to a hand")
            .text("node", "output", &O::node)
            .flag("energy_cap", "", [](const O& o) { return o.energy_bound.has_value(); })
            .number("energy_bound_mJ", "a contact returns at most", significant(3, "mJ"),
                    [](const O& o) { return o.energy_bound ? std::optional(*o.energy_bound * 1e3) : std::nullopt; });
    return all;
}

std::vector<std::string> sound_lines(const std::optional<CheckedSound>& sound) {
    std::vector<std::string> all;
    if (!sound) return all;
    if (sound->hears)
        all.push_back(
            fmt::format("sound input is delayed by {:.4g} ms (--audio-margin) and one callback, and by "
                        "the latency of the card",
                        sound->buffer_ms));
    if (sound->plays)
        all.push_back(fmt::format("a run adds the card's buffer, {:.4g} ms (--audio-margin) and one callback, and {}",
                                  sound->buffer_ms,
                                  sound->card ? fmt::format("the card's own latency, {:.3g} ms as '{}' states it",
                                                            1e3 * sound->card->latency, sound->card->name)
                                              : "a card's own latency; there is no card here"));
    return all;
}

const Fields<CheckedSound>& sound_fields() {
    using S = CheckedSound;
    static const Fields<S> all =
        Fields<S>("latency of sound")
            .number("buffer_ms", "", significant(4, "ms"), &S::buffer_ms)
            .text("card", "", [](const S& s) { return s.card ? std::optional(s.card->name) : std::nullopt; })
            .number("card_ms", "", significant(3, "ms"),
                    [](const S& s) { return s.card ? std::optional(1e3 * s.card->latency) : std::nullopt; })
            .flag("plays", "", &S::plays)
            .flag("hears", "", &S::hears);
    return all;
}

/// A point of a curve.
struct Wall {
    const ZWidthCurve* curve;
    const ZWidthPoint* point;
};

std::vector<Wall> walls_of(const PatchCheck& c) {
    std::vector<Wall> all;
    if (c.z_width)
        for (const ZWidthCurve& curve : *c.z_width)
            for (const ZWidthPoint& point : curve.points) all.push_back({&curve, &point});
    return all;
}

const Fields<Wall>& wall_fields() {
    static const Fields<Wall> all =
        Fields<Wall>("walls that a device renders stably")
            .text("device", "device", [](const Wall& w) { return w.curve->device; })
            .number("rate_hz", "rate", significant(4, "Hz"), [](const Wall& w) { return w.curve->rate; })
            .number("delay_ms", "delay", significant(3, "ms"), [](const Wall& w) { return w.curve->delay * 1e3; })
            .number("damping_N_s_per_m", "damping", significant(3, "N s/m"),
                    [](const Wall& w) { return w.point->damping; })
            .number("bound_N_per_mm", "bound", n_per_mm, [](const Wall& w) { return w.point->bound * 1e-3; })
            .number("passive_N_per_mm", "passive", n_per_mm, [](const Wall& w) { return w.point->passive * 1e-3; })
            .number("friction_N_per_mm", "friction", n_per_mm, [](const Wall& w) { return w.point->friction * 1e-3; })
            .number("simulated_N_per_mm", "simulated", n_per_mm,
                    [](const Wall& w) { return w.point->simulated.stiffness * 1e-3; })
            .number("simulated_press_N", "at press", significant(2, "N"),
                    [](const Wall& w) { return w.point->simulated.press; })
            .number("simulated_approach_m_per_s", "", significant(2, "m/s"),
                    [](const Wall& w) { return w.point->simulated.approach; });
    return all;
}

std::vector<std::string> legend(const PatchCheck& c) {
    std::vector<std::string> all;
    if (!c.schedule.empty())
        all.push_back(
            fmt::format("may use: of one core, beside the groups above (rate-monotonic bound, at most {:.0f} "
                        "% in all)",
                        run::Demotions::largest_load * 100.0));
    if (!c.paths.empty())
        all.emplace_back(
            "may feel: damping of the device with a hand on it / (period / 2 + latency, that of the device "
            "included)");
    if (!c.outputs.empty()) all.emplace_back("energy: beyond 1.05 of what a contact took, and what a hand damps");
    if (!c.classes.empty())
        all.emplace_back(
            "other devices: makers state no damping, so it is assumed, and a hand adds 2 N s/m; stiffness "
            "as makers state it");
    if (c.z_width)
        all.emplace_back(
            "walls: bound: (b - |B|) / (T / 2 + delay), Colgate and Schenkel; passive: the same by motion; friction: "
            "up "
            "to which Coulomb friction dissipates the energy of encoder quantisation; simulated: the device begins to "
            "oscillate, at "
            "the "
            "worst press from 0.5 N to 0.8 of its force and approach up to 0.3 m/s. b includes a hand of 2 N s/m where "
            "the device states no damping");
    return all;
}

std::string verdict_text(const PatchCheck& c) {
    if (!c.errors.empty()) return {};
    if (!c.is_stable()) return "no errors, but a path is too stiff or a loop unstable";
    return c.is_unknown() ? "no errors, but whether a path is too stiff is unknown: its device states no damping"
                          : "no errors";
}

std::vector<std::string> error_lines(const PatchCheck& c) {
    std::vector<std::string> lines;
    for (const Error& error : c.errors) lines.emplace_back(error.what());
    return lines;
}

Fields<PatchCheck> plan_fields(const char* about) {
    using C = PatchCheck;
    return Fields<C>(about)
        .flag("ok", "", [](const C& c) { return c.errors.empty(); })
        .page_titled([](const C& c) { return "Check of " + c.patch; })
        .notes("", "errors", error_lines)
        .judged([](const C&) { return Severity::fail; })
        .on_pages()
        .rows("errors", "", error_fields(), &C::errors)
        .rows("groups", "groups", group_fields(), &C::groups)
        .rows("processes", "processes of devices", process_fields(), &C::processes);
}

Fields<PatchCheck>& with_verdict(Fields<PatchCheck>& fields) {
    return fields.notes("", "columns", legend).text("", "verdict", verdict_text).judged([](const PatchCheck& c) {
        return c.is_stable() ? Severity::pass : Severity::fail;
    });
}

}  // namespace

const Fields<PatchCheck>& check_fields() {
    using C = PatchCheck;
    static const Fields<C> prepared = [] {
        Fields<C> fields = plan_fields("check of a patch");
        fields.warnings("warnings", &C::warnings)
            .rows("schedule", "order of groups", schedule_fields(), &C::schedule)
            .rows("paths", "paths", path_fields(), &C::paths)
            .notes("", "sound", [](const C& c) { return sound_lines(c.sound); })
            .rows("outputs", "energy", output_fields(), &C::outputs)
            .rows("contact", "contact", contact_fields(), &C::contact)
            .rows("device_classes", "For information, not part of the verdict: the same patch on other devices",
                  class_fields(), &C::classes)
            .rows("admittance_loops", "admittance", loop_fields(), &C::loops)
            .child("sound", "", sound_fields(), &C::sound)
            .omitted()
            .rows("z_width", "walls", wall_fields(), walls_of)
            .omitted()
            .figure(
                "walls that a device renders stably", [](const C& c) { return c.z_width.has_value(); },
                [](const C& c, const FigureStyle& style) { return draw_z_width(*c.z_width, style); });
        return with_verdict(fields);
    }();
    static const Fields<C> all = [] {
        Fields<C> fields = plan_fields("check of a patch with errors");
        fields.rows("paths", "paths", path_fields(), &C::paths);
        return with_verdict(fields).otherwise([](const C& c) { return c.is_prepared; }, prepared);
    }();
    return all;
}

}  // namespace tactus::report
