// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/record_reader.hpp"

#include "assets/file/extension.hpp"
#include "assets/sound/sound_reader.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/signal/filter/regularise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string_view>

namespace tactus::sound {

namespace {

constexpr std::size_t block_frames = 65536;

bool is_log(const std::filesystem::path& path) {
    const std::string extension = file::extension_of(path);
    for (const std::string_view recording : {".uff", ".unv", ".uf", ".58", ".bunv", ".mat"})
        if (extension == recording) return true;
    return extension == ".csv" || extension == ".tsv" || extension == ".txt" || extension == ".log" ||
           extension == ".lvm" || extension == ".asc" || extension == ".dat";
}

/// The first row of a log that is not before `time`, s.
std::size_t row_at(const table::PackedColumn& times, double time) {
    std::size_t low = 0, high = times.size();
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        if (times[middle] < time) low = middle + 1;
        else high = middle;
    }
    return low;
}

/// How many rows would fit into the steps that are longer than the median.
std::size_t rows_missing_in(const table::PackedColumn& times) {
    std::vector<double> steps(times.size());
    times.read(0, steps);
    std::adjacent_difference(steps.begin(), steps.end(), steps.begin());
    steps.erase(steps.begin());
    if (steps.empty()) return 0;
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    double missing = 0.0;
    if (*middle > 0.0)
        for (const double step : steps) missing += std::max(0.0, std::round(step / *middle) - 1.0);
    return static_cast<std::size_t>(std::min(missing, 1e15));
}

/// The rows without values that are lost samples: rows of another sensor between those of this one are none, as the steps
/// of time show.
std::size_t lost_between(const table::SampleLog& log) {
    return log.lost_rows > 0 && log.times.size() > 1 ? std::min(log.lost_rows, rows_missing_in(log.times))
                                                     : log.lost_rows;
}

/// Keeps the rows of a stretch; times stay as they are.
ReadStretch cut(table::SampleLog& log, const Stretch& stretch, const std::filesystem::path& path) {
    const auto rows = static_cast<double>(log.times.size());
    const double start = log.times.front(), span = log.times.back() - start;
    // Each row covers one time step.
    const double length = rows > 1.0 ? span * rows / (rows - 1.0) : 0.0;
    if (stretch.is_whole()) return {0.0, length, length};
    const ReadStretch read = stretch_within(stretch, length, length > 0.0 ? rows / length : 1.0, path);
    const std::size_t first = row_at(log.times, start + read.from),
                      end = read.to < length ? row_at(log.times, start + read.to) : log.times.size();
    if (first == end) throw Error(fmt::format("{}: there is no row from {}", path.string(), read.text()));
    log.times.cut(first, end);
    for (table::PackedColumn& column : log.columns) column.cut(first, end);
    log.lost_rows = lost_between(log);
    return read;
}

/// "Gal" of "acc [Gal]": what a bracket at the end of a name holds, where it has letters.
std::optional<std::string> bracket_of(const std::string& name) {
    const std::size_t open = name.find_last_of("[(");
    if (open == std::string::npos || open == 0 || (name.back() != ']' && name.back() != ')')) return std::nullopt;
    const std::string text = name.substr(open + 1, name.size() - open - 2);
    // "column 2" distinguishes columns of one name.
    if (text.starts_with("column ")) return std::nullopt;
    for (const char* const counts : {"count", "counts", "raw", "LSB", "lsb"})
        if (text == counts) return std::nullopt;
    return std::ranges::any_of(text, [](char c) { return std::isalpha(static_cast<unsigned char>(c)); })
               ? std::optional(text)
               : std::nullopt;
}

/// What the header of a log states for its columns: one calibration, and the factor of each column to its unit.
Calibration calibration_of_columns(const table::SampleLog& log, std::vector<double>& factors) {
    factors.assign(log.names.size(), 1.0);
    Calibration out;
    out.unit = "count";
    const auto& first = log.units.front();
    for (std::size_t i = 0; i < log.units.size(); ++i) {
        const auto& unit = log.units[i];
        if (unit.has_value() == first.has_value() && (!unit || unit->dimension == first->dimension)) continue;
        const auto text = [](const auto& u) { return u ? u->text : std::string("no unit"); };
        out.remark = fmt::format(
            "the columns have different units ('{}': {}, '{}': {}), which are not used; choose "
            "columns of one quantity with --column",
            log.names.front(), text(first), log.names[i], text(unit));
        return out;
    }
    if (!first) {
        if (const auto unknown = bracket_of(log.names.front()))
            out.remark = fmt::format(
                "'{}' in the name '{}' is no known unit and was not used; state what a value of 1 is with "
                "--calibration",
                *unknown, log.names.front());
        return out;
    }
    out = calibration_of(*first);
    out.source = "the header";
    for (std::size_t i = 0; i < log.units.size(); ++i) factors[i] = log.units[i]->si / first->si;
    return out;
}

/// What counts: the option, or what the file states.
Calibration counting(const std::optional<Calibration>& option, const Calibration& stated) {
    if (!option) return stated;
    Calibration out = *option;
    out.source = "the option";
    if (stated.known)
        out.remark = fmt::format("{} states {:.6g} {}; the option counts", stated.source, stated.factor, stated.unit);
    return out;
}

/// Counts the values at the ends of a converter of 16 bits, while all are whole numbers of it.
class LimitCount {
public:
    void push(std::span<const double> values) {
        for (const double x : values) {
            if (!is_whole_) return;
            is_whole_ = is_whole_ && x == std::round(x) && x <= 32768.0 && x >= -32768.0;
            count_ += x >= 32767.0 || x == -32768.0;
        }
    }
    std::size_t count() const { return is_whole_ ? count_ : 0; }

private:
    bool is_whole_ = true;
    std::size_t count_ = 0;
};

/// Calls use(values) for a column in blocks.
template <class Use>
void for_each_block(const table::PackedColumn& column, const Use& use) {
    std::vector<double> values;
    for (std::size_t first = 0; first < column.size(); first += block_frames) {
        values.resize(std::min(block_frames, column.size() - first));
        column.read(first, values);
        use(values);
    }
}

}  // namespace

