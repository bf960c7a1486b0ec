// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/port_values.hpp"

#include "dsp/core/error.hpp"
#include "engine/io/streams.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/take/take_reader.hpp"
#include "engine/take/take_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace tactus::analysis {

using experiment::Measure;
using experiment::Window;

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// "hand.pose.pz" → "hand.pose", "pz"; the channel is empty when none is named.
std::pair<std::string, std::string> port_and_channel(const std::string& name) {
    const std::size_t first = name.find('.'), second = name.find('.', first + 1);
    if (second == std::string::npos) return {name, {}};
    return {name.substr(0, second), name.substr(second + 1)};
}

/// Index of a channel among those of a port's type. Throws Error.
std::size_t channel_index(const std::string& name, const std::vector<std::string>& channels) {
    const std::string channel = port_and_channel(name).second;
    if (channel.empty()) {
        if (channels.size() == 1) return 0;
        std::string list;
        for (const std::string& one : channels) list += (list.empty() ? "" : ", ") + one;
        throw Error(
            fmt::format("'{}' has several channels; name one of {}: '{}.{}'", name, list, name, channels.front()));
    }
    const auto at = std::ranges::find(channels, channel);
    if (at == channels.end())
        throw Error(fmt::format("'{}' has no channel '{}'{}", port_and_channel(name).first, channel,
                                did_you_mean(channel, channels)));
    return static_cast<std::size_t>(at - channels.begin());
}

/// Puts the value of an activation in its place; activations that never ran repeat the value before them, as a take does.
void put(std::vector<double>& values, std::int64_t activation, double value) {
    const auto place = static_cast<std::size_t>(activation);
    if (values.size() < place) values.resize(place, values.empty() ? 0.0 : values.back());
    if (values.size() == place) values.push_back(value);
}

struct Tapped {
    PortSeries* series;
    const ValueType* type;
    std::size_t offset, channel;
    std::atomic<bool>* over;  ///< set when the value becomes true; null: by none
    std::atomic<int>* presses;  ///< counts how often it becomes true; null: by none
    bool was_true = true;  // held from the beginning is no press
};

class SeriesSink : public io::Sink {
public:
    SeriesSink(std::vector<Tapped> taps, std::size_t frame_bytes) : taps_(std::move(taps)), frame_bytes_(frame_bytes) {}

    void take(std::int64_t first, const std::byte* frames, std::size_t count) override {
        for (std::size_t i = 0; i < count; ++i)
            for (Tapped& tap : taps_) {
                take::to_frame(*tap.type, frames + i * frame_bytes_ + tap.offset, frame_.data());
                put(tap.series->values, first + static_cast<std::int64_t>(i), frame_[tap.channel]);
                const bool is_true = frame_[tap.channel] > 0.5;
                if (tap.over && is_true) *tap.over = true;
                if (tap.presses && is_true && !tap.was_true) ++*tap.presses;
                tap.was_true = is_true;
            }
    }
    void finish() override {}

private:
    std::vector<Tapped> taps_;
    std::size_t frame_bytes_;
    std::array<double, 16> frame_{};
};

std::vector<std::string> channels_of_type(std::string_view name) {
    for (const ValueType* type :
         {&value::pose, &value::twist, &value::wrench, &value::vector, &value::number, &value::boolean, &value::signal})
        if (type->name == name) return take::channels_of(*type);
    return {};
}

bool is_plain(const ValueType& type) { return !channels_of_type(type.name).empty(); }

const PortSeries& series_of(const PortValues& values, const std::string& port) {
    const auto found = values.find(port);
    if (found == values.end()) throw Error(fmt::format("'{}' was not collected", port));
    return found->second;
}

/// First and one past the last tick of a window.
std::pair<std::size_t, std::size_t> range_of(const PortSeries& series, const std::optional<Window>& window) {
    if (!window) return {0, series.values.size()};
    const auto tick = [&](double t) {
        return std::min(series.values.size(), static_cast<std::size_t>(std::llround(t / series.period)));
    };
    return {tick(window->begin), tick(window->end)};
}

