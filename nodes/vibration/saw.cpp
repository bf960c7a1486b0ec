// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/modelled_saw.hpp"
#include "dsp/vibration/saw_voice.hpp"
#include "dsp/vibration/tooth_passing.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace tactus::nodes {

struct Saw {
    static constexpr auto about =
        "Vibration of a powered saw by blade rate, load and density, from recordings or from a model of them.";

    In<Ramp> load{optional, "thrust on the blade; unconnected: 0", "N"};
    In<bool> trigger{optional, "the saw runs while true; unconnected: it always runs"};
    In<bool> contact{optional,
                     "the blade touches bone, saw_blade.in_contact: it sounds as one that cuts; unconnected: "
                     "from 'load_on' to 'load_off'"};
    In<Ramp> density{optional, "apparent density of the bone; only a model follows it; unconnected: unknown", "kg/m^3"};
    In<Ramp> tooth_force{optional,
                         "of the teeth along the stroke, saw_blade.stroke_force: with 'teeth' and 'passing' a "
                         "model sounds the teeth as they pass; unconnected: as recorded",
                         "N"};
    In<Ramp> teeth{optional, "teeth that bear, saw_blade.teeth", "1"};
    In<Ramp> passing{optional, "speed of the teeth at mid-stroke over their pitch, saw_blade.passing", "Hz"};
    Out<Signal> signal{"the vibration; recordings that are not calibrated are played as 100 m/s^2 rms", "m/s^2"};
    Out<double> rate{"strokes of the blade per second", "Hz"};
    Out<bool> running{"the blade moves"};
    Out<bool> cutting{"it sounds as a blade that cuts"};
    Asset<sound::RecordingSet> saw{"the recordings, or a model made of them by 'tactus model'"};
    Choice voice{{"recordings", "model"},
                 "recordings: the nearest recording at the blade's pitch; model: orders and residual noise, "
                 "interpolated between the recordings; a model file is always played as a model"};
    Param blade_rate{"233 Hz", "0 Hz", "1 kHz", "strokes per second that the operator has set"};
    Param gain{structural, "1", "0", "1000", "factor of the vibration"};
    Param spin_up{structural, "80 ms", "0 ms", "10 s", "time constant of the rate after the trigger is pulled"};
    Param spin_down{structural, "150 ms", "0 ms", "10 s", "time constant of the rate after it is released"};
    Param load_on{structural, "0.5 N", "0 N", "100 N", "cutting starts above this load, unless 'contact' is connected"};
    Param load_off{structural, "0.3 N", "0 N", "100 N", "cutting ends below this load"};
    Param mass{structural, "0.5 kg", "10 g", "10 kg", "that the tooth_force shakes: the saw and the hand's share"};
    Param fade{structural, "20 ms", "1 ms", "1 s", "duration of the cross-fade between recordings"};

    void prepare(const Setup& setup) {
        const vibration::SawBehaviour behaviour{spin_up, spin_down, load_on, load_off, fade, gain};
        try {
            modelled_ = saw->model.has_value() || voice.is("model");
            if (!modelled_) voice_.prepare(setup.rate(), sound::saw_recordings(*saw), behaviour);
            else if (saw->model) model_.prepare(setup.rate(), *saw->model, behaviour);
            else model_.prepare(setup.rate(), vibration::fit_saw_model(sound::saw_recordings(*saw)), behaviour);
        } catch (const Error& error) {
            setup.fail(error.message());
        }
        name_ = setup.name;
        highest_ = 0.42 * setup.rate();
        calibrated_ = saw->calibrated();
        question_ = sound::saw_question(*saw);
        recorded_rate_ = sound::is_plain_sound(*saw) ? saw->recordings.front().rate : 0.0;
    }

    void process(const Tick& tick) noexcept {
        const bool pulled = !trigger.connected || trigger;
        const double commanded = blade_rate;
        const std::optional<bool> touches = contact.connected ? std::optional(contact.get()) : std::nullopt;
        const bool has_teeth = tooth_force.connected && teeth.connected && passing.connected;
        if (modelled_) {
            for (int i = 0; i < tick.frames; ++i) {
                const double beat = has_teeth ? teeth_beat(i) : 0.0;
                signal[i] = static_cast<float>(model_.tick(load[i], density[i], pulled, commanded, touches) + beat);
                rate[i] = model_.blade().rate();
                running[i] = model_.blade().state() != vibration::SawState::off;
                cutting[i] = model_.blade().state() == vibration::SawState::cutting;
            }
            return;
        }
        for (int i = 0; i < tick.frames; ++i) {
            signal[i] = voice_.tick(load[i], pulled, commanded, touches);
            rate[i] = voice_.reciprocation_rate();
            running[i] = voice_.running();
            cutting[i] = voice_.state() == vibration::SawState::cutting;
        }
    }

    void report(Report& report) const {
        std::string note = calibrated_ ? "" : sound::uncalibrated_note;
        const auto add = [&note](const std::string& text) { note += (note.empty() ? "" : ". ") + text; };
        if (!question_.empty()) add(question_);
        if (const double played = blade_rate; recorded_rate_ > 0.0 && std::abs(played / recorded_rate_ - 1.0) >
                                                                          vibration::SawVoice::greatest_pitch_change)
            add(fmt::format("the recording has {:.4g} Hz and is played at {:.4g} Hz, the 'blade_rate'", recorded_rate_,
                            played));
        if (!note.empty()) report.set(name_, "note", note);
    }

private:
    /// m/s².
    double teeth_beat(int i) noexcept {
        const vibration::BladeMotion& blade = model_.blade();
        const vibration::TeethInBone now{tooth_force[i], teeth[i], passing[i]};
        return gain * vibration::tooth_passing_force(now, blade.cycles(), blade.rate(), highest_) / mass;
    }

    vibration::SawVoice voice_;
    vibration::ModelledSaw model_;
    double highest_ = 0.0;  // Hz
    bool modelled_ = false;
    std::string name_, question_;
    double recorded_rate_ = 0.0;  // Hz, of a sound file in place of a set; 0: a set
    bool calibrated_ = true;
};

TACTUS_NODE(Saw, load, trigger, contact, density, tooth_force, teeth, passing, signal, rate, running, cutting, saw,
            voice, blade_rate, gain, spin_up, spin_down, load_on, load_off, mass, fade)

}  // namespace tactus::nodes
