// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_stream.hpp"
#include "tools/window/signal/feed.hpp"

#include <algorithm>

namespace tactus::window {

namespace {

template <class T>
Feed::Latest as_columns(const std::optional<observe::Seen<T>>& seen, const ValueType& type) {
    Feed::Latest latest;
    if (!seen || type.columns.size() > Feed::max_columns) return latest;
    type.to_columns(&seen->value, latest.columns.data());
    latest.count = type.columns.size();
    return latest;
}

}  // namespace

bool follows_gap(const Trace& trace, std::size_t row) {
    return row > 0 && row < trace.times.size() && trace.period > 0.0 &&
           trace.times[row] - trace.times[row - 1] > 1.5 * trace.period;
}

void forget(Trace& trace, double before) {
    const auto first = std::ranges::lower_bound(trace.times, before) - trace.times.begin();
    if (first < static_cast<std::ptrdiff_t>(trace.times.size()) / 4) return;
    trace.times.erase(trace.times.begin(), trace.times.begin() + first);
    for (auto& column : trace.columns) column.erase(column.begin(), column.begin() + first);
}

std::vector<Feed::Port> LiveFeed::ports() const {
    std::vector<Port> ports;
    for (const observe::Observer::Port& port : observer_->ports())
        if (!port.type->columns.empty() && port.type->to_columns)
            ports.push_back({port.name, port.type, rate_of(port.period)});
    return ports;
}

void LiveFeed::follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) {
    for (const std::string& port : watched_)
        if (!looked_at.contains(port) && !traced.contains(port)) observer_->watch(port, observe::Watch::nothing, this);
    std::set<std::string> watched = traced;
    for (const std::string& port : looked_at) {
        if (traced.contains(port)) continue;
        if (!watched_.contains(port) || traces_.contains(port)) observer_->watch(port, observe::Watch::latest, this);
        watched.insert(port);
    }
    for (const std::string& port : traced)
        if (!traces_.contains(port)) {
            observer_->watch(port, observe::Watch::every, this);
            traces_[port];
        }
    std::erase_if(traces_, [&](const auto& item) { return !traced.contains(item.first); });
    watched_ = std::move(watched);
    observer_->advance();
    if (listed_ != observer_->ports_version()) {
        listed_ = observer_->ports_version();
        known_.clear();
        for (const observe::Observer::Port& port : observer_->ports()) known_.emplace(port.name, port);
    }
    for (auto& [port, trace] : traces_) {
        observe::SeenValues values;
        if (!observer_->fetch(port, values)) continue;
        const std::size_t wide = values.per_value;
        const auto known = known_.find(port);
        const double period = known != known_.end() ? seconds(known->second.period) : trace.period;
        // An edit may change the type or the rate.
        if (trace.columns.size() != wide || trace.period != period) {
            trace = {};
            trace.columns.resize(wide);
            trace.period = period;
            if (known != known_.end()) trace.names = take::channels_of(*known->second.type);
        }
        for (std::size_t i = 0; i < values.when.size(); ++i) {
            trace.times.push_back(seconds(values.when[i]));
            for (std::size_t c = 0; c < wide; ++c) trace.columns[c].push_back(values.columns[i * wide + c]);
        }
        if (!trace.times.empty()) forget(trace, trace.times.back() - kept_s);
    }
}

Feed::Latest LiveFeed::latest(const std::string& port) const {
    const auto found = known_.find(port);
    if (found == known_.end()) return {};
    const ValueType& type = *found->second.type;
    if (&type == &value::pose) return as_columns(observer_->latest<Pose>(port), type);
    if (&type == &value::twist) return as_columns(observer_->latest<Twist>(port), type);
    if (&type == &value::wrench) return as_columns(observer_->latest<Wrench>(port), type);
    if (&type == &value::vector) return as_columns(observer_->latest<Vec3>(port), type);
    if (&type == &value::number) return as_columns(observer_->latest<double>(port), type);
    if (&type == &value::boolean) return as_columns(observer_->latest<bool>(port), type);
    if (&type == &value::signal) return as_columns(observer_->latest<float>(port), type);
    return {};
}

const Trace* LiveFeed::trace(const std::string& port) const {
    const auto found = traces_.find(port);
    return found == traces_.end() ? nullptr : &found->second;
}

}  // namespace tactus::window