/// Value of another series at the time of a tick of the first.
double at_tick(const PortSeries& other, const PortSeries& base, std::size_t tick) {
    if (other.values.empty()) return 0.0;
    const auto place = static_cast<std::size_t>(static_cast<double>(tick) * base.period / other.period + 1e-6);
    return other.values[std::min(place, other.values.size() - 1)];
}

double slope_of(const PortSeries& y, const PortSeries& x, std::pair<std::size_t, std::size_t> range) {
    double peak = 0.0;
    for (std::size_t i = range.first; i < range.second; ++i) peak = std::max(peak, std::abs(y.values[i]));
    if (!(peak > 0.0)) return nothing;
    double n = 0.0, mean_x = 0.0, mean_y = 0.0;
    const auto each = [&](auto&& use) {
        for (std::size_t i = range.first; i < range.second; ++i)
            if (std::abs(y.values[i]) > 0.02 * peak) use(at_tick(x, y, i), y.values[i]);
    };
    each([&](double a, double b) {
        n += 1.0;
        mean_x += a;
        mean_y += b;
    });
    mean_x /= n;
    mean_y /= n;
    double xx = 0.0, xy = 0.0;
    each([&](double a, double b) {
        xx += (a - mean_x) * (a - mean_x);
        xy += (a - mean_x) * (b - mean_y);
    });
    return xx > 0.0 ? xy / xx : nothing;
}

/// Shift with the largest correlation, up to 0.5 s, refined by a parabola.
double lag_of(const PortSeries& y, const PortSeries& x, std::pair<std::size_t, std::size_t> range) {
    const std::size_t count = range.second - range.first;
    const auto max_shift = std::min(static_cast<std::size_t>(std::llround(0.5 / y.period)), count / 2);
    if (max_shift < 2) return nothing;
    const std::size_t begin = range.first + max_shift;
    const auto correlation = [&](std::size_t shift) {
        double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0, sxy = 0.0;
        for (std::size_t i = begin; i < range.second; ++i) {
            const double a = at_tick(x, y, i - shift), b = y.values[i];
            n += 1.0;
            sx += a;
            sy += b;
            sxx += a * a;
            syy += b * b;
            sxy += a * b;
        }
        const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n;
        return vx > 0.0 && vy > 0.0 ? (sxy - sx * sy / n) / std::sqrt(vx * vy) : -2.0;
    };
    std::vector<double> all;
    for (std::size_t shift = 0; shift <= max_shift; ++shift) all.push_back(correlation(shift));
    const auto best = static_cast<std::size_t>(std::ranges::max_element(all) - all.begin());
    if (all[best] < -1.0) return nothing;
    double refined = static_cast<double>(best);
    if (best > 0 && best < max_shift) {
        const double curvature = all[best - 1] - 2.0 * all[best] + all[best + 1];
        if (curvature < 0.0) refined += 0.5 * (all[best - 1] - all[best + 1]) / curvature;
    }
    return refined * y.period;
}

}  // namespace

std::set<std::string> ports_of(const experiment::Protocol& protocol, std::size_t task) {
    std::set<std::string> ports;
    const auto add = [&](const Measure& measure) {
        for (const std::string& port : {measure.port, measure.other, measure.when})
            if (!port.empty()) ports.insert(port);
    };
    if (protocol.is_psychophysics()) {
        add(protocol.stimulus->measure);
        ports.insert(protocol.response.ports.begin(), protocol.response.ports.end());
    } else {
        for (const Measure& measure : protocol.tasks[task].measures) add(measure);
        if (!protocol.tasks[task].done.empty()) ports.insert(protocol.tasks[task].done);
    }
    return ports;
}