bool LogFacts::is_even() const { return longest_step - shortest_step < 1e-3 * longest_step; }

std::vector<std::string> LogFacts::missing() const {
    std::vector<std::string> texts;
    if (gaps > 0)
        texts.push_back(fmt::format("the log has {} gap{}: samples of {} are missing", gaps, gaps == 1 ? "" : "s",
                                    readable(lost_seconds, "s", 4)));
    if (lost_rows > 0)
        texts.push_back(
            fmt::format("the log has {} row{} without a value, left out", lost_rows, lost_rows == 1 ? "" : "s"));
    return texts;
}

struct RecordReader::Source {
    std::filesystem::path path;
    std::optional<SoundReader> sound;
    table::SampleLog rows;  // of a log
    std::optional<signal::Regulariser> even;  // of those rows
    std::vector<std::vector<double>> open;  // its last block
    std::size_t at = 0;  // in that block
    bool after_gap = false;  // of that block
    std::size_t frames = 0;
    std::size_t first = 0, done = 0;  // of a sound: first frame of the stretch, frames read of it
    ReadStretch stretch;
    double rate = 0.0;
    std::vector<std::string> names;
    Calibration calibration;
    std::vector<double> factors;  // per channel
    std::optional<LogFacts> log;
    std::size_t block = 0;  // frames per read of a sound
    std::vector<double> interleaved;
};

