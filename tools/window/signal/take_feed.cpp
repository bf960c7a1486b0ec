// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "engine/take/take_stream.hpp"
#include "tools/window/signal/feed.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

const ValueType* type_named(std::string_view name) {
    for (const ValueType* type : value::plain_types())
        if (type->name == name) return type;
    return nullptr;
}

/// Merges adjacent stretches.
std::vector<Range> joined(std::vector<Range> stretches) {
    std::ranges::sort(stretches, {}, &Range::low);
    std::vector<Range> whole;
    for (const Range& next : stretches) {
        if (!whole.empty() && next.low <= whole.back().high) whole.back().high = std::max(whole.back().high, next.high);
        else whole.push_back(next);
    }
    return whole;
}

}  // namespace

TakeFeed::TakeFeed(const take::Take& take) : take_(take) {
    take.require_values();
    std::set<std::string> files;
    for (const take::TakeStreamInfo& info : take.streams) {
        const ValueType* const type = type_named(info.type);
        if (!type) continue;  // large values are stored as hashes only
        if (take::channels_of(*type).size() != static_cast<std::size_t>(info.channels)) continue;
        streams_[info.port].push_back(&info);
        if (!files.insert(info.file).second) continue;
        const take::TakeStreamReader reader(take.folder / info.file, info);
        const double begin = seconds(info.start * info.period);
        recorded_.push_back({begin, seconds((info.start + reader.frames()) * info.period)});
    }
    recorded_ = joined(std::move(recorded_));
    if (!recorded_.empty()) {
        length_ = recorded_.back().high;
        now_ = recorded_.front().low;
    }
    for (auto& [port, infos] : streams_)
        std::ranges::sort(infos, {}, [](const auto* info) { return info->start * info->period; });
}

std::vector<Feed::Port> TakeFeed::ports() const {
    std::vector<Port> ports;
    for (const auto& [port, infos] : streams_)
        ports.push_back({port, type_named(infos.back()->type), rate_of(infos.back()->period)});
    return ports;
}

void TakeFeed::read(const std::string& port, double begin, double end, Trace& into) const {
    const auto found = streams_.find(port);
    if (found == streams_.end()) return;
    for (const take::TakeStreamInfo* info : found->second) {
        take::TakeStreamReader reader(take_.folder / info->file, *info);
        const double period = seconds(info->period);
        const auto first =
            std::max<std::int64_t>(info->start, static_cast<std::int64_t>(std::ceil(begin / period - 1e-9)));
        const auto wide = static_cast<std::size_t>(reader.channels());
        if (into.columns.empty()) {
            into.columns.resize(wide);
            into.names = take::channels_of(*type_named(info->type));
        }
        if (into.columns.size() != wide) continue;
        into.period = std::max(into.period, period);
        reader.seek(first);
        for (std::int64_t tick = first; static_cast<double>(tick) * period <= end + 1e-12; ++tick) {
            const double* frame = reader.frame(tick);
            if (!frame) break;
            into.times.push_back(static_cast<double>(tick) * period);
            for (std::size_t c = 0; c < wide; ++c) into.columns[c].push_back(frame[c]);
        }
    }
}

std::optional<TakeFeed::Peak> TakeFeed::largest(const std::string& port) const {
    const auto found = streams_.find(port);
    if (found == streams_.end()) return std::nullopt;
    std::optional<Peak> best;
    for (const take::TakeStreamInfo* info : found->second) {
        take::TakeStreamReader reader(take_.folder / info->file, *info);
        const std::size_t wide = std::min<std::size_t>(3, static_cast<std::size_t>(reader.channels()));
        reader.seek(info->start);
        for (std::int64_t tick = info->start;; ++tick) {
            const double* frame = reader.frame(tick);
            if (!frame) break;
            double sum = 0.0;
            for (std::size_t c = 0; c < wide; ++c) sum += frame[c] * frame[c];
            if (std::isfinite(sum) && (!best || std::sqrt(sum) > best->value))
                best = Peak{port, static_cast<double>(tick) * seconds(info->period), std::sqrt(sum)};
        }
    }
    return best;
}

void TakeFeed::follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) {
    if (latest_at_ != now_) latest_.clear();
    latest_at_ = now_;
    for (const std::string& port : looked_at) {
        const auto found = streams_.find(port);
        if (found == streams_.end() || latest_.contains(port)) continue;
        Trace last;
        read(port, now_ - 1.01 * seconds(found->second.back()->period), now_, last);
        Latest& latest = latest_[port];
        latest.count = last.times.empty() ? 0 : std::min(last.columns.size(), max_columns);
        for (std::size_t c = 0; c < latest.count; ++c) latest.columns[c] = last.columns[c].back();
    }
    std::erase_if(cuts_, [&](const auto& item) { return !traced.contains(item.first); });
    for (const std::string& port : traced) {
        Cut& cut = cuts_[port];
        const double begin = std::max(0.0, now_ - traced_s);
        if (cut.begin == begin && cut.end == now_) continue;
        extend(port, cut, begin);
        cut.begin = begin;
        cut.end = now_;
    }
}

/// Continues reading while time advances, and reopens after a jump.
void TakeFeed::extend(const std::string& port, Cut& cut, double begin) const {
    const bool goes_on = now_ > cut.end && begin >= cut.begin && begin < cut.end && !cut.trace.times.empty();
    if (!goes_on) cut.trace = {};
    const double half = 0.5 * seconds(streams_.contains(port) ? streams_.at(port).back()->period : 0);
    read(port, goes_on ? std::max(begin, cut.trace.times.back() + half) : begin, now_, cut.trace);
    forget(cut.trace, begin);
}

Feed::Latest TakeFeed::latest(const std::string& port) const {
    const auto found = latest_.find(port);
    return found == latest_.end() ? Latest{} : found->second;
}

const Trace* TakeFeed::trace(const std::string& port) const {
    const auto found = cuts_.find(port);
    return found == cuts_.end() ? nullptr : &found->second.trace;
}

}  // namespace tactus::window
