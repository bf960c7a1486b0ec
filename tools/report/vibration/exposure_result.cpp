// SPDX-License-Identifier: Apache-2.0
#include "tools/report/vibration/exposure_result.hpp"

#include "dsp/core/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

namespace tactus::report {

namespace {

using analysis::BodyDay;
using analysis::BodyOperation;
using analysis::ExposureVerdict;
using Hand = analysis::ExposureOperation;

/// More files than this are printed as one table.
constexpr std::size_t max_sections = 3;
const NumberFormat acceleration = significant(3, "m/s^2");

/// Of JSON.
std::string verdict_name(ExposureVerdict verdict) {
    switch (verdict) {
        case ExposureVerdict::below_action: return "below_action";
        case ExposureVerdict::above_action: return "above_action";
        case ExposureVerdict::above_limit: return "above_limit";
        case ExposureVerdict::at_least_above_action: return "at_least_above_action";
        case ExposureVerdict::cannot_be_judged: break;
    }
    return "cannot_be_judged";
}

std::string verdict_text(ExposureVerdict verdict, const signal::ExposureLimits& limits) {
    switch (verdict) {
        case ExposureVerdict::below_action: return fmt::format("below the action value, {:g}", limits.action);
        case ExposureVerdict::above_action: return fmt::format("above the action value, {:g}", limits.action);
        case ExposureVerdict::above_limit: return fmt::format("above the limit value, {:g}", limits.limit);
        case ExposureVerdict::at_least_above_action:
            return fmt::format("above the action value, {:g}; whether the limit value, {:g}, is kept cannot be judged",
                               limits.action, limits.limit);
        case ExposureVerdict::cannot_be_judged: break;
    }
    return "cannot be judged; axes, frequencies, peaks or samples are missing in the record";
}

Severity severity_of(ExposureVerdict verdict) {
    return verdict == ExposureVerdict::below_action       ? Severity::pass
           : verdict == ExposureVerdict::cannot_be_judged ? Severity::none
                                                          : Severity::fail;
}

/// "after 23 min"; of a lower bound "after at most 23 min".
std::string reached(double seconds, bool is_lower_bound) {
    if (seconds > 86400.0) return is_lower_bound ? "cannot be judged" : "not within a day";
    return fmt::format("after {}{:.0f} min", is_lower_bound ? "at most " : "", seconds / 60.0);
}

std::string at_least(double value, const char* unit, bool is_lower_bound) {
    return fmt::format("{}{} {}", is_lower_bound ? "at least " : "", plain(value, 3), unit);
}

double a8_of(const Hand& one) {
    return signal::daily_exposure(std::array{signal::HandArmOperation{one.total(), one.duration}});
}

double minutes_to(double value, const Hand& one) { return signal::time_to_reach(value, one.total()) / 60.0; }

ResultEntry::Series series_of(const std::vector<double>& values) {
    return {values.size(), [&values](std::size_t n) { return values[n]; }};
}

/// An axis of a hand.
struct HandAxis {
    std::string name;
    double weighted, filtered;  ///< m/s²
};

const Fields<HandAxis>& hand_axis_fields() {
    static const Fields<HandAxis> all =
        Fields<HandAxis>("axis of the hand")
            .text("axis", "axis", &HandAxis::name)
            .number("a_hw", "a_hw", significant(4, "m/s^2"), &HandAxis::weighted)
            .number("a_hw_filter", "by filter", significant(4, "m/s^2"), &HandAxis::filtered);
    return all;
}

/// When the values of the directive are reached.
const Fields<Hand>& hand_values_fields() {
    static const Fields<Hand> all =
        Fields<Hand>("time to the action and limit value")
            .text("", "action value",
                  [](const Hand& o) {
                      return reached(60.0 * minutes_to(signal::hand_arm_limits.action, o), o.is_lower_bound());
                  })
            .text("", "limit value", [](const Hand& o) {
                return reached(60.0 * minutes_to(signal::hand_arm_limits.limit, o), o.is_lower_bound());
            });
    return all;
}

/// A line of many files.
const Fields<Hand>& hand_line_fields() {
    static const Fields<Hand> all = Fields<Hand>("exposure to one tool")
                                        .text("file", "file", &Hand::file)
                                        .number("", "a", acceleration, &Hand::total)
                                        .number("a8", "A(8)", acceleration, a8_of)
                                        .number("", "a day", fixed(0, "min", "s"), &Hand::duration)
                                        .part(hand_values_fields(), [](const Hand& o) -> const Hand& { return o; })
                                        .texts("", "notes", &Hand::notes);
    return all;
}

char letter(signal::BodyAxis axis) { return static_cast<char>('x' + static_cast<int>(axis)); }
std::string letter_of(const BodyAxisOf& a) { return std::string(1, letter(a.axis->axis)); }

bool is_health(const BodyOperation& one) { return one.judgement == signal::BodyJudgement::health; }

/// Of health only.
template <class Function>
auto if_health(Function function) {
    return [function](const BodyAxisOf& a) {
        return is_health(*a.operation) ? std::optional<double>(std::invoke(function, a)) : std::nullopt;
    };
}

std::string strongest_text(const BodyOperation& one) {
    if (!is_health(one)) return {};
    const std::vector<BodyAxisOf> axes = axes_of(one);
    const BodyAxisOf& a = *std::ranges::max_element(axes, {}, &BodyAxisOf::a8);
    return fmt::format("{}a_w of axis {}: {} m/s^2; action value {}, limit value {}",
                       a.factor() == 1.0 ? "" : fmt::format("{:g} × ", a.factor()), letter(a.axis->axis),
                       plain(a.factor() * a.axis->vibration.rms, 3),
                       reached(a.time_to(signal::whole_body_limits.action), one.is_lower_bound()),
                       reached(a.time_to(signal::whole_body_limits.limit), one.is_lower_bound()));
}

/// Why the rms of an axis is not sufficient.
std::vector<std::string> shocks(const BodyOperation& one) {
    std::vector<std::string> all;
    for (const BodyOperation::Axis& axis : one.axes)
        if (const signal::BodyAxisVibration& v = axis.vibration; v.has_shocks())
            all.push_back(fmt::format(
                "axis {}: crest factor {:.1f} (limit 9), MTVV/a_w {:.2f} (1.5), VDV/(a_w T^1/4) {:.2f} (1.75)",
                letter(axis.axis), v.crest(), v.running_ratio(), v.dose_ratio()));
    return all;
}

const Fields<BodyOperation>& body_operation_fields() {
    using Body = BodyOperation;
    static const Fields<Body> all =
        Fields<Body>("vibration of one seat or floor")
            .titled([](const Body& o) {
                return fmt::format("{}: {:.0f} min a day, whole body, {}", o.file, o.duration / 60.0,
                                   is_health(o) ? "health (ISO 2631-1)" : "comfort in trains (ISO 2631-4)");
            })
            .text("file", "", &Body::file)
            .text("standard", "", [](const Body& o) { return is_health(o) ? "ISO 2631-1" : "ISO 2631-4"; })
            .number("duration_s", "", fixed(0, "s"), &Body::duration)
            .number("sample_rate_hz", "", prefixed(6, "Hz"), &Body::rate)
            .flag("calibrated", "", &Body::calibrated)
            .part(record_fields(), record_of<Body>)
            .range("band_hz", "", significant(4, "Hz"),
                   [](const Body& o) { return std::optional(std::pair(signal::weighting_k.lowest, o.band_high)); })
            .flag("lower_bound", "", &Body::is_lower_bound)
            .number("a_v", "", acceleration,
                    [](const Body& o) { return o.axes.size() == 3 ? std::optional(o.total()) : std::nullopt; })
            .text("", "total a_v",
                  [](const Body& o) {
                      return is_health(o) ? std::string() : at_least(o.total(), "m/s^2", o.is_lower_bound());
                  })
            .text("", "counts", strongest_text)
            .notes("", "shocks", shocks)
            .rows("axes", "axes", body_axis_fields(), axes_of)
            .notes("notes", "note", &Body::notes);
    return all;
}

const Fields<BodyDay>& body_day_fields() {
    static const Fields<BodyDay> all =
        Fields<BodyDay>("exposure of the whole body on a day")
            .number("a8", "", acceleration, &BodyDay::a8)
            .text("", "A(8)",
                  [](const BodyDay& d) {
                      return fmt::format("{} of axis {}: {}", at_least(d.a8, "m/s^2", d.is_lower_bound),
                                         letter(d.a8_axis), verdict_text(d.by_rms, signal::whole_body_limits));
                  })
            .judged([](const BodyDay& d) { return severity_of(d.by_rms); })
            .text("a8_axis", "", [](const BodyDay& d) { return std::string(1, letter(d.a8_axis)); })
            .number("vdv", "", significant(3, "m/s^1.75"), &BodyDay::dose)
            .text("", "VDV",
                  [](const BodyDay& d) {
                      return fmt::format("{} of axis {}: {}", at_least(d.dose, "m/s^1.75", d.is_lower_bound),
                                         letter(d.dose_axis), verdict_text(d.by_dose, signal::whole_body_dose_limits));
                  })
            .judged([](const BodyDay& d) { return severity_of(d.by_dose); })
            .text("vdv_axis", "", [](const BodyDay& d) { return std::string(1, letter(d.dose_axis)); })
            .flag("shocks", "", &BodyDay::has_shocks)
            .text("", "shocks",
                  [](const BodyDay& d) {
                      return d.has_shocks ? "which A(8) underestimates: the worse of both counts"
                                          : "none: A(8) is sufficient";
                  })
            .flag("lower_bound", "", &BodyDay::is_lower_bound)
            .text("verdict_a8", "", [](const BodyDay& d) { return verdict_name(d.by_rms); })
            .text("verdict_vdv", "", [](const BodyDay& d) { return verdict_name(d.by_dose); })
            .text("verdict", "", [](const BodyDay& d) { return verdict_name(d.verdict()); });
    return all;
}

std::vector<Hand> used(const HandExposure& e) {
    std::vector<Hand> all;
    for (const auto& one : e.operations)
        if (one.error.empty()) all.push_back(*one.result);
    return all;
}

bool is_many(const HandExposure& e) { return e.operations.size() > max_sections; }

std::optional<ExposureVerdict> verdict_of(const HandExposure& e) {
    return e.a8 ? std::optional(analysis::judge_exposure(*e.a8, signal::hand_arm_limits, e.is_lower_bound()))
                : std::nullopt;
}

}  // namespace

double BodyAxisOf::factor() const { return signal::body_factor(operation->judgement, axis->axis); }
double BodyAxisOf::a8() const {
    return factor() *
           signal::daily_exposure(std::array{signal::HandArmOperation{axis->vibration.rms, operation->duration}});
}
double BodyAxisOf::time_to(double value) const { return signal::time_to_reach(value, factor() * axis->vibration.rms); }

std::vector<BodyAxisOf> axes_of(const BodyOperation& operation) {
    std::vector<BodyAxisOf> all;
    for (const BodyOperation::Axis& axis : operation.axes) all.push_back({&operation, &axis});
    return all;
}

bool HandExposure::is_lower_bound() const {
    return std::ranges::any_of(operations, [](const auto& one) { return one.result->is_lower_bound(); });
}

const Fields<BodyAxisOf>& body_axis_fields() {
    using A = BodyAxisOf;
    static const auto of = [](auto function) {
        return [function](const A& a) { return std::invoke(function, a.axis->vibration); };
    };
    static const auto minutes = [](double value) {
        return if_health([value](const A& a) { return a.time_to(value) / 60.0; });
    };
    static const auto minutes_of_dose = [](double value) {
        return if_health(
            [value](const A& a) { return signal::time_to_dose(value, a.axis->vibration, a.factor()) / 60.0; });
    };
    using V = signal::BodyAxisVibration;
    static const Fields<A> all =
        Fields<A>("vibration along one axis")
            .text("axis", "axis", letter_of)
            .text("channel", "channel", [](const A& a) { return a.axis->channel; })
            .text("weighting", "weighting",
                  [](const A& a) {
                      return std::string(signal::body_weighting(a.operation->judgement, a.axis->axis).name);
                  })
            .number("factor", "factor", significant(3), &A::factor)
            .number("a_w", "a_w", acceleration, of(&V::rms))
            .number("a_w_filter", "by filter", acceleration, [](const A& a) { return a.axis->filtered; })
            .number("peak", "peak", acceleration, of(&V::peak))
            .number("crest", "crest", fixed(1), of(&V::crest))
            .number("mtvv", "MTVV", acceleration, of(&V::running))
            .number("mtvv_ratio", "", fixed(2), of(&V::running_ratio))
            .number("vdv", "VDV", significant(3, "m/s^1.75"), of(&V::dose))
            .number("vdv_ratio", "", fixed(2), of(&V::dose_ratio))
            .number("measured_s", "measured", fixed(0, "s"), of(&V::seconds))
            .flag("shocks", "shocks", of(&V::has_shocks))
            .number("a8", "k A(8)", acceleration, if_health(&A::a8))
            .omitted()
            .number("vdv_day", "k VDV of the day", significant(3, "m/s^1.75"),
                    if_health([](const A& a) { return a.factor() * a.axis->vibration.dose_of(a.operation->duration); }))
            .omitted()
            .number("minutes_to_action", "", fixed(0, "min"), minutes(signal::whole_body_limits.action))
            .omitted()
            .number("minutes_to_limit", "", fixed(0, "min"), minutes(signal::whole_body_limits.limit))
            .omitted()
            .number("minutes_to_action_vdv", "", fixed(0, "min"),
                    minutes_of_dose(signal::whole_body_dose_limits.action))
            .omitted()
            .number("minutes_to_limit_vdv", "", fixed(0, "min"), minutes_of_dose(signal::whole_body_dose_limits.limit))
            .omitted();
    return all;
}

const Fields<Hand>& hand_operation_fields() {
    static const Fields<Hand> all =
        Fields<Hand>("exposure of the hand to one tool")
            .titled([](const Hand& o) { return fmt::format("{}: {:.0f} min a day", o.file, o.duration / 60.0); })
            .part(record_fields(), record_of<Hand>)
            .series("a_hw", [](const Hand& o) { return series_of(o.weighted); })
            .number("a_hv", "a_hv", acceleration,
                    [](const Hand& o) { return o.three_axes ? std::optional(o.total()) : std::nullopt; })
            .number("a8", "", acceleration, a8_of)
            .number("minutes_to_action", "", fixed(0, "min"),
                    [](const Hand& o) { return minutes_to(signal::hand_arm_limits.action, o); })
            .number("minutes_to_limit", "", fixed(0, "min"),
                    [](const Hand& o) { return minutes_to(signal::hand_arm_limits.limit, o); })
            .part(hand_values_fields(), [](const Hand& o) -> const Hand& { return o; })
            .flag("calibrated", "", &Hand::calibrated)
            .range("band_hz", "", significant(4, "Hz"),
                   [](const Hand& o) { return std::optional(std::pair(signal::weighting_h.lowest, o.band_high)); })
            .flag("lower_bound", "", &Hand::is_lower_bound)
            .series("a_hw_filter", [](const Hand& o) { return series_of(o.filtered); })
            .text("a_hw_by", "", [](const Hand&) { return "transform of the record"; })
            .texts("axes", "", &Hand::axes)
            .text("file", "", &Hand::file)
            .number("duration_s", "", fixed(0, "s"), &Hand::duration)
            .number("sample_rate_hz", "", prefixed(6, "Hz"), &Hand::rate)
            .rows("", "axes", hand_axis_fields(),
                  [](const Hand& o) {
                      std::vector<HandAxis> axes;
                      for (std::size_t i = 0; i < o.axes.size(); ++i)
                          axes.push_back({o.axes[i], o.weighted[i], o.filtered[i]});
                      return axes;
                  })
            .notes("notes", "note", &Hand::notes);
    return all;
}

const Fields<HandExposure>& hand_exposure_fields() {
    static const Fields<HandExposure> all =
        Fields<HandExposure>("vibration exposure of the hand on a day, ISO 5349-1")
            .rows("", "operations", hand_line_fields(),
                  [](const HandExposure& e) { return is_many(e) ? used(e) : std::vector<Hand>(); })
            .children("operations", "operation", tried_fields(hand_operation_fields()),
                      [](const HandExposure& e) -> const auto& { return e.operations; })
            .printed([](const HandExposure& e) { return is_many(e) ? Where::pages : Where::everywhere; })
            .number("a8", "", acceleration, &HandExposure::a8)
            .text("", "A(8)",
                  [](const HandExposure& e) {
                      return e.a8 ? fmt::format("{}: {}", at_least(*e.a8, "m/s^2", e.is_lower_bound()),
                                                verdict_text(*verdict_of(e), signal::hand_arm_limits))
                                  : "none of the day: " + e.no_day;
                  })
            .judged([](const HandExposure& e) {
                const std::optional<ExposureVerdict> verdict = verdict_of(e);
                return verdict ? severity_of(*verdict) : Severity::none;
            })
            .flag("lower_bound", "", &HandExposure::is_lower_bound)
            .text("verdict", "",
                  [](const HandExposure& e) {
                      const std::optional<ExposureVerdict> verdict = verdict_of(e);
                      return verdict ? std::optional(verdict_name(*verdict)) : std::nullopt;
                  })
            .number("years_to_white_fingers", "", significant(2), [](const HandExposure& e) {
                return e.a8 && *e.a8 > 0.0 ? std::optional(signal::years_to_white_fingers(*e.a8)) : std::nullopt;
            });
    return all;
}

const Fields<BodyExposure>& body_exposure_fields() {
    static const Fields<BodyExposure> all =
        Fields<BodyExposure>("vibration exposure of the whole body, ISO 2631")
            .text("body", "", &BodyExposure::body)
            .children("operations", "operation", tried_fields(body_operation_fields()),
                      [](const BodyExposure& e) -> const auto& { return e.operations; })
            .child("day", "day", body_day_fields(), [](const BodyExposure& e) -> const auto& { return e.day; })
            .text("", "A(8) of the day", [](const BodyExposure& e) {
                return e.day || e.body != "whole" ? std::string() : "none: " + e.no_day;
            });
    return all;
}

}  // namespace tactus::report