RecordReader::RecordReader(const std::filesystem::path& path, const table::LogSelection& selection,
                           const std::optional<Calibration>& calibration, const std::optional<Sensitivity>& sensitivity,
                           const Stretch& stretch)
    : source_(std::make_unique<Source>()) {
    source_->path = path;
    if (!is_log(path)) {
        if (selection.rate)
            throw Error(
                fmt::format("{}: the rate of a sound is in the file; --sample-rate is for logs", path.string()));
        source_->sound.emplace(path);
        source_->rate = source_->sound->rate();
        source_->frames = source_->sound->frames();
        const double length = static_cast<double>(source_->frames) / source_->rate;
        source_->stretch = {0.0, length, length};
        if (!stretch.is_whole()) {
            source_->stretch = stretch_within(stretch, length, source_->rate, path);
            const auto frame_at = [&](double time) {
                return std::min(source_->frames, static_cast<std::size_t>(std::ceil(time * source_->rate - 1e-6)));
            };
            source_->first = frame_at(source_->stretch.from);
            source_->frames = frame_at(source_->stretch.to) - source_->first;
            if (source_->frames == 0)
                throw Error(fmt::format("{}: there is no sample from {}", path.string(), source_->stretch.text()));
            source_->sound->skip(source_->first);
        }
        for (std::size_t i = 1; i <= source_->sound->channels(); ++i) source_->names.push_back(std::to_string(i));
        source_->block = std::min(block_frames, source_->frames);
        source_->interleaved.resize(source_->block * source_->names.size());
        source_->calibration = stated_calibration(source_->sound->comment()).value_or(Calibration());
        source_->factors.assign(source_->names.size(), 1.0);
        calibrate(calibration, sensitivity);
        source_->calibration.file_note = source_->sound->note();
    } else {
        table::SampleLog& log = source_->rows = table::load_sample_log(path, selection);
        source_->stretch = cut(log, stretch, path);
        try {
            source_->even.emplace(
                signal::TimedSamples{log.times.size(), log.columns.size(),
                                     [&log](std::size_t first, std::span<double> out) { log.times.read(first, out); },
                                     [&log](std::size_t channel, std::size_t first, std::span<double> out) {
                                         log.columns[channel].read(first, out);
                                     }});
        } catch (const Error& error) {
            throw Error(fmt::format("{}: {}", path.string(), error.message()));
        }
        const signal::EvenFacts& even = source_->even->facts();
        source_->rate = even.rate;
        // Times that are computed from a rate give it back but for the last digits.
        if (selection.rate && even.gaps == 0 && log.lost_rows == 0) source_->rate = *selection.rate;
        source_->frames = even.frames;
        source_->names = log.names;
        source_->calibration = calibration_of_columns(log, source_->factors);
        const bool is_voltage = log.units.front() && log.units.front()->is_voltage();
        if (!sensitivity && !calibration && is_voltage && source_->calibration.known) calibrate_as_stated();
        else calibrate(calibration, sensitivity);
        source_->log = LogFacts{.rows = log.times.size(),
                                .lost_rows = log.lost_rows,
                                .gaps = even.gaps,
                                .lost_seconds = even.lost,
                                .shortest_step = even.shortest_step,
                                .longest_step = even.longest_step,
                                .step_deviation = even.step_deviation,
                                .clock_step = even.clock_step,
                                .levels = {},
                                .at_limit = {},
                                .form = log.form,
                                .usable = even.usable};
        const std::size_t missing = lost_between(log);
        const auto all_rows = static_cast<double>(log.times.size() + missing);
        const double read_seconds = static_cast<double>(even.frames) / even.rate;
        source_->log->lost_fraction =
            std::max(static_cast<double>(missing) / all_rows, even.lost / (read_seconds + even.lost));
        for (std::size_t c = 0; c < log.columns.size(); ++c) {
            signal::Level& level = source_->log->levels.emplace_back();
            LimitCount at_limit;
            for_each_block(log.columns[c], [&](std::vector<double>& values) {
                at_limit.push(values);
                for (double& x : values) x *= source_->factors[c];
                level.push(values);
            });
            source_->log->at_limit.push_back(at_limit.count());
        }
    }
}

void RecordReader::calibrate(const std::optional<Calibration>& option, const std::optional<Sensitivity>& sensitivity) {
    Calibration& used = source_->calibration;
    // An option is for all columns alike.
    if (option) source_->factors.assign(source_->factors.size(), 1.0);
    used = counting(option, used);
    if (sensitivity) {
        try {
            used = through_sensor(used, *sensitivity);
        } catch (const Error& error) {
            throw Error(fmt::format("{}: {}", source_->path.string(), error.message()));
        }
    }
    for (double& factor : source_->factors) factor *= used.factor;
}

