// SPDX-License-Identifier: Apache-2.0
// The verbs of the tactus command. Each takes what the command line said and returns the exit code; input that cannot
// be used is thrown as Error and ends as exit code 2.
#pragma once

#include "assets/bone/import.hpp"
#include "graph/patch.hpp"
#include "tools/study/displays/calibration_settings.hpp"
#include "tools/picture/scene/frame_choice.hpp"
#include "tools/study/vibration/record.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus {

enum ExitCode : int { done = 0, answer_is_no = 1, bad_input = 2 };

/// What every verb that takes a patch knows about it.
struct PatchChoice {
    std::string patch;  ///< a path, or a name in the library
    PatchOverrides overrides;
    std::optional<std::uint64_t> seed;
    bool json = false;
};

struct RenderChoice : PatchChoice {
    double seconds = 10.0;
    std::filesystem::path out;
    int threads = 0;      ///< 0: one per core
    std::string block;    ///< "", a number, or "random"
    std::filesystem::path log, record;
    FrameChoice frames;
};

/// The window on a run.
struct ViewChoice {
    bool wanted = false;
    bool keep_running = false;                ///< closing the window leaves the run alive
    std::filesystem::path script;             ///< what is done in the window, instead of by hand
    std::filesystem::path reference;          ///< sound file whose spectrum stands behind the signals'
    double scale = 0.0;                       ///< of the window's contents, 0: what the screen says
    SightChoice sight;
};

struct RunChoice : PatchChoice {
    std::optional<double> seconds;
    double dilate = 1.0;
    std::string audio;         ///< "", "file", "none", "default" or part of a card's name
    double audio_margin = 10;  ///< ms
    std::filesystem::path out, log, record;
    bool keeps_journal = false;  ///< so that recording can begin within the run
    bool edits = true;  ///< take over the patch file when it is saved, and listen to 'set'
    ViewChoice view;
};

struct TakeViewChoice {
    std::filesystem::path take;
    ViewChoice view;
};

struct SetChoice {
    std::vector<std::string> settings;  ///< "node.param=value"
    int process = 0;                    ///< 0: the only run there is
};

struct ReplayChoice {
    std::filesystem::path take;
    bool json = false;
    bool anyway = false;  ///< although assets have changed
};

struct ImportChoice : ImportOptions {
    std::filesystem::path out;
    bool json = false;
};

struct MeasureChoice : PatchChoice {
    std::string in, out_port, device;
    std::filesystem::path csv = "response.csv";
    double first = 20.0, last = 2000.0;              ///< Hz
    double duration = 8.0, pause = 1.0;              ///< s
    double amplitude = 1.0;
    int repeats = 1;
    double fit_lowest = 30.0, fit_highest = 400.0;   ///< Hz: where the resonance is looked for
    double rate = 48000.0;                           ///< of the sound card, Hz
    int output_channel = 1, input_channel = 1;       ///< from 1
};

struct EqualiseChoice {
    std::filesystem::path response, out, signal;
    std::string kind = "minimum";
    double rate = 48000.0;                       ///< Hz
    double lowest = 45.0, highest = 1000.0;      ///< Hz
    double length = 0.128;                       ///< s
    double greatest_boost_db = 20.0;
    double regularisation = 1e-4;
    std::string actuator = "haptuator_large";
    double volts = 1.0;                          ///< per unit of the response's input
    double scale = 1.0;                          ///< units of the response's input per unit of the signal file
    bool json = false;
};

struct CompareChoice {
    std::filesystem::path reference, output, thresholds;
    std::string plot;                                  ///< .svg or .png
    std::filesystem::path report;                      ///< .html
    std::string touch = "displacement";
    std::string actuator;                              ///< whose limits decide the level gap
    double mass = 0.3;                                 ///< that it shakes, kg
    double reference_scale = 1.0, output_scale = 1.0;  ///< units per full scale
    double longest_delay = 2.0;                        ///< s
    int channel = 0;                                   ///< 0: the mean of all
    std::vector<std::string> time_columns, columns;    ///< of CSV logs: of both files, or of each
    std::string time_unit;
    int jobs = 0;                                      ///< pairs at a time, 0: one per core
    std::filesystem::path table;                       ///< .csv
    bool json = false;
};

