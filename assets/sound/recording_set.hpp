// SPDX-License-Identifier: Apache-2.0
// Recordings of a saw, each with its conditions: state, rate and load.
#pragma once

#include "assets/sound/stretch.hpp"
#include "dsp/vibration/saw_model.hpp"
#include "dsp/vibration/saw_recording.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::sound {

struct Recording {
    std::filesystem::path file;
    bool cutting = false;              ///< cutting bone; else in free air
    double rate = 0.0;                 ///< reciprocation rate (strokes back and forth per second), Hz
    bool rate_estimated = false;       ///< estimated from the sound, because the set does not state it
    double order_share = 0.0;          ///< of its power, in multiples of the rate; see vibration::order_share
    double load = 0.0;                 ///< thrust, N; 0 in free air
    double density = 0.0;              ///< of the bone, kg/m³; 0: not stated
    std::string sensor;                ///< description of the sensor
    std::string note;
    std::optional<double> full_scale;  ///< m/s² at sample value 1; empty when uncalibrated
    double loop_begin = 0.0;           ///< s
    double loop_end = 0.0;             ///< s; 0 means to the end
    int sample_rate = 0;               ///< Hz
    std::vector<float> samples;        ///< mono
    std::string file_note{};           ///< defect of the sound's header; empty: none

    double used_from() const { return loop_begin; }  ///< s
    double used_to() const { return loop_end > 0.0 ? loop_end : static_cast<double>(samples.size()) / sample_rate; }
};

struct RecordingSet {
    std::filesystem::path path;
    std::string title, note, licence;
    bool synthesised = false;  ///< computed, not recorded
    std::vector<Recording> recordings;
    std::optional<vibration::SawModel> model;  ///< instead of recordings
    bool model_calibrated = false;

    bool calibrated() const {
        return model ? model_calibrated : !recordings.empty() && recordings.front().full_scale.has_value();
    }
};

/// Reads a set (TOML) and all its sounds:
///
///     title = "…"   note = "…"   licence = "…"   synthesised = true
///     sensor = "contact microphone"      # sensor and full_scale are the defaults of all recordings
///     full_scale = "98.1 m/s^2"          # or "uncalibrated", the default
///     [[recording]]
///     file  = "cutting_233.flac"         # relative to the folder of the set
///     state = "cutting"                  # or "free_air"
///     rate  = "233 Hz"                   # of reciprocation, 5 Hz to 1 kHz
///     load  = "7 N"                      # cutting only, required there
///     density = "1200 kg/m^3"            # cutting only: the apparent density of the bone, optional
///     loop  = ["0.1 s", "2.4 s"]         # optional: the part to use
///     note  = "…"
///
/// A plain sound file becomes a set of one uncalibrated cutting recording at 7 N; its rate is estimated unless `rate`
/// (Hz) is given, or follows the name: `my-saw.wav#233 Hz`. SawVoice plays it 12 dB lower in free air. A set cannot mix calibrated and uncalibrated recordings.
/// A file with a table [model] (saw_model_file.hpp) becomes a set without recordings, with that model.
/// Throws Error with file, line and column.
RecordingSet load_recording_set(const std::filesystem::path& path, std::optional<double> rate = std::nullopt);

/// Warning that a sound file may not be a recording of a saw. Empty if there is no doubt, and for a set written by hand.
/// A recording in whose multiples of the rate lies less than `min_order_share` of the power is no machine with that
/// rate: 0.18 to 0.43 was found for chain saws by a microphone and 0.43 to 1 for the library's saw, less than 0.13 for
/// noise, for a fan, and for rates that are not the machine's.
inline constexpr double min_order_share = 0.15;
std::string saw_question(const RecordingSet& set);
/// The set was made of a sound file.
bool is_plain_sound(const RecordingSet& set);

/// Limits what is used of a recording to a stretch of its file. Throws Error when that is outside of the file or of its
/// loop, or too short.
void cut(Recording& recording, const Stretch& stretch);

/// Refers to the samples of `recording`.
vibration::SawRecording saw_recording(const Recording& recording);
/// m/s² rms: playback level of the strongest recording of an uncalibrated set. Powered bone saws have 90 to 180 m/s² at
/// the handle.
inline constexpr double assumed_vibration = 100.0;
inline constexpr const char* uncalibrated_note =
    "the recordings are not calibrated: the strongest is played as 100 m/s^2 rms; 'full_scale' in a recording set "
    "states their level";

/// The input of SawVoice::prepare and fit_saw_model; refers to `set`. Levels of an uncalibrated set are normalised together.
std::vector<vibration::SawRecording> saw_recordings(const RecordingSet& set);

}  // namespace tactus::sound
