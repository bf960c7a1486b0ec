// SPDX-License-Identifier: Apache-2.0
#include "engine/observe/observer.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tactus::observe {

namespace {

// Limit for one port of a live run that is watched without being read.
constexpr std::size_t max_gathered = std::size_t{1} << 20;

}  // namespace

std::shared_ptr<ObservedPort> Observer::open(ObservedPort::Identity identity, const ValueType& type,
                                             const std::byte* initial) {
    auto port = std::make_shared<ObservedPort>(std::move(identity), type, initial, pace_ != Pace::live, &pressing_);
    const std::lock_guard hold(lock_);
    const auto at = named_.try_emplace(port->identity.name).first;
    Named& named = at->second;
    if (named.readings.empty()) order_.push_back(at);
    ++ports_version_;
    std::erase_if(named.readings, [](const Reading& old) { return old.port.expired(); });
    Reading& reading = named.readings.emplace_back();
    reading.port = port;
    reading.value = port->initial_value;
    reading.gathered.per_value = std::max<std::size_t>(type.columns.size(), 1);
    if (port->initial_bone) reading.bone = std::move(port->initial_bone);
    if (pace_ == Pace::kept && reading.bone) reading.bone->borrowed = reading.past_bone = std::make_shared<PastBone>();
    else if (pace_ == Pace::kept) reading.past_values = std::make_unique<PastValues>(port->value_size());
    port->watch(named.watch);
    return port;
}

/// The last that has run, or the first that is to.
const Observer::Reading* Observer::newest(const Named& named) const {
    const Reading* first = nullptr;
    for (auto reading = named.readings.rbegin(); reading != named.readings.rend(); ++reading) {
        const auto port = reading->port.lock();
        if (!port) continue;
        first = &*reading;
        if (pace_ == Pace::live ? port->has_run() : reading->has_begun) break;
    }
    return first;
}

std::vector<Observer::Port> Observer::ports() const {
    const std::lock_guard hold(lock_);
    std::vector<Port> ports;
    for (const auto& named : order_) {
        const auto& readings = named->second.readings;
        for (auto reading = readings.rbegin(); reading != readings.rend(); ++reading)
            if (const auto port = reading->port.lock()) {
                ports.push_back({named->first, &port->type, port->identity.period});
                break;
            }
    }
    return ports;
}

void Observer::watch(const std::string& name, Watch how, const void* who) {
    const std::lock_guard hold(lock_);
    Named& named = named_[name];
    if (how == Watch::nothing) named.wishes.erase(who);
    else named.wishes[who] = how;
    named.watch = Watch::nothing;
    for (const auto& [other, wish] : named.wishes) named.watch = std::max(named.watch, wish);
    for (const Reading& reading : named.readings)
        if (const auto port = reading.port.lock()) port->watch(named.watch);
}

void Observer::drain_locked() {
    pressing_.store(false, std::memory_order_relaxed);
    for (const auto& named : order_)
        for (Reading& reading : named->second.readings)
            // A port that was never watched has no values.
            if (named->second.watch != Watch::nothing || !reading.waiting.empty() || reading.was_watched)
                if (const auto port = reading.port.lock()) {
                    reading.was_watched = true;
                    port->drain(reading.waiting);
                }
}

void Observer::drain() {
    const std::lock_guard hold(lock_);
    drain_locked();
}

void Observer::advance(Flicks until) {
    const std::lock_guard hold(lock_);
    drain_locked();
    bool are_gone = false;
    for (const auto& at : order_) {
        Named& named = at->second;
        if (std::erase_if(named.readings, [](const Reading& old) { return old.port.expired(); }) > 0) {
            ++ports_version_;
            are_gone = are_gone || named.readings.empty();
        }
        for (Reading& reading : named.readings) {
            if (!reading.was_watched) continue;
            const auto port = reading.port.lock();
            if (!port) continue;
            if (pace_ != Pace::kept) {
                take_in(reading, *port, named.watch, until);
                continue;
            }
            keep(reading, *port);
            look_back(reading, *port, until);
        }
    }
    if (are_gone) std::erase_if(order_, [](const auto& at) { return at->second.readings.empty(); });
}

void Observer::take_in(Reading& reading, const ObservedPort& port, Watch how, Flicks until) {
    while (reading.used < reading.waiting.size()) {
        ObservedPort::Piece& piece = reading.waiting[reading.used];
        if (pace_ == Pace::lossless && piece.index * port.identity.period > until) break;
        reading.has_begun = true;
        if (reading.bone) {
            if (piece.brick < 0) put_in_place(reading, port, piece);
            else reading.unfinished.push_back(std::move(piece));
        } else {
            gather(reading, port, piece, until, how);
            if (reading.used_of_first < piece.count) break;
            reading.used_of_first = 0;
        }
        ++reading.used;
    }
    reading.waiting.erase(reading.waiting.begin(), reading.waiting.begin() + static_cast<std::ptrdiff_t>(reading.used));
    reading.used = 0;
}

