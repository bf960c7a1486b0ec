// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/energy_cap.hpp"
#include "dsp/control/force_limiter.hpp"
#include "dsp/core/error.hpp"
#include "graph/node/node.hpp"
#include "nodes/device/cap_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::nodes {

/// A limit of 0 in `info` means that the device declares none.
static double lower_limit(double wanted, double of_device) {
    return of_device > 0.0 ? std::min(wanted, of_device) : wanted;
}

struct DeviceOutput {
    static constexpr auto about =
        "Sends a force to the hand: checked, limited, ramped in, and faded to zero on any fault. A contact returns no "
        "more energy than the hand has put in, but for power that is granted. The limits of the device apply too. Of a "
        "device without motors, as a mouse, only the strength of its simulated hand limits the force: nobody feels it.";
    static constexpr NodeRole role = NodeRole::hand_sink;

    In<Wrench> wrench{"on the hand, about the handle, device frame", "N, N m"};
    In<double> granted{optional, "power that the patch may give the hand on purpose: granted_power.power", "W"};
    Out<Wrench> applied{"the wrench that the device is given", "N, N m"};
    Out<bool> engaged{"forces are on"};
    Out<bool> torque_dropped{"a torque was asked for, but the device has none"};
    Text device{"", "name of an entry of [devices]; empty: the only one"};
    Param max_force{structural, "10 N", "0 N", "50 N", "largest force on the hand"};
    Param max_torque{structural, "0.5 N m", "0 N m", "5 N m", "largest torque on the hand"};
    Param slew{structural, "1 N/ms", "0.01 N/ms", "100 N/ms", "limit of the rate of change of the force"};
    Param torque_slew{structural, "0.05 N m/ms", "0.001 N m/ms", "10 N m/ms",
                      "limit of the rate of change of the torque"};
    Param recover_after{
        structural, "1 s", "0 s", "1 h",
        "forces may come back after ticks and samples were good for this long: after a late tick by themselves, at "
        "least "
        "1 s later and over 0.5 s, three times a minute; after a fault of samples when they are small; 0 s: only by "
        "'recover'. After a non-finite force they stay off"};
    Param recover{as_trigger, "0", "0", "1e9", "change the number to let forces return after late ticks"};
    Param engage_time{structural, "100 ms", "0 ms", "10 s", "duration of the ramp once forces are small"};

    Flag energy_cap{true, "a contact returns no more energy than the hand has put in; false: 'check' warns"};

    void prepare(const Setup& setup) {
        port_ = &setup.host->device(device.value, DeviceUse::drive, device.where);
        name_ = setup.name;
        limiter_.prepare(port_->info.without_motors ? unfelt_limits(port_->info) : limits(), seconds(setup.period));
        const control::EnergyCapSettings cap = cap_settings(port_->info, seconds(setup.period));
        if (energy_cap && cap.delay_s > control::EnergyCap::longest_delay_s(cap.period_s))
            throw Error(
                device.where,
                fmt::format("the device '{}' answers after {:.3g} ms, longer than {} ticks of {:.4g} Hz, within "
                            "which energy_cap bounds the energy; lower the rate of '{}'",
                            port_->info.name, cap.delay_s * 1e3, control::EnergyCap::max_delay, 1.0 / cap.period_s,
                            setup.name));
        cap_.prepare(cap);
        is_new_ = true;
    }

    void process(const Tick& tick) noexcept {
        if (is_new_) take_over(tick);
        const DeviceSample& s = port_->sample;
        if (!port_->info.without_motors) protect_hand(tick);
        // The port holds what the device was given after the last tick.
        limiter_.start_from(port_->wrench);
        const bool is_usable = is_good(s);
        const Wrench limited = limiter_.tick(givable(), s.counter, is_usable, tick.elapsed_seconds());
        const Wrench out = capped(limited, is_usable, tick.elapsed_seconds());
        applied = out;
        port_->wrench = out;
        port_->fault = limiter_.fault();
        if (limiter_.fault() != control::Fault::none) recover_from_fault(tick);
        else if (port_->late.comes_in()) port_->late.come_in(limiter_.engaged(), !limiter_.is_ramping());
        asked_ = recover;
        port_->state = state();
        counter_ = s.counter;
        engaged = was_engaged_ = limiter_.engaged();
        engaged_ticks_ += limiter_.engaged();
        const double force = glm::length(out.force);
        largest_ = std::max(largest_, force);
        sum_ += force;
        note_felt(tick, force);
    }

