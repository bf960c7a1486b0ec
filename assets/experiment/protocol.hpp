// SPDX-License-Identifier: Apache-2.0
// Protocol of an experiment, in TOML: conditions, orders, trials, limits and the analysis, all stated beforehand. The format is
// described in docs/reference/experiment-file.md.
#pragma once

#include "dsp/psychophysics/psychometric.hpp"
#include "dsp/psychophysics/staircase.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tactus::experiment {

inline constexpr int protocol_format = 1;

/// A number made of a port's values over part of a take.
struct Measure {
    /// mean, rms; peak: largest absolute value; last: value of the last tick; slope: least squares of `port` against `other`
    /// where |port| is above 2 % of its peak; lag: time by which `port` follows `other`, s; at_press: mean of `port` in the
    /// ticks before `when` becomes true; until: time at which `port` first is true, s.
    enum class Kind : std::uint8_t { mean, rms, peak, last, slope, lag, at_press, until } kind = Kind::mean;
    std::string name;  ///< of a task's measure; empty for a stimulus
    std::string port, other;  ///< "NODE.PORT" or "NODE.PORT.CHANNEL"; a bool counts 0 or 1
    std::string when;  ///< at_press: the bool; mean, rms, peak: only while it is true, if given
    std::string unit;  ///< for display
    bool is_log = false;  ///< analysed as natural logarithm
    double scale = 1.0;  ///< factor from the measured value to the stimulus parameter
};

struct Window {
    double begin = 0.0, end = 0.0;  ///< s
};

enum class ResponseKind : std::uint8_t { yes_no, choice, same_different, adjust };

/// Answers: which interval (choice), yes or no, same or different; adjust: less, more, and "it matches".
struct Response {
    ResponseKind kind = ResponseKind::choice;
    int intervals = 2;  ///< alternatives of a choice; those of which one is adjusted
    std::vector<std::string> names;  ///< of the answers, as they are stored
    std::vector<std::string> keys;  ///< one character each
    std::vector<std::string> ports;  ///< bool outputs of the patch that answer instead: buttons, or a pose in a region
    double guess() const { return kind == ResponseKind::choice ? 1.0 / intervals : 0.0; }
};

/// How a level becomes parameters of the patch, and how the rendered stimulus is read from the take.
struct Stimulus {
    std::vector<std::string> parameters;  ///< NODE.PARAM, one for each interval
    std::string unit;  ///< of the parameters
    double standard = 0.0;  ///< SI
    bool is_relative = false;  ///< parameter = standard × (1 + level); else standard + level
    bool is_log = true;  ///< rules and fits use log10 of the level
    double min = 0.0, max = 0.0;  ///< levels; SI, or a fraction of the standard
    Measure measure;
    std::vector<Window> windows;  ///< one for each interval
    double step = 0.0;  ///< levels are whole multiples of it, at least one; 0: any
    double tolerance = 0.1;  ///< of the rendered level, a fraction of the wanted one at `max`

    /// The nearest level that can be presented.
    double presentable(double level) const;
    /// Whether a commanded level is the wanted one within the tolerance; near 0 within that of a twentieth of the range.
    bool is_rendered(double wanted, double got) const;
    std::string level_unit() const { return is_relative ? std::string() : unit; }
    double axis(double level) const;  ///< level → what rules and fits use
    double level_at(double axis) const;  ///< and back
};

struct Method {
    enum class Kind : std::uint8_t { constant, staircase, quest_plus, adjustment } kind = Kind::quest_plus;
    int trials = 60;  ///< constant: of each level; adjustment: half of them begin at each end
    double starts = 0.2;  ///< adjustment: part of the range (axis) at each end within which a trial begins
    double step = 0.0;  ///< adjustment: of one press, on the axis
    int presentations = 20;  ///< adjustment: of a trial, then it ends without a match
    std::vector<double> levels;  ///< constant
    psychophysics::StaircaseRule rule;  ///< steps on the axis of the stimulus
    psychophysics::Form form = psychophysics::Form::weibull;
    std::vector<double> slopes;  ///< at which QUEST+ expects the function; the prior of the analysis spans them
    double lapse = 0.02;
    double target = 0.75;  ///< the threshold that is reported: level with this probability
};

struct Practice {
    int needed = 0;  ///< correct answers (or finished tasks) in a row; 0: no practice
    int max_trials = 20;
};

/// The loudest that an audio output may play.
struct SoundCap {
    std::string output;  ///< name of its node; empty: all
    double level = 1.0;  ///< fraction of full scale, or a value of the signal
    bool is_of_full_scale = true;
};