void Observer::keep(Reading& reading, const ObservedPort& port) {
    const Flicks period = port.identity.period;
    for (ObservedPort::Piece& piece : reading.waiting) {
        if (reading.past_bone) reading.past_bone->add(piece.index * period, piece);
        else
            for (std::size_t i = 0; i < piece.count; ++i)
                reading.past_values->add((piece.index + static_cast<std::int64_t>(i)) * period,
                                         piece.values.data() + i * port.value_size());
    }
    reading.waiting.clear();
}

void Observer::look_back(Reading& reading, const ObservedPort& port, Flicks until) {
    if (reading.past_bone) {
        reading.past_bone->show(until, *reading.bone);
        reading.has_begun = reading.past_bone->has_begun(until);
        return;
    }
    const std::optional<Flicks> when = reading.past_values->at(until, reading.value.data());
    reading.has_begun = when.has_value();
    reading.when = when.value_or(0);
    if (!when) reading.value = port.initial_value;
}

void Observer::put_in_place(Reading& reading, const ObservedPort& port, const ObservedPort::Piece& all) {
    SeenBone& bone = *reading.bone;
    if (!reading.unfinished.empty()) ++bone.update;
    for (ObservedPort::Piece& brick : reading.unfinished) {
        const auto b = static_cast<std::size_t>(brick.brick);
        bone.distance[b] = std::move(brick.samples);
        bone.root.distance[b] = bone.distance[b].get();
        bone.changed_at[b] = bone.update;
    }
    reading.unfinished.clear();
    bone.version = all.version;
    bone.when = all.index * port.identity.period;
}

void Observer::gather(Reading& reading, const ObservedPort& port, const ObservedPort::Piece& piece, Flicks until,
                      Watch how) {
    const std::size_t size = port.value_size();
    SeenValues& to = reading.gathered;
    for (; reading.used_of_first < piece.count; ++reading.used_of_first) {
        const Flicks when = (piece.index + static_cast<std::int64_t>(reading.used_of_first)) * port.identity.period;
        if (pace_ == Pace::lossless && when > until) return;
        const std::byte* value = piece.values.data() + reading.used_of_first * size;
        std::copy_n(value, size, reading.value.begin());
        reading.when = when;
        if (how != Watch::every || port.type.columns.empty()) continue;
        if (pace_ == Pace::live && to.when.size() >= max_gathered) continue;
        to.when.push_back(when);
        to.columns.resize(to.columns.size() + to.per_value);
        port.type.to_columns(value, to.columns.data() + to.columns.size() - to.per_value);
    }
}

bool Observer::read_latest(const std::string& name, const ValueType& type, std::byte* value, Flicks& when) const {
    const std::lock_guard hold(lock_);
    const auto named = named_.find(name);
    if (named == named_.end()) return false;
    const Reading* reading = newest(named->second);
    const auto port = reading ? reading->port.lock() : nullptr;
    if (!port || port->type != type) return false;
    when = 0;
    if (pace_ == Pace::live) {
        std::int64_t index = 0;
        if (port->latest(value, index)) {
            when = index * port->identity.period;
            return true;
        }
    }
    std::copy(reading->value.begin(), reading->value.end(), value);
    when = reading->when;
    return true;
}

bool Observer::fetch(const std::string& name, SeenValues& into) {
    const std::lock_guard hold(lock_);
    const auto named = named_.find(name);
    if (named == named_.end()) return false;
    bool any = false;
    for (Reading& reading : named->second.readings) {
        SeenValues& from = reading.gathered;
        any = any || !from.when.empty();
        into.per_value = from.per_value;
        into.when.insert(into.when.end(), from.when.begin(), from.when.end());
        into.columns.insert(into.columns.end(), from.columns.begin(), from.columns.end());
        from.when.clear();
        from.columns.clear();
    }
    return any;
}

std::shared_ptr<const SeenBone> Observer::bone(const std::string& name) const {
    const std::lock_guard hold(lock_);
    const auto named = named_.find(name);
    const Reading* reading = named == named_.end() ? nullptr : newest(named->second);
    return reading ? reading->bone : nullptr;
}

std::vector<std::shared_ptr<const SeenBody>> Observer::bodies() const {
    const std::lock_guard hold(lock_);
    std::vector<std::shared_ptr<const SeenBody>> bodies;
    for (const auto& named : order_)
        for (const Reading& reading : named->second.readings)
            if (const auto port = reading.port.lock())
                bodies.insert(bodies.end(), port->bodies.begin(), port->bodies.end());
    return bodies;
}

std::size_t Observer::kept_bytes() const {
    const std::lock_guard hold(lock_);
    std::size_t bytes = 0;
    for (const auto& [name, named] : named_)
        for (const Reading& reading : named.readings) {
            if (reading.past_bone) bytes += reading.past_bone->bytes();
            if (reading.past_values) bytes += reading.past_values->bytes();
        }
    return bytes;
}

std::uint64_t Observer::lost(const std::string& name) const {
    const std::lock_guard hold(lock_);
    std::uint64_t lost = 0;
    if (const auto named = named_.find(name); named != named_.end())
        for (const Reading& reading : named->second.readings)
            if (const auto port = reading.port.lock()) lost += port->lost();
    return lost;
}

}  // namespace tactus::observe