    /// The section of all hands together: largest forces, sums of counts, the first fault.
    void report(Report& report) const {
        const control::ForceStatistics& s = limiter_.statistics();
        const auto ticks = static_cast<double>(s.ticks);
        const double sum =
            sum_ + report.number("force", "mean_N").value_or(0.0) * report.number("force", "ticks").value_or(0.0);
        report.raise("force", "max_N", largest_);
        report.add("force", "ticks", ticks);
        const double all = *report.number("force", "ticks");
        report.set("force", "mean_N", all > 0.0 ? sum / all : 0.0);
        tell_felt(report);
        report.raise("force", "raw_max_N", s.max_force);
        report.raise("force", "raw_max_step_N", s.max_force_step);
        report.add("force", "over_limit_ticks", static_cast<double>(s.force_limited));
        report.add("force", "slew_limited_ticks", static_cast<double>(s.slew_limited));
        report.add("contact", "limited_ticks", static_cast<double>(s.limited));
        if (!port_->info.actuates_torque) {
            report.raise("force", "torque_dropped_max_Nm", max_dropped_);
            report.add("force", "torque_dropped_ticks", static_cast<double>(ticks_dropped_));
        }
        const control::EnergyCapStatistics& e = cap_.statistics();
        if (!port_->info.without_motors && !energy_cap) report.set("force", "energy_cap", std::string("off"));
        else report.set_unless("not needed", "force", "energy_cap", port_->info.without_motors ? "not needed" : "on");
        report.add("force", "energy_capped_ticks", static_cast<double>(capped_ticks_));
        report.raise("force", "energy_capped_max_N", max_capped_);
        report.raise("force", "energy_stored_max_J", e.max_stored);
        report.raise("force", "energy_returned_max_J", e.max_returned);
        report.raise("force", "granted_power_max_W", max_granted_);
        report.add("force", "granted_J", e.granted);
        report.add("force", "engaged_ticks", static_cast<double>(engaged_ticks_));
        // Forces engage only after the patch has requested almost zero force.
        if (engaged_ticks_ == 0 && faults_ == 0 && s.max_force >= control::ForceLimits{}.engage_force)
            report.set("forces_never_engaged", name_, s.max_force);
        report.set_unless(control::describe(control::Fault::none), "force", "fault", control::describe(last_fault_));
        report.add("force", "faults", static_cast<double>(faults_));
        report.add("force", "returns_after_late_ticks", static_cast<double>(returns_));
    }

private:
    control::ForceLimits limits() const {
        control::ForceLimits limits;
        limits.max_force = lower_limit(max_force, port_->info.max_force);
        limits.max_torque = lower_limit(max_torque, port_->info.max_torque);
        limits.force_slew = slew;
        limits.torque_slew = torque_slew;
        limits.engage_ramp_s = engage_time;
        return limits;
    }

    /// Nobody feels the force of a device without motors, so nothing needs to come in slowly.
    static control::ForceLimits unfelt_limits(const DeviceInfo& info) {
        control::ForceLimits limits;
        limits.max_force = lower_limit(HUGE_VAL, info.max_force);
        limits.max_torque = lower_limit(HUGE_VAL, info.max_torque);
        limits.force_slew = limits.torque_slew = HUGE_VAL;
        limits.engage_ticks = 0;
        limits.engage_ramp_s = limits.fade_s = 0.0;
        return limits;
    }

    /// Fades the force while ticks or values are late, and while an edit or a pause wants it.
    void protect_hand(const Tick& tick) noexcept {
        const DeviceSample& s = port_->sample;
        limiter_.hold_off(port_->hold_off);
        const bool is_quiet = port_->wrench.force == Vec3(0.0) && port_->wrench.torque == Vec3(0.0);
        port_->late.tick(is_late(), is_quiet && !s.taken, tick.elapsed_seconds());
        if (s.sound_lost) limiter_.fail(control::Fault::sound_lost);
        if (s.taken) limiter_.cut(control::Fault::late_commit);
        if (s.late) limiter_.fail(control::Fault::late_source);
        if (port_->overdue != control::Fault::none) limiter_.fail(port_->overdue);
    }