/// Limits of one trial's timing, force and sound, and rules of exclusion.
struct Limits {
    std::vector<SoundCap> sound;  ///< empty: full scale
    double missed = 0.001;  ///< fraction of ticks
    double gap = 5e-3;  ///< s
    double limited = 0.01;  ///< fraction of the time
    double min_catch = 0.0;  ///< exclusion: fraction of catch trials that must be correct
    double max_marked = 0.2;  ///< exclusion: fraction of trials that may be marked
};

struct Condition {
    std::string name;
    std::map<std::string, std::string> factors;
    std::vector<std::string> settings;  ///< NODE.PARAM=VALUE
    std::optional<double> standard;  ///< in place of the stimulus', SI
    std::string display;  ///< of the window: a file, or a name in the library; empty: none
    std::string offset;  ///< shift of the picture against the hand: "none", "study" (0.3 m), or three lengths
};

struct Task {
    std::string name, instruction;
    std::filesystem::path patch;
    std::vector<std::string> settings;
    double length = 60.0;  ///< s
    std::string done;  ///< bool output; the trial ends when it becomes true. Empty: at `length`
    std::filesystem::path ideal;  ///< targets of the scripted hand that does the task perfectly; for simulated subjects
    bool is_self_paced = true;  ///< a simulated subject may take longer
    int repetitions = 1;
    std::vector<Measure> measures;
};

enum class OrderKind : std::uint8_t { latin_square, williams, block_random, co_location, table };

/// A comparison that the analysis tests: level `b` minus level `a` of a factor, averaged over all others, or within one
/// level of another factor.
struct Comparison {
    std::string measure, task;  ///< empty task: psychophysics, measure "threshold"
    std::string factor, a, b;
    std::string within_factor, within;  ///< empty: over all
    std::optional<double> margin;  ///< of equivalence, in standard deviations of the paired difference
};

struct Protocol {
    std::filesystem::path file;
    std::string title, name, about;
    std::uint64_t seed = 1;
    std::string welcome, question, pause, farewell;  ///< instructions
    OrderKind order = OrderKind::williams;
    std::filesystem::path order_file;
    int repetitions = 1;  ///< blocks of all conditions
    std::vector<Condition> conditions;
    int subjects = 16;  ///< planned
    int break_every = 0;  ///< trials; 0: no breaks
    double catch_rate = 0.0;
    Practice practice;
    Limits limits;
    bool needs_consent = true;
    std::optional<double> registration;  ///< m: largest error of the nine registration points

    // Psychophysics: one patch.
    std::filesystem::path patch;
    std::vector<std::string> settings;
    double length = 0.0;  ///< s
    std::optional<Stimulus> stimulus;
    Response response;
    Method method;

    std::vector<Task> tasks;  ///< empty: psychophysics
    std::vector<Comparison> comparisons;
    double alpha = 0.05;

    /// Standard of the stimulus in a condition, SI.
    double standard(std::size_t condition) const { return conditions[condition].standard.value_or(stimulus->standard); }
    /// Parameter of the interval with the stimulus, SI.
    double parameter(std::size_t condition, double level) const {
        return stimulus->is_relative ? standard(condition) * (1.0 + level) : standard(condition) + level;
    }
    bool is_psychophysics() const { return tasks.empty(); }
    bool is_adjustment() const { return is_psychophysics() && method.kind == Method::Kind::adjustment; }
    /// Longest duration of a trial of psychophysics, s.
    double trial_length() const { return is_adjustment() ? length * method.presentations : length; }
    /// Whether a trial of an adjustment that begins at this level begins above the middle of the range.
    bool begins_above(double level) const {
        return stimulus->axis(level) > 0.5 * (stimulus->axis(stimulus->min) + stimulus->axis(stimulus->max));
    }
    /// The protocol, patches, targets and order tables: what must not change once a subject took part.
    std::vector<std::filesystem::path> files() const;
};

/// Reads and checks. Throws Error with file:line:column.
Protocol load_protocol(const std::filesystem::path& path);

/// Order of the conditions for `row` of the design, from 0: indices into `conditions`. Throws Error for a table that is too short.
std::vector<std::size_t> condition_order(const Protocol& protocol, std::size_t row);
/// Order of the tasks: indices into `tasks`.
std::vector<std::size_t> task_order(const Protocol& protocol, std::size_t row);
/// What is unbalanced with this number of subjects; empty: nothing.
std::string balance_warning(const Protocol& protocol, std::size_t subjects);

}  // namespace tactus::experiment
