// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/touch_watch.hpp"

#include "graph/node/value.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>

using namespace tactus;
using namespace tactus::analysis;
using namespace tactus::window;

namespace {

/// A hand at 1 kHz that stands at (time, 0, 0) of whole seconds and presses from .5 to .6 s of each.
class HandFeed : public Feed {
public:
    void run_to(double end) {
        for (; row * 1e-3 < end; ++row) {
            const double time = row * 1e-3, second = row / 1000;
            const bool pressed = row % 1000 >= 500 && row % 1000 < 600;
            add("hand.pose", time, {second, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0});
            add("hand.trigger", time, {pressed ? 1.0 : 0.0});
        }
    }
    void begin_anew() {
        traces_.clear();
        row = 0;
    }

    bool has_pose = true;  ///< it is traced

    std::vector<Port> ports() const override {
        return {{"other.pose", &value::pose, 60.0},
                {"hand.pose", &value::pose, 1000.0},
                {"hand.trigger", &value::boolean, 1000.0}};
    }
    double now() const override { return row * 1e-3; }
    void follow(const std::set<std::string>&, const std::set<std::string>&) override {}
    Latest latest(const std::string&) const override { return {}; }
    const Trace* trace(const std::string& port) const override {
        if (port == "hand.pose" && !has_pose) return nullptr;
        const auto known = traces_.find(port);
        return known == traces_.end() ? nullptr : &known->second;
    }

private:
    void add(const std::string& port, double time, const std::vector<double>& values) {
        Trace& trace = traces_[port];
        trace.times.push_back(time);
        trace.columns.resize(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) trace.columns[i].push_back(values[i]);
    }
    int row = 0;
    std::map<std::string, Trace> traces_;
};

}  // namespace

TEST_CASE("a device with a button is offered first, and what it needs is traced") {
    const HandFeed feed;
    const auto sources = touch_sources(feed);
    REQUIRE(sources.size() == 2);
    CHECK(sources[0].button == "hand.trigger");
    CHECK(sources[1].button.empty());
    CHECK(TouchWatch(sources[0]).traced() == std::set<std::string>{"hand.pose", "hand.trigger"});
}

TEST_CASE("no press is missed however rarely the window looks, and none is taken twice") {
    HandFeed feed;
    TouchSource source = touch_sources(feed)[0];
    source.tip = Vec3(0.0, 0.01, 0.0);
    TouchWatch watch(source);
    CHECK_FALSE(watch.next(feed));
    feed.run_to(0.6);
    CHECK_FALSE(watch.next(feed));  // pressed, but not read as a whole
    CHECK(watch.is_reading());
    feed.run_to(4.8);
    for (int second = 0; second < 5; ++second) {
        const auto touched = watch.next(feed);
        REQUIRE(touched);
        CHECK(touched->tip.x == Approx(second));
        CHECK(touched->tip.y == Approx(0.01));
        CHECK(touched->moved == Approx(0.0).margin(1e-12));
    }
    CHECK_FALSE(watch.next(feed));
    feed.begin_anew();
    feed.run_to(0.8);
    CHECK(watch.next(feed));
}

TEST_CASE("what a trace holds from before is no touch, whichever of pose and button a scope has traced") {
    HandFeed feed;
    feed.run_to(2.3);
    feed.has_pose = GENERATE(true, false);
    TouchWatch watch(touch_sources(feed)[0]);
    CHECK_FALSE(watch.next(feed));
    CHECK_FALSE(watch.is_reading());
    feed.has_pose = true;
    feed.run_to(2.8);
    const auto touched = watch.next(feed);
    REQUIRE(touched);
    CHECK(touched->tip.x == Approx(2.0));
    CHECK_FALSE(watch.next(feed));
}

TEST_CASE("a run that begins anew is followed without a button as well, and drops the touch that was begun") {
    HandFeed feed;
    feed.run_to(3.0);
    TouchWatch watch({"hand.pose", "", "", Vec3(0.0)});
    CHECK_FALSE(watch.next(feed));
    watch.ask();
    CHECK_FALSE(watch.next(feed));
    CHECK(watch.is_reading());
    feed.begin_anew();
    feed.run_to(0.1);
    CHECK_FALSE(watch.next(feed));
    CHECK_FALSE(watch.is_reading());
}

TEST_CASE("a press in the window is a touch without a button") {
    HandFeed feed;
    feed.run_to(0.3);
    TouchWatch watch({"hand.pose", "", "", Vec3(0.0)});
    CHECK_FALSE(watch.next(feed));
    watch.ask();
    CHECK_FALSE(watch.next(feed));
    feed.run_to(0.7);
    CHECK(watch.next(feed));
    CHECK_FALSE(watch.next(feed));
}