void RecordReader::calibrate_as_stated() {
    const table::AssignedSensitivities& stated = source_->rows.sensitivities;
    const std::string file = source_->path.string();
    if (!stated.doubt.empty()) throw Error(fmt::format("{}: {}", file, stated.doubt));
    if (stated.of_columns.empty()) return calibrate(std::nullopt, std::nullopt);
    std::vector<Sensitivity> sensors;
    for (const table::StatedSensitivity& one : stated.of_columns) {
        try {
            sensors.push_back(parse_sensitivity(one.text));
        } catch (const Error& error) {
            throw Error(SourceLocation{file, one.line, 1},
                        fmt::format("the sensitivity '{}' is not understood: {}", one.text, error.message()));
        }
    }
    const Sensitivity& first = sensors.front();
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Sensitivity& sensor = sensors[i];
        texts.push_back(sensor.text);
        if (sensor.unit.dimension != first.unit.dimension)
            throw Error(SourceLocation{file, stated.of_columns[i].line, 1},
                        fmt::format("the sensors of '{}' ({}) and '{}' ({}) measure different quantities; choose "
                                    "columns of one quantity with --column",
                                    source_->names.front(), first.text, source_->names[i], sensor.text));
        source_->factors[i] *= first.volts / first.unit.si / sensor.volts * sensor.unit.si;
    }
    calibrate(std::nullopt, first);
    if (std::ranges::any_of(texts, [&](const std::string& text) { return text != first.text; })) {
        std::string list;
        for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + text;
        source_->calibration.source = "the header and the sensitivities " + list;
    }
}

RecordReader::~RecordReader() = default;
RecordReader::RecordReader(RecordReader&&) noexcept = default;

double RecordReader::rate() const noexcept { return source_->rate; }
std::size_t RecordReader::frames() const noexcept { return source_->frames; }
const std::vector<std::string>& RecordReader::channels() const noexcept { return source_->names; }
const Calibration& RecordReader::calibration() const noexcept { return source_->calibration; }
const std::optional<LogFacts>& RecordReader::log() const noexcept { return source_->log; }
const ReadStretch& RecordReader::stretch() const noexcept { return source_->stretch; }

void RecordReader::rewind() {
    if (source_->sound) {
        source_->sound.emplace(source_->path);
        source_->sound->skip(source_->first);
    }
    if (source_->even) source_->even->rewind();
    source_->open.clear();
    source_->at = source_->done = 0;
}

bool RecordReader::next(RecordBlock& block) {
    Source& source = *source_;
    const std::size_t channels = source.names.size();
    block.channels.resize(channels);
    block.after_gap = false;
    if (source.sound) {
        const std::size_t wanted = std::min(source.block, source.frames - source.done);
        // The read after the last frame is where a sound that is cut short is noticed.
        if (wanted == 0 && !source.stretch.is_whole()) return false;
        const std::size_t count = source.sound->read(source.interleaved.data(), std::max<std::size_t>(1, wanted));
        source.done += count;
        for (std::size_t c = 0; c < channels; ++c) {
            block.channels[c].resize(count);
            for (std::size_t i = 0; i < count; ++i)
                block.channels[c][i] = source.factors[c] * source.interleaved[i * channels + c];
        }
        return count > 0;
    }
    const auto left = [&] { return source.open.empty() ? 0 : source.open.front().size() - source.at; };
    if (left() == 0) {
        if (!source.even->next(source.open, source.after_gap)) return false;
        source.at = 0;
        block.after_gap = source.after_gap;
    }
    const std::size_t count = std::min(block_frames, left());
    for (std::size_t c = 0; c < channels; ++c) {
        const auto begin = source.open[c].begin() + static_cast<std::ptrdiff_t>(source.at);
        block.channels[c].assign(begin, begin + static_cast<std::ptrdiff_t>(count));
        for (double& x : block.channels[c]) x *= source.factors[c];
    }
    source.at += count;
    return true;
}

}  // namespace tactus::sound