void check_ports(const compile::Schedule& schedule, const std::set<std::string>& ports) {
    for (const std::string& name : ports) {
        const std::string port = port_and_channel(name).first;
        const ValueType* type = nullptr;
        for (const compile::ScheduleNode& node : schedule.nodes)
            for (const compile::ScheduleOutput& output : node.outputs)
                if (node.name + "." + output.name == port) type = output.port->type;
        if (!type) throw Error(fmt::format("the patch has no output '{}'", port));
        if (!is_plain(*type)) throw Error(fmt::format("'{}' is a {}: a measure needs numbers", port, type->name));
        (void)channel_index(name, take::channels_of(*type));
    }
}

PortCollector::PortCollector(const std::set<std::string>& ports, std::string done,
                             const std::vector<std::string>& pressed)
    : done_(std::move(done)) {
    for (const std::string& port : ports) entries_.emplace(port, Entry{});
    for (const std::string& port : pressed) presses_[port] = 0;
}

int PortCollector::take_presses(const std::string& port) {
    const auto found = presses_.find(port);
    return found == presses_.end() ? 0 : found->second.exchange(0);
}

run::TapMaker PortCollector::tap() {
    return [this](const io::FrameLayout& layout, const run::GroupRuntime& group) -> std::unique_ptr<io::Sink> {
        std::vector<Tapped> taps;
        for (auto& [name, entry] : entries_)
            for (const io::FrameColumn& column : layout.columns) {
                if (column.port != port_and_channel(name).first) continue;
                if (!is_plain(*column.type)) {
                    problems_[name] = fmt::format("'{}' is a {}: a measure needs numbers", name, column.type->name);
                    continue;
                }
                try {
                    const std::size_t channel = channel_index(name, take::channels_of(*column.type));
                    entry.is_found = true;
                    entry.series.period = seconds(group.plan->period);
                    const auto presses = presses_.find(name);
                    taps.push_back({&entry.series, column.type, column.offset, channel,
                                    name == done_ ? &over_ : nullptr,
                                    presses == presses_.end() ? nullptr : &presses->second});
                } catch (const Error& error) {
                    problems_[name] = error.message();
                }
            }
        if (taps.empty()) return nullptr;
        return std::make_unique<SeriesSink>(std::move(taps), layout.bytes);
    };
}

PortValues PortCollector::values() const {
    PortValues values;
    for (const auto& [name, entry] : entries_) {
        if (const auto problem = problems_.find(name); problem != problems_.end()) throw Error(problem->second);
        if (!entry.is_found) throw Error(fmt::format("the patch has no output '{}'", port_and_channel(name).first));
        values.emplace(name, entry.series);
    }
    return values;
}

void SteppedPorts::watch() {
    for (const std::string& name : ports_) observer_.watch(port_and_channel(name).first, observe::Watch::every, this);
}

void SteppedPorts::fetch() {
    observer_.advance();
    // Several names may be channels of one port.
    std::map<std::string, observe::SeenValues> seen;
    for (const std::string& name : ports_) {
        const std::string port = port_and_channel(name).first;
        if (!seen.contains(port)) observer_.fetch(port, seen[port]);
    }
    const std::vector<observe::Observer::Port> known = observer_.ports();
    for (const std::string& name : ports_) {
        const std::string port = port_and_channel(name).first;
        const auto info = std::ranges::find(known, port, &observe::Observer::Port::name);
        if (info == known.end()) throw Error(fmt::format("the patch has no output '{}'", port));
        const std::size_t channel = channel_index(name, take::channels_of(*info->type));
        PortSeries& series = values_[name];
        series.period = seconds(info->period);
        const observe::SeenValues& fetched = seen[port];
        for (std::size_t i = 0; i < fetched.when.size(); ++i)
            put(series.values, fetched.when[i] / info->period, fetched.columns[i * fetched.per_value + channel]);
    }
}