/// A patch beside the recordings that it plays.
struct ValidateChoice : PatchChoice {
    std::filesystem::path set;             ///< of recordings
    std::string saw, out_port;             ///< node, NODE.PORT; empty: found in the patch
    std::vector<double> levels{0.0, -6.0}; ///< dB on top of the patch's
    double seconds = 4.0;                  ///< that are compared of each run
    std::filesystem::path thresholds, report, plot, table;
    std::string touch = "displacement";
    int jobs = 0;                          ///< runs at a time, 0: one per core
};

struct SpectrumChoice : RecordOptions {
    std::string window = "hann", detrend = "constant", average = "mean", scaling = "density";
    std::string envelope;         ///< LOW:HIGH in Hz
    std::string rate = "20:500";  ///< LOW:HIGH in Hz: where the fundamental may lie
    std::optional<std::size_t> segment;
    std::optional<double> overlap;  ///< share of the segment
    int orders = 10, jobs = 0;      ///< files at a time, 0: one per core
    std::filesystem::path csv, plot, table, report;
};

struct OrdersChoice : RecordOptions {
    int tacho = 0;                      ///< channel from 1; 0: none
    double pulses = 1.0;                ///< of the tachometer, per revolution
    std::optional<double> fixed;        ///< Hz
    std::string range = "20:400";       ///< LOW:HIGH in Hz: where a tracked rate may lie
    int highest = 10;
    std::filesystem::path csv;
};

struct ExposureChoice : RecordOptions {
    std::vector<std::string> durations;  ///< quantities of time; a bare number is hours
    bool uncalibrated = false;           ///< take values of a record without calibration as m/s²
    int jobs = 0;                        ///< files at a time, 0: one per core
    std::filesystem::path table;
};

int spectrum_verb(const SpectrumChoice& choice);
int orders_verb(const OrdersChoice& choice);
int exposure_verb(const ExposureChoice& choice);
int compare_verb(const CompareChoice& choice);
int validate_verb(const ValidateChoice& choice);
int measure_verb(const MeasureChoice& choice);
int equalise_verb(const EqualiseChoice& choice);

struct ExportChoice {
    std::filesystem::path input, out;
    std::string bone;             ///< empty: all of the file
    std::string quantity = "hu";  ///< of a volume: "hu", "density" or "distance"
    bool json = false;
};

struct BenchChoice {
    int rounds = 3;  ///< the best of so many counts
    bool json = false;
};

struct ScrubBenchChoice {
    std::filesystem::path take;
    int jumps = 1000;
    bool json = false;
};

struct InfoChoice {
    std::filesystem::path input;
    std::filesystem::path out;  ///< of the picture: a file, or a folder for INPUT.png; empty: none
    std::string series;         ///< of a DICOM folder
    bool json = false;
};

struct RigChoice : PatchChoice {     ///< the patch may be a CSV file of a rig's record instead
    std::filesystem::path matrix, out;
    int threads = 0;                  ///< 0: one per core
    bool keep_series = false;         ///< write what was measured as series.csv
};

int rig_verb(const RigChoice& choice);
int render_verb(const RenderChoice& choice);
int run_verb(const RunChoice& choice);
int view_verb(const TakeViewChoice& choice);
int set_verb(const SetChoice& choice);
int replay_verb(const ReplayChoice& choice);
int check_verb(const PatchChoice& choice);
int draw_verb(const PatchChoice& choice, const std::filesystem::path& out);
int nodes_verb(const std::string& type, bool json);
int calibrate_verb(const CalibrateChoice& choice);
int devices_verb(bool json);
int import_verb(const ImportChoice& choice);
int export_verb(const ExportChoice& choice);
int info_verb(const InfoChoice& choice);

int bench_engine_verb(const BenchChoice& choice);
int bench_contact_verb(const BenchChoice& choice);
int bench_view_verb(const BenchChoice& choice);
int bench_scrub_verb(const ScrubBenchChoice& choice);

/// Parses the command line and runs the verb.
int command_line(int argc, char** argv);

}  // namespace tactus
