// SPDX-License-Identifier: Apache-2.0
// Sources of values for the window: a live run, or a take at an instant.
#pragma once

#include "engine/observe/observer.hpp"
#include "engine/take/take_reader.hpp"
#include "graph/compile/schedule.hpp"
#include "tools/window/signal/axis.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace tactus::window {

/// The trace of an output: one row of numbers per time; times increase.
struct Trace {
    std::vector<double> times;                 ///< logical, s
    std::vector<std::vector<double>> columns;  ///< by column, as long as `times`
    std::vector<std::string> names;            ///< of the columns
    double period = 0.0;                       ///< s from one value to the next; 0: not known
};

/// Whether values are missing between that row and the one before: lost, or never recorded.
bool follows_gap(const Trace& trace, std::size_t row);

/// Drops values older than `before`; only occasionally, because it moves the remaining values.
void forget(Trace& trace, double before);

class Feed {
public:
    struct Port {
        std::string name;  ///< "node.port"
        const ValueType* type = nullptr;
        double rate = 0.0;  ///< Hz
    };
    static constexpr std::size_t max_columns = 16;
    struct Latest {
        std::array<double, max_columns> columns{};
        std::size_t count = 0;
    };

    virtual ~Feed() = default;
    virtual std::vector<Port> ports() const = 0;
    /// Increases when the list changes.
    virtual std::int64_t ports_version() const { return 0; }
    virtual double now() const = 0;  ///< s
    /// Called once per frame: the outputs to show, and those to trace with every value.
    virtual void follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) = 0;
    /// The latest value of a requested output; none: count 0.
    virtual Latest latest(const std::string& port) const = 0;
    /// The trace of an output; null if it is not traced.
    virtual const Trace* trace(const std::string& port) const = 0;
};

/// Values of a live run.
class LiveFeed : public Feed {
public:
    explicit LiveFeed(std::shared_ptr<observe::Observer> observer) : observer_(std::move(observer)) {}

    std::vector<Port> ports() const override;
    std::int64_t ports_version() const override { return observer_->ports_version(); }
    double now() const override { return now_; }
    void set_now(double seconds) { now_ = seconds; }
    void follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) override;
    Latest latest(const std::string& port) const override;
    const Trace* trace(const std::string& port) const override;

    static constexpr double kept_s = 20.0;  ///< length of every trace

private:
    std::shared_ptr<observe::Observer> observer_;
    double now_ = 0.0;
    std::set<std::string> watched_;
    std::map<std::string, Trace> traces_;
    std::unordered_map<std::string, observe::Observer::Port> known_;
    std::int64_t listed_ = -1;  ///< version of the ports in `known_`
};

/// Values of a take at a settable time: `latest` is the value at that time, and traces end there.
class TakeFeed : public Feed {
public:
    /// `take` must outlive it. Throws Error.
    explicit TakeFeed(const take::Take& take);

    std::vector<Port> ports() const override;
    double now() const override { return now_; }
    void set_now(double seconds) { now_ = seconds; }
    /// End of the last recorded stretch, s.
    double length() const { return length_; }
    /// Recorded stretches in order, s.
    const std::vector<Range>& recorded() const { return recorded_; }
    void follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) override;
    Latest latest(const std::string& port) const override;
    const Trace* trace(const std::string& port) const override;

    /// The instant at which the first three columns of an output were longest, over the whole take.
    struct Peak {
        std::string port;
        double when = 0.0, value = 0.0;
    };
    /// None: the take has no finite value of it.
    std::optional<Peak> largest(const std::string& port) const;

    double traced_s = 5.0;  ///< length of the traces

private:
    struct Cut {
        double begin = 0.0, end = -1.0;
        Trace trace;
    };
    void read(const std::string& port, double begin, double end, Trace& into) const;
    void extend(const std::string& port, Cut& cut, double begin) const;

    const take::Take& take_;
    double now_ = 0.0, length_ = 0.0;
    std::vector<Range> recorded_;
    std::map<std::string, std::vector<const take::TakeStreamInfo*>>
        streams_;  // an edit or a pause in recording starts another
    std::map<std::string, Latest> latest_;
    std::map<std::string, Cut> cuts_;
    double latest_at_ = -1.0;
};

}  // namespace tactus::window
