// SPDX-License-Identifier: Apache-2.0
#include "assets/table/recording.hpp"

#include "assets/table/log_columns.hpp"
#include "assets/table/log_shape.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <span>

namespace tactus::table {

namespace {

constexpr std::size_t max_unit_steps = 1'000'000;  // of which the mean is taken to find a unit

std::optional<std::size_t> channel_named(const std::vector<RecordedChannel>& channels, const std::string& wanted) {
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].name == wanted || parse_column_name(channels[i].name).name == wanted) return i;
    std::size_t number = 0;
    const auto [end, failure] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    const bool is_number = failure == std::errc{} && end == wanted.data() + wanted.size();
    return is_number && number >= 1 && number <= channels.size() ? std::optional(number - 1) : std::nullopt;
}

/// The same with a name in each of its columns: lists are taken apart.
LogSelection with_single_names(const LogSelection& selection, const std::vector<RecordedChannel>& channels) {
    const auto is_name = [&](std::string_view name) {
        return std::ranges::any_of(channels, [&](const RecordedChannel& channel) {
            return channel.name == name || parse_column_name(channel.name).name == name;
        });
    };
    const auto names_of = [&](const std::string& text) {
        std::vector<std::string> names = names_in(text, is_name);
        if (selection.list_entry && names.size() > 2)
            throw Error(fmt::format("'{}': at most two columns, as REFERENCE,OUTPUT", text));
        if (selection.list_entry) names = {names[std::min(*selection.list_entry, names.size() - 1)]};
        return names;
    };
    LogSelection single = selection;
    single.columns.clear();
    for (const std::string& text : selection.columns)
        for (std::string& name : names_of(text)) single.columns.push_back(std::move(name));
    if (!selection.time_column.empty())
        if (const std::vector<std::string> names = names_of(selection.time_column); names.size() == 1)
            single.time_column = names.front();
    single.list_entry.reset();
    return single;
}

/// The group of the chosen channels, or that with a column of times, or the only one.
std::size_t group_of(const Recording& recording, const std::string& file, const LogSelection& selection) {
    const std::vector<RecordedChannel>& channels = recording.channels;
    for (const std::string& wanted : selection.columns)
        if (const auto found = channel_named(channels, wanted)) return channels[*found].group;
    if (!selection.time_column.empty())
        if (const auto found = channel_named(channels, selection.time_column)) return channels[*found].group;
    std::set<std::size_t> groups, with_time;
    for (const RecordedChannel& channel : channels) {
        groups.insert(channel.group);
        if (is_time_name(parse_column_name(channel.name).name)) with_time.insert(channel.group);
    }
    if (groups.size() == 1) return *groups.begin();
    if (with_time.size() == 1) return *with_time.begin();
    std::vector<std::string> names;
    for (const RecordedChannel& channel : channels)
        names.push_back(channel.rate > 0.0 ? fmt::format("{} ({:.6g} Hz, {} samples)", channel.name, channel.rate,
                                                         channel.values.size())
                                           : fmt::format("{} ({} samples)", channel.name, channel.values.size()));
    if (names.size() > 20) names.resize(20), names.emplace_back("...");
    throw Error(
        fmt::format("{}: its channels have different clocks or lengths; choose one, or several of one clock, with "
                    "--column: {}",
                    file, fmt::join(names, ", ")));
}

}  // namespace

SampleLog log_of_recording(const Recording& recording, const std::string& file, const LogSelection& given) {
    const LogSelection selection = with_single_names(given, recording.channels);
    const std::size_t group = group_of(recording, file, selection);
    std::vector<const RecordedChannel*> channels;
    LogShape shape;
    shape.separator = '\0';
    shape.header_line = 1;
    shape.has_lines = false;
    for (const RecordedChannel& channel : recording.channels) {
        if (channel.group != group) continue;
        channels.push_back(&channel);
        shape.names.push_back(channel.name);
        shape.units.push_back(channel.unit);
        shape.kinds.push_back(CellKind::number);
        if (channel.rate > 0.0) shape.rate = {channel.rate, 0, {}};
    }
    // Numbers of columns count all channels of the file.
    LogSelection named = selection;
    const auto to_name = [&](std::string& wanted) {
        if (const auto found = channel_named(recording.channels, wanted);
            found && recording.channels[*found].group == group)
            wanted = recording.channels[*found].name;
    };
    for (std::string& wanted : named.columns) to_name(wanted);
    if (!named.time_column.empty()) to_name(named.time_column);
    LogColumns columns = choose_log_columns(shape, {}, file, named);
    SampleLog log;
    log.form.format = recording.format;
    for (const std::size_t column : columns.values) {
        log.names.push_back(columns.named[column].name);
        log.units.push_back(columns.named[column].unit);
    }
    log.columns.resize(columns.values.size());
    if (columns.time) log.time_name = shape.names[*columns.time];
    std::optional<double> wanted;
    if (columns.where) {
        double number = 0.0;
        const std::string& text = columns.wanted;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (failure != std::errc{} || end != text.data() + text.size())
            throw Error(fmt::format("{}: --where needs a number here, not '{}'", file, text));
        wanted = number;
    }
    // Times of dates have more digits than their differences need.
    double origin = 0.0, last = 0.0;
    std::size_t row = 0;
    const std::size_t rows = channels.front()->values.size();
    for (std::size_t n = 0; n < rows; ++n) {
        if (wanted && channels[*columns.where]->values[n] != *wanted) continue;
        const double place = static_cast<double>(row++);
        const double time = columns.time ? channels[*columns.time]->values[n] : place;
        bool is_lost = !std::isfinite(time);
        for (const std::size_t column : columns.values)
            is_lost = is_lost || !std::isfinite(channels[column]->values[n]);
        if (is_lost) {
            ++log.lost_rows;
            continue;
        }
        if (log.times.empty() && columns.time && std::abs(time) >= 1e9) origin = std::floor(time);
        if (!log.times.empty() && time < last)
            throw Error(fmt::format("{}: time runs backwards in '{}', from {:.9g} to {:.9g} at sample {}", file,
                                    log.time_name, last, time, n + 1));
        last = time;
        log.times.push_back(time - origin);
        for (std::size_t i = 0; i < columns.values.size(); ++i)
            log.columns[i].push_back(channels[columns.values[i]]->values[n]);
    }
    if (log.times.empty()) throw Error(fmt::format("{}: there is no row with a number in every chosen column", file));
    if (!columns.time) {
        log.times.scale(1.0, columns.rate);
        log.form.time = fmt::format("{:.6g} Hz, as {} states", columns.rate,
                                    selection.rate ? "--sample-rate" : recording.rate_place);
        return log;
    }
    std::string reason;
    if (!columns.unit) {
        std::vector<double> first(std::min(log.times.size(), max_unit_steps));
        log.times.read(0, first);
        SettledTimeUnit settled =
            settle_time_unit(first, origin, shape.rate ? shape.rate->value : 0.0, recording.rate_place, log.time_name,
                             [&](const std::string& message) { throw Error(fmt::format("{}: {}", file, message)); });
        columns.unit = settled.unit;
        reason = settled.reason;
    }
    log.times.scale(columns.unit->seconds);
    log.form.is_time_unit_stated = reason.empty();
    log.form.time = fmt::format("'{}' in {}{}", log.time_name, columns.unit->symbol,
                                reason.empty() ? "" : fmt::format(" ({})", reason));
    return log;
}

}  // namespace tactus::table
