// SPDX-License-Identifier: Apache-2.0
// How an outsider, such as a viewer, sees a run: copies of what chosen outputs give. A run with an observer computes the
// same bits at the same times as one without; an observer that is slow, or never looks at all, only misses values.
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

/// What a value looks like from outside.
template <class T>
concept Observable = std::same_as<T, Pose> || std::same_as<T, Twist> || std::same_as<T, Wrench> ||
                     std::same_as<T, Vec3> || std::same_as<T, double> || std::same_as<T, bool> ||
                     std::same_as<T, float> || std::same_as<T, SeenScene> || std::same_as<T, rope::RopeShape>;

/// Follows outputs by name through every edit of a run. Give it to EngineOptions::observer; it must outlive the engine's
/// run, and may look on before, while and after. All members may be called from any thread.
class Observer {
public:
    enum class Pace : std::uint8_t {
        live,  ///< what comes is seen when it is looked at; what is not fetched in time is lost
        lossless,  ///< offline runs: nothing is lost, and `advance` says up to when things are seen
        kept,  ///< the same, and all is kept: `advance` goes back, too. What was seen last is not fetched
    };
    explicit Observer(Pace pace = Pace::live) : pace_(pace) {}

    /// An output that there is to see.
    struct Port {
        std::string name;  ///< "node.port"
        const ValueType* type = nullptr;
        Flicks period = 0;
    };
    /// In the order in which nodes were made; with an edit on its way, the new nodes' too.
    std::vector<Port> ports() const;
    /// Rises when `ports` gives others: a patch can have tens of thousands.
    std::int64_t ports_version() const { return ports_version_.load(std::memory_order_relaxed); }

    /// Says how closely `who` looks at an output from now on, also at one that an edit is yet to bring. Of several who
    /// look, the closest counts. Lossless observers say so before the run.
    void watch(const std::string& port, Watch how, const void* who = nullptr);

    /// Once per picture, before looking: takes in what has come, of logical times up to `until` when lossless.
    void advance(Flicks until = std::numeric_limits<Flicks>::max());

    /// The newest value of a watched output; before its node has run, what it began with. None: no such output, or
    /// one of another type. A signal is seen as the last sample (float), a scene as SeenScene.
    template <Observable T>
    std::optional<Seen<T>> latest(const std::string& port) const {
        alignas(T) std::byte value[sizeof(T)];
        Flicks when = 0;
        if (!read_latest(port, type_of<T>(), value, when)) return std::nullopt;
        Seen<T> seen{T{}, when};
        std::memcpy(&seen.value, value, sizeof(T));
        return seen;
    }
    /// Values that came since the last call, of an output watched with Watch::every. Appends; false: none came.
    bool fetch(const std::string& port, SeenValues& into);

    /// The bone of an output as of the last `advance`, or null. The object stays the same until an edit makes another
    /// bone; its content changes in `advance` only.
    std::shared_ptr<const SeenBone> bone(const std::string& port) const;
    /// The shapes of the bodies of all nodes, also of nodes that an edit adds.
    std::vector<std::shared_ptr<const SeenBody>> bodies() const;

    /// Memory of the kept history, bytes.
    std::size_t kept_bytes() const;
    /// Values of an output that were lost.
    std::uint64_t lost(const std::string& port) const;

    // The engine's:
    /// Begins to look at an output of a node that was just prepared.
    std::shared_ptr<ObservedPort> open(ObservedPort::Identity identity, const ValueType& type,
                                       const std::byte* initial);
    /// Lossless: the rings are filling up; a thread outside of a tick should call `drain`.
    bool wants_drain() const noexcept { return pace_ != Pace::live && pressing_.load(std::memory_order_relaxed); }
    void drain();

private:
    /// One port as far as it was read.
    struct Reading {
        std::weak_ptr<ObservedPort> port;
        std::vector<ObservedPort::Piece> waiting;  // taken out of the ring; the first `used` are done
        std::size_t used = 0;
        std::size_t used_of_first = 0;  // values of the first piece that are done
        std::vector<std::byte> value;  // lossless: as of `advance`
        Flicks when = 0;
        bool was_watched = false;  // values may wait in the ring
        bool has_begun = false;  // something was applied
        SeenValues gathered;
        std::shared_ptr<SeenBone> bone;
        std::vector<ObservedPort::Piece> unfinished;  // bricks whose version is not complete
        std::unique_ptr<PastValues> past_values;  // if kept, either of them
        std::shared_ptr<PastBone> past_bone;
    };
    struct Named {
        std::map<const void*, Watch> wishes;
        Watch watch = Watch::nothing;  // the closest of them
        std::vector<Reading> readings;  // an edit can make a node anew: the newest last
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
    std::map<std::string, Named> named_;  // for ever
    std::vector<std::map<std::string, Named>::iterator> order_;  // those that are there
    std::atomic<std::int64_t> ports_version_{0};
    std::atomic<bool> pressing_{false};
};

}  // namespace tactus::observe
