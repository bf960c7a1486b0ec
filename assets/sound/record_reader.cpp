// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/record_reader.hpp"

#include "assets/sound/sound_reader.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "dsp/signal/filter/regularise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tactus::sound {

namespace {

constexpr std::size_t block_frames = 65536;

bool is_log(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension == ".csv" || extension == ".tsv" || extension == ".txt" || extension == ".log";
}

/// Values at the ends of a converter of 16 bits, when all are whole numbers of it.
std::size_t rows_at_limit(std::span<const double> values) {
    std::size_t count = 0;
    for (const double x : values) {
        if (x != std::round(x) || x > 32768.0 || x < -32768.0) return 0;
        count += x >= 32767.0 || x == -32768.0;
    }
    return count;
}

}  // namespace

Calibration parse_calibration(const std::string& text) {
    const std::size_t unit = text.find_first_not_of("+-0123456789.eE \t");
    Calibration out;
    try {
        const Quantity quantity = parse_quantity(text);
        out.unit = unit == std::string::npos ? "" : text.substr(unit);
        out.si = out.unit.empty() ? 1.0 : parse_unit(out.unit).factor;
        out.factor = quantity.value / out.si;
        out.is_acceleration = quantity.dimension == parse_unit("m/s^2").dimension;
    } catch (const Error& error) {
        throw Error(fmt::format("a calibration must be a quantity such as \"9.81 m/s^2\": {}", error.message()));
    }
    if (out.unit.empty() || !(std::abs(out.factor) > 0.0) || !std::isfinite(out.factor))
        throw Error(fmt::format(
            "a calibration must be a quantity other than 0 with its unit, such as \"9.81 m/s^2\", not '{}'", text));
    out.known = true;
    return out;
}

struct RecordReader::Source {
    std::filesystem::path path;
    std::optional<SoundReader> sound;
    signal::EvenRecord even;
    std::size_t piece = 0, at = 0, frames = 0;
    double rate = 0.0;
    std::vector<std::string> names;
    Calibration calibration;
    std::optional<LogFacts> log;
    std::size_t block = 0;  // frames per read of a sound
    std::vector<double> interleaved;
};

RecordReader::RecordReader(const std::filesystem::path& path, const table::LogSelection& selection,
                           const std::optional<Calibration>& calibration)
    : source_(std::make_unique<Source>()) {
    source_->path = path;
    if (!is_log(path)) {
        source_->sound.emplace(path);
        source_->rate = source_->sound->rate();
        source_->frames = source_->sound->frames();
        for (std::size_t i = 1; i <= source_->sound->channels(); ++i) source_->names.push_back(std::to_string(i));
        source_->block = std::min(block_frames, source_->frames);
        source_->interleaved.resize(source_->block * source_->names.size());
    } else {
        const table::SampleLog log = table::load_sample_log(path, selection);
        try {
            source_->even = signal::regularise(log.times, log.columns);
        } catch (const Error& error) {
            throw Error(fmt::format("{}: {}", path.string(), error.message()));
        }
        const signal::EvenRecord& even = source_->even;
        source_->rate = even.rate;
        for (const auto& piece : even.pieces) source_->frames += piece.front().size();
        source_->names = log.names;
        source_->calibration.unit = "count";
        source_->log = LogFacts{.rows = log.times.size(),
                                .lost_rows = log.lost_rows,
                                .gaps = even.gaps,
                                .lost_seconds = even.lost,
                                .shortest_step = even.shortest_step,
                                .longest_step = even.longest_step,
                                .levels = {},
                                .at_limit = {},
                                .usable = even.usable};
        for (const std::vector<double>& column : log.columns) {
            std::vector<double> scaled = column;
            for (double& x : scaled) x *= calibration ? calibration->factor : 1.0;
            source_->log->levels.emplace_back().push(scaled);
            source_->log->at_limit.push_back(rows_at_limit(column));
        }
    }
    if (calibration) source_->calibration = *calibration;
}

RecordReader::~RecordReader() = default;
RecordReader::RecordReader(RecordReader&&) noexcept = default;

double RecordReader::rate() const noexcept { return source_->rate; }
std::size_t RecordReader::frames() const noexcept { return source_->frames; }
const std::vector<std::string>& RecordReader::channels() const noexcept { return source_->names; }
const Calibration& RecordReader::calibration() const noexcept { return source_->calibration; }
const std::optional<LogFacts>& RecordReader::log() const noexcept { return source_->log; }

void RecordReader::rewind() {
    if (source_->sound) source_->sound.emplace(source_->path);
    source_->piece = source_->at = 0;
}

bool RecordReader::next(RecordBlock& block) {
    Source& source = *source_;
    const std::size_t channels = source.names.size();
    const double factor = source.calibration.factor;
    block.channels.resize(channels);
    block.after_gap = false;
    if (source.sound) {
        const std::size_t count = source.sound->read(source.interleaved.data(), source.block);
        for (std::size_t c = 0; c < channels; ++c) {
            block.channels[c].resize(count);
            for (std::size_t i = 0; i < count; ++i)
                block.channels[c][i] = factor * source.interleaved[i * channels + c];
        }
        return count > 0;
    }
    if (source.piece == source.even.pieces.size()) return false;
    const auto& piece = source.even.pieces[source.piece];
    const std::size_t count = std::min(block_frames, piece.front().size() - source.at);
    block.after_gap = source.at == 0 && source.piece > 0;
    for (std::size_t c = 0; c < channels; ++c) {
        const auto begin = piece[c].begin() + static_cast<std::ptrdiff_t>(source.at);
        block.channels[c].assign(begin, begin + static_cast<std::ptrdiff_t>(count));
        for (double& x : block.channels[c]) x *= factor;
    }
    source.at += count;
    if (source.at == piece.front().size()) ++source.piece, source.at = 0;
    return true;
}

}  // namespace tactus::sound