    /// An edit clears no fault: what the node before it left on the port holds on, and forces come back as they would have
    /// there, through engagement.
    void take_over(const Tick& tick) noexcept {
        is_new_ = false;
        asked_ = recover;
        port_->late.prepare(seconds(tick.period), recover_after);
        if (port_->fault != control::Fault::none) limiter_.fail(port_->fault);
        else if (port_->late.comes_in()) limiter_.recover(control::LateReturn::ramp_s);
    }

    /// The simulation continues while forces are off; the requested force then differs from the rendered one.
    void note_felt(const Tick& tick, double force) noexcept {
        const double asked = glm::length(wrench.get().force);
        if (!(asked > control::ForceLimits{}.engage_force)) return;
        ++asked_ticks_;
        felt_ += force;
        if (limiter_.engaged()) return;
        if (!(off_s_ > 0.0)) off_from_ = tick.time_seconds();
        off_until_ = tick.time_seconds();
        off_s_ += seconds(tick.period);
    }

    /// Of several hands that for which forces were off longest.
    void tell_felt(Report& report) const {
        const auto& told = report.sections["force"];
        if (const auto other = told.find("off_s"); other != told.end() && std::get<double>(other->second) > off_s_)
            return;
        report.set("force", "felt_mean_N", asked_ticks_ > 0 ? felt_ / static_cast<double>(asked_ticks_) : 0.0);
        report.set("force", "off_s", off_s_);
        report.set("force", "off_from_s", off_from_);
        report.set("force", "off_until_s", off_until_);
    }

    /// Observes also while it is off, so that the report says what the hand was given.
    Wrench capped(const Wrench& limited, bool is_usable, double elapsed_s) noexcept {
        if (port_->info.without_motors) return limited;
        const double watts = granted.connected && granted.get() > 0.0 ? std::min(granted.get(), max_granted_W) : 0.0;
        max_granted_ = std::max(max_granted_, watts);
        const Pose nowhere{{}, {0.0, 0.0, 0.0, 0.0}};
        const DeviceSample& s = port_->sample;
        const Wrench out = cap_.tick(limited, port_->wrench, is_usable ? s.pose : nowhere, elapsed_s, watts, s.taken);
        if (!energy_cap) return limited;
        const double removed = glm::length(limited.force - out.force);
        if (removed > 0.0 || limited.torque != out.torque) ++capped_ticks_;
        max_capped_ = std::max(max_capped_, removed);
        return out;
    }

    /// The part of the wrench that the device can render. A non-finite wrench is kept, for the limiter to detect.
    Wrench givable() noexcept {
        Wrench asked = wrench.get();
        torque_dropped = false;
        if (port_->info.actuates_torque || !is_finite(asked)) return asked;
        const double torque = glm::length(asked.torque);
        asked.torque = Vec3(0.0);
        if (!(torque > 0.0)) return asked;
        torque_dropped = true;
        max_dropped_ = std::max(max_dropped_, torque);
        ++ticks_dropped_;
        return asked;
    }

