// SPDX-License-Identifier: Apache-2.0
// Observation of a run from outside, as by a viewer: copies of the values of chosen outputs. A run with an observer
// computes the same bits at the same times as one without; an observer that is slow or never reads only misses values.
#pragma once

#include "engine/observe/observed_port.hpp"
#include "engine/observe/past_values.hpp"
#include "engine/observe/seen_values.hpp"

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tactus::observe {

/// The type by which an observer receives a value.
template <class T>
concept Observable = std::same_as<T, Pose> || std::same_as<T, Twist> || std::same_as<T, Wrench> ||
                     std::same_as<T, Vec3> || std::same_as<T, double> || std::same_as<T, bool> ||
                     std::same_as<T, float> || std::same_as<T, SeenScene> || std::same_as<T, rope::RopeShape>;

/// Follows outputs by name through every edit of a run. Give it to EngineOptions::observer. It must outlive the
/// engine's run, and may be used before, during and after it. All members may be called from any thread.
class Observer {
public:
    enum class Pace : std::uint8_t {
        live,  ///< new values are visible on the next read; values not fetched in time are lost
        lossless,  ///< offline runs: nothing is lost, and `advance` sets the time up to which values are visible
        kept,  ///< as lossless, and the history is kept, so that `advance` can go back; without `fetch`
    };
    explicit Observer(Pace pace = Pace::live) : pace_(pace) {}

    /// An output that can be observed.
    struct Port {
        std::string name;  ///< "node.port"
        const ValueType* type = nullptr;
        Flicks period = 0;
    };
    /// Returns the ports in the order in which nodes were created, including the new nodes of an edit in progress.
    std::vector<Port> ports() const;
    /// Increases when the result of `ports` changes; copying the list is slow, as a patch can have tens of thousands of
    /// ports.
    std::int64_t ports_version() const { return ports_version_.load(std::memory_order_relaxed); }

    /// Sets the level at which `who` observes an output from now on, also an output that a later edit will add. The
    /// highest level of all observers applies. Lossless observers call this before the run.
    void watch(const std::string& port, Watch how, const void* who = nullptr);

    /// Call once per frame, before reading: receives new values, in lossless mode those of logical times up to `until`.
    void advance(Flicks until = std::numeric_limits<Flicks>::max());

    /// Returns the newest value of a watched output, or its initial value before its node has run. Empty if there is no
    /// such output or it has another type. A signal is returned as its last sample (float), a scene as SeenScene.
    template <Observable T>
    std::optional<Seen<T>> latest(const std::string& port) const {
        alignas(T) std::byte value[sizeof(T)];
        Flicks when = 0;
        if (!read_latest(port, type_of<T>(), value, when)) return std::nullopt;
        Seen<T> seen{T{}, when};
        std::memcpy(&seen.value, value, sizeof(T));
        return seen;
    }
    /// Appends the values since the last call, for an output watched with Watch::every. Returns false if there are
    /// none.
    bool fetch(const std::string& port, SeenValues& into);

    /// Returns the bone of an output as of the last `advance`, or null. The object stays the same until an edit
    /// replaces the bone; its content changes in `advance` only.
    std::shared_ptr<const SeenBone> bone(const std::string& port) const;
    /// The shapes of the bodies of all nodes, also of nodes that an edit adds.
    std::vector<std::shared_ptr<const SeenBody>> bodies() const;

    /// Memory of the kept history, bytes.
    std::size_t kept_bytes() const;
    /// Number of values of an output that were lost.
    std::uint64_t lost(const std::string& port) const;

    // For the engine:
    /// Registers an output of a node that was just prepared.
    std::shared_ptr<ObservedPort> open(ObservedPort::Identity identity, const ValueType& type,
                                       const std::byte* initial);
    /// Lossless: the rings are filling up; a thread outside of a tick should call `drain`.
    bool wants_drain() const noexcept { return pace_ != Pace::live && pressing_.load(std::memory_order_relaxed); }
    void drain();

private:
    /// The state of reading one port.
    struct Reading {
        std::weak_ptr<ObservedPort> port;
        std::vector<ObservedPort::Piece> waiting;  // taken out of the ring; the first `used` are processed
        std::size_t used = 0;
        std::size_t used_of_first = 0;  // processed values of the first piece
        std::vector<std::byte> value;  // in lossless mode: as of `advance`
        Flicks when = 0;
        bool was_watched = false;  // values may wait in the ring
        bool has_begun = false;  // some value was applied
        SeenValues gathered;
        std::shared_ptr<SeenBone> bone;
        std::vector<ObservedPort::Piece> unfinished;  // bricks whose version is not complete
        std::unique_ptr<PastValues> past_values;  // in kept mode, one of the two
        std::shared_ptr<PastBone> past_bone;
    };
    struct Named {
        std::map<const void*, Watch> wishes;
        Watch watch = Watch::nothing;  // the highest level of all observers
        std::vector<Reading> readings;  // an edit can create a node again: the newest last
    };

    template <class T>
    static const ValueType& type_of() {
        if constexpr (std::same_as<T, float>) return value::signal;
        else if constexpr (std::same_as<T, SeenScene>) return value::snapshot<coupling::Scene>;
        else return value_type<T>();
    }
    const Reading* newest(const Named& named) const;
    bool read_latest(const std::string& port, const ValueType& type, std::byte* value, Flicks& when) const;
    void take_in(Reading& reading, const ObservedPort& port, Watch how, Flicks until);
    static void keep(Reading& reading, const ObservedPort& port);
    static void look_back(Reading& reading, const ObservedPort& port, Flicks until);
    static void put_in_place(Reading& reading, const ObservedPort& port, const ObservedPort::Piece& all);
    void gather(Reading& reading, const ObservedPort& port, const ObservedPort::Piece& piece, Flicks until, Watch how);
    void drain_locked();

    const Pace pace_;
    mutable std::mutex lock_;  // never taken in a tick
    std::map<std::string, Named> named_;  // entries are never removed
    std::vector<std::map<std::string, Named>::iterator> order_;  // those that exist now
    std::atomic<std::int64_t> ports_version_{0};
    std::atomic<bool> pressing_{false};
};

}  // namespace tactus::observe