PortValues port_values_of(const std::filesystem::path& folder, const std::set<std::string>& ports) {
    const take::Take taken = take::Take::load(folder);
    taken.require_values();
    PortValues values;
    for (const std::string& name : ports) {
        const auto info = std::ranges::find(taken.streams, port_and_channel(name).first, &take::TakeStreamInfo::port);
        if (info == taken.streams.end())
            throw Error(fmt::format("{}: the take has no output '{}'", folder.string(), port_and_channel(name).first));
        const std::size_t channel = channel_index(name, channels_of_type(info->type));
        take::TakeStreamReader reader(folder / info->file, *info);
        PortSeries series;
        series.period = seconds(info->period);
        for (std::int64_t tick = info->start; const double* frame = reader.frame(tick); ++tick)
            put(series.values, tick, frame[channel]);
        values.emplace(name, std::move(series));
    }
    return values;
}

namespace {

/// Where an interval of a repeated presentation showed the level of an adjustment that holds from `since` to `end`: the last time
/// that it did for at least half of its duration, or else its longest part. Empty: nowhere.
Window last_presentation(const Window& window, double period, double since, double end) {
    Window best;
    for (int round = 0; round * period + window.begin < end; ++round) {
        const Window part{std::max(round * period + window.begin, since), std::min(round * period + window.end, end)};
        const double duration = part.end - part.begin;
        if (duration > 0.0 && (duration >= 0.5 * (window.end - window.begin) || duration > best.end - best.begin))
            best = part;
    }
    return best;
}

}  // namespace

std::vector<double> rendered_of(const experiment::Protocol& protocol, const experiment::TrialRecord& trial,
                                const PortValues& values) {
    constexpr double settled = 0.05;  // s, after a parameter was set
    const double since = trial.turns.empty() ? 0.0 : trial.turns.back().time + settled;
    std::vector<double> rendered;
    for (const Window& window : protocol.stimulus->windows)
        rendered.push_back(measure_of(
            protocol.stimulus->measure, values,
            protocol.is_adjustment() ? last_presentation(window, protocol.length, since, trial.seconds) : window));
    return rendered;
}

double measure_of(const Measure& measure, const PortValues& values, const std::optional<Window>& window) {
    const PortSeries& series = series_of(values, measure.port);
    const auto range = range_of(series, window);
    if (range.first >= range.second) return nothing;
    const PortSeries* when = measure.when.empty() ? nullptr : &series_of(values, measure.when);
    const auto span = std::span(series.values).subspan(range.first, range.second - range.first);
    using Kind = Measure::Kind;
    double result = nothing;
    switch (measure.kind) {
        case Kind::mean:
        case Kind::rms:
        case Kind::peak: {
            double n = 0.0, sum = 0.0, peak = 0.0;
            for (std::size_t i = range.first; i < range.second; ++i) {
                if (when && at_tick(*when, series, i) < 0.5) continue;
                const double value = series.values[i];
                n += 1.0;
                sum += measure.kind == Kind::rms ? value * value : value;
                peak = std::max(peak, std::abs(value));
            }
            if (n > 0.0)
                result = measure.kind == Kind::peak ? peak : measure.kind == Kind::rms ? std::sqrt(sum / n) : sum / n;
            break;
        }
        case Kind::last: result = span.back(); break;
        case Kind::slope: result = slope_of(series, series_of(values, measure.other), range); break;
        case Kind::lag: result = lag_of(series, series_of(values, measure.other), range); break;
        case Kind::at_press: {
            double n = 0.0, sum = 0.0;
            for (std::size_t i = std::max<std::size_t>(range.first, 1); i < range.second; ++i)
                if (at_tick(*when, series, i) > 0.5 && at_tick(*when, series, i - 1) < 0.5) {
                    // What was there when the person decided: the press itself may change it in the same tick.
                    sum += series.values[i - 1];
                    n += 1.0;
                }
            if (n > 0.0) result = sum / n;
            break;
        }
        case Kind::until:
            for (std::size_t i = range.first; i < range.second && std::isnan(result); ++i)
                if (series.values[i] > 0.5) result = static_cast<double>(i - range.first) * series.period;
            break;
    }
    return result * measure.scale;
}

}  // namespace tactus::analysis