    void recover_from_fault(const Tick& tick) noexcept {
        using control::Fault;
        last_fault_ = limiter_.fault();
        const DeviceSample& s = port_->sample;
        if (is_late() && !port_->info.without_motors) port_->late.lose();
        if (!in_fault_) {
            in_fault_ = true;
            is_let_ = false;
            must_engage_ = !was_engaged_;
            still_ticks_ = control::ForceLimits{}.stale_ticks;
            ++faults_;
            well_for_ = 0.0;
        }
        must_engage_ = must_engage_ || port_->hold_off;
        // A device may give samples less often than this ticks.
        still_ticks_ = s.counter != counter_ ? 0 : still_ticks_ + 1;
        const bool is_fresh = is_good(s) && still_ticks_ < control::ForceLimits{}.stale_ticks;
        well_for_ = is_fresh && !s.taken && !s.sound_lost ? well_for_ + tick.elapsed_seconds() : 0.0;
        if (last_fault_ == Fault::not_finite) return;
        if (port_->info.without_motors) {
            if (is_fresh) limiter_.recover();
            in_fault_ = !is_fresh;
            return;
        }
        const bool is_asked = recover.value != asked_;
        if (is_asked && port_->late.is_lost()) port_->late.forgive();
        is_let_ = is_let_ || is_asked;
        if (is_lateness(last_fault_)) return return_from_lateness(is_fresh);
        if (recover_after == 0.0 || well_for_ < recover_after) return;
        // A tick that was late, too, asks for more than the device.
        if (port_->late.is_lost() && !port_->late.returns()) return;
        limiter_.recover(port_->late.comes_in() ? control::LateReturn::ramp_s : 0.0);
        in_fault_ = is_let_ = false;
    }

    /// Without an energy cap, forces that are large already would throw out a hand that is deep inside of a body. And a
    /// hand that felt nothing when the tick was late, or may have moved since in a pause or an edit, has not chosen to be
    /// there. Then they wait for the hand to leave it.
    void return_from_lateness(bool is_fresh) noexcept {
        if (!is_fresh || limiter_.is_held_off() || (recover_after == 0.0 && !is_let()) || !port_->late.returns())
            return;
        if (energy_cap && !must_engage_) limiter_.recover_slowly(control::LateReturn::ramp_s);
        else limiter_.recover(control::LateReturn::ramp_s);
        in_fault_ = is_let_ = false;
        ++returns_;
    }

    bool is_late() const noexcept {
        return port_->sample.taken || port_->sample.late || port_->overdue != control::Fault::none;
    }

    /// A person let forces return a short while ago.
    bool is_let() const noexcept { return is_let_ && port_->late.is_attended(); }

    control::ForceState state() const noexcept {
        using control::Fault, control::ForceState;
        switch (limiter_.fault()) {
            case Fault::none: break;
            case Fault::not_finite: return ForceState::never;
            case Fault::late_commit:
            case Fault::late_source:
            case Fault::late_value:
            case Fault::old_world:
            case Fault::unusable_value: {
                const bool waits_for_hand = port_->late.needs_hand() || (recover_after == 0.0 && !is_let());
                if (waits_for_hand) return ForceState::by_hand;
                return must_engage_ || !energy_cap ? ForceState::returns_freed : ForceState::returns;
            }
            default:
                if (recover_after == 0.0) return ForceState::never;
                return port_->late.needs_hand() ? ForceState::by_hand : ForceState::returns_freed;
        }
        if (limiter_.is_held_off()) return ForceState::held_back;
        if (!limiter_.engaged()) return ForceState::waits;
        return limiter_.is_ramping() ? ForceState::ramps : ForceState::on;
    }

    static constexpr double max_granted_W = 50.0;
    DevicePort* port_ = nullptr;
    control::ForceLimiter limiter_;
    control::EnergyCap cap_;
    double max_granted_ = 0.0, max_capped_ = 0.0;
    std::int64_t capped_ticks_ = 0;
    double largest_ = 0.0, sum_ = 0.0, well_for_ = 0.0, max_dropped_ = 0.0;
    double felt_ = 0.0, off_s_ = 0.0, off_from_ = 0.0, off_until_ = 0.0, asked_ = 0.0;
    std::int64_t asked_ticks_ = 0;
    std::int64_t counter_ = 0, still_ticks_ = 0, faults_ = 0, returns_ = 0, ticks_dropped_ = 0, engaged_ticks_ = 0;
    std::string name_;
    control::Fault last_fault_ = control::Fault::none;
    bool is_new_ = true;  // no tick has run
    bool was_engaged_ = false;  // after the tick before
    bool in_fault_ = false;
    bool must_engage_ = false;  // after this fault, also if it is lateness
    bool is_let_ = false;  // a person lets forces return
};

TACTUS_NODE(DeviceOutput, wrench, granted, applied, engaged, torque_dropped, device, max_force, max_torque, slew,
            torque_slew, engage_time, recover_after, recover, energy_cap)

}  // namespace tactus::nodes
