// SPDX-License-Identifier: Apache-2.0
// Where the window gets values from: a run that goes on, or a take at some instant.
#pragma once

#include "engine/observe/observer.hpp"
#include "engine/take/take_reader.hpp"
#include "graph/compile/plan.hpp"
#include "tools/view/signal/axis.hpp"

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace tactus::view {

/// What one output gave: a row of numbers for each time, times rising.
struct Trace {
    std::vector<double> times;                 ///< logical, s
    std::vector<std::vector<double>> columns;  ///< by column, as long as `times`
    std::vector<std::string> names;            ///< of the columns
};

/// Drops what is older than `before`, now and then rather than always: it moves all that stays.
void forget(Trace& trace, double before);

class Feed {
public:
    struct Port {
        std::string name;  ///< "node.port"
        const ValueType* type = nullptr;
        double rate = 0.0;  ///< Hz
    };
    static constexpr std::size_t most_columns = 16;
    struct Latest {
        std::array<double, most_columns> columns{};
        std::size_t count = 0;
    };

    virtual ~Feed() = default;
    virtual std::vector<Port> ports() const = 0;
    /// Rises when there are others.
    virtual std::int64_t ports_version() const { return 0; }
    virtual double now() const = 0;  ///< s
    /// Once per picture: which outputs are wanted at all, and which with every value.
    virtual void follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) = 0;
    /// The newest value of an output that is looked at; none: count 0.
    virtual Latest latest(const std::string& port) const = 0;
    /// Null for an output that is not traced.
    virtual const Trace* trace(const std::string& port) const = 0;
};

/// Of a live run.
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

    static constexpr double kept_s = 20.0;  ///< of every trace

private:
    std::shared_ptr<observe::Observer> observer_;
    double now_ = 0.0;
    std::set<std::string> watched_;
    std::map<std::string, Trace> traces_;
    std::unordered_map<std::string, const ValueType*> types_;
    std::int64_t listed_ = -1;  ///< version of the ports in `types_`
};

/// Of a take at a time that is set: `latest` is what held then, traces end then.
class TakeFeed : public Feed {
public:
    /// `take` must outlive it. Throws Error.
    explicit TakeFeed(const take::Take& take);

    std::vector<Port> ports() const override;
    double now() const override { return now_; }
    void set_now(double seconds) { now_ = seconds; }
    /// To the end of the last recorded stretch, s.
    double length() const { return length_; }
    /// When values were recorded, in order, s.
    const std::vector<Range>& recorded() const { return recorded_; }
    void follow(const std::set<std::string>& looked_at, const std::set<std::string>& traced) override;
    Latest latest(const std::string& port) const override;
    const Trace* trace(const std::string& port) const override;

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
        streams_;  // an edit or a pause in recording begins another
    std::map<std::string, Latest> latest_;
    std::map<std::string, Cut> cuts_;
    double latest_at_ = -1.0;
};

}  // namespace tactus::view
