// SPDX-License-Identifier: Apache-2.0
// Scopes without a window: what they hold, trigger on and write.
#include "tools/window/signal/scopes.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <cmath>
#include <map>

using namespace tactus;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::slurp;

namespace {

/// Ramps of 1/s at 1 kHz that go on as told; every port is traced.
class Ramps : public Feed {
public:
    explicit Ramps(double until) { go_on(until); }
    void go_on(double until) {
        for (; row * 1e-3 < until; ++row)
            for (auto& [port, trace] : traces) {
                trace.times.push_back(row * 1e-3);
                for (std::size_t c = 0; c < trace.columns.size(); ++c)
                    trace.columns[c].push_back(static_cast<double>(c + 1) * row * 1e-3);
            }
    }

    std::vector<Port> ports() const override {
        return {{"a.out", &value::number, 1000.0}, {"b.out", &value::number, 1000.0}, {"f.out", &value::vector, 1e3}};
    }
    double now() const override { return row * 1e-3; }
    void follow(const std::set<std::string>&, const std::set<std::string>&) override {}
    Latest latest(const std::string&) const override { return {}; }
    const Trace* trace(const std::string& port) const override {
        const auto known = traces.find(port);
        return known == traces.end() ? nullptr : &known->second;
    }

    std::map<std::string, Trace> traces{{"a.out", {{}, {{}}, {"value"}, 1e-3}},
                                        {"b.out", {{}, {{}}, {"value"}, 1e-3}},
                                        {"f.out", {{}, {{}, {}, {}}, {"x", "y", "z"}, 1e-3}}};

private:
    int row = 0;
};

struct Bench {
    Folder folder;
    Workbench bench{choice()};
    Scopes scopes{bench};

    run::RunChoice choice() const {
        run::RunChoice choice;
        choice.patch = folder.write("voice.toml", test::voice).string();
        choice.out = folder.path / "out";
        return choice;
    }
    std::string written(const Feed& feed, const char* name = "shown.csv") {
        scopes.write(0, feed, folder.path / name);
        return slurp(folder.path / name);
    }
};

}  // namespace

TEST_CASE("what is frozen stays when a signal over it is removed or added") {
    Bench it;
    Ramps feed(1.0);
    it.scopes.add("a.out");
    Scopes::Scope& scope = it.scopes.list()[0];
    Scopes::add_overlay(scope, "b.out");
    it.scopes.freeze(true);
    const std::string both = it.written(feed);
    CHECK(both.find("0.999000000,0.999,0.999\n") != std::string::npos);
    feed.go_on(5.0);
    CHECK(it.written(feed) == both);
    Scopes::remove_overlay(scope, 0);
    const std::string alone = it.written(feed);
    CHECK(alone.ends_with("0.999000000,0.999\n"));
    Scopes::add_overlay(scope, "b.out");
    CHECK(it.written(feed) == both);
    it.scopes.freeze(false);
    CHECK(it.written(feed).ends_with("4.999000000,4.999,4.999\n"));
}

TEST_CASE("a trigger shows a lone crossing that is on the screen, and a take is read as far back as it looks") {
    Bench it;
    const Ramps feed(1.0);
    it.scopes.add("a.out");
    Scopes::Scope& scope = it.scopes.list()[0];
    CHECK(it.scopes.longest_span() == 2.0);
    scope.trigger = Trigger{0.8, true};
    CHECK(it.scopes.longest_span() >= LiveFeed::kept_s + 0.1 * scope.span);
    scope.cursors = {{0.5, 0.0}};
    it.written(feed);
    CHECK(scope.reading.find("no crossing") == std::string::npos);
    CHECK(scope.plot.origin == Approx(0.8));
    // A time of the run is no time since the crossing.
    CHECK(scope.cursors.empty());
    scope.trigger->level = 7.0;
    it.written(feed);
    CHECK(scope.reading.find("no crossing") != std::string::npos);
}

TEST_CASE("levels and triggers are of the column that is chosen, or of the length of a vector") {
    Bench it;
    const Ramps feed(1.001);
    it.scopes.add("f.out");
    Scopes::Scope& scope = it.scopes.list()[0];
    scope.column = 1;
    scope.trigger = Trigger{1.0, true};
    it.written(feed);
    CHECK(scope.plot.origin == Approx(0.5));
    CHECK(scope.reading.starts_with("y: "));
    // The length of (1, 2, 3) t.
    scope.is_magnitude = true;
    it.written(feed);
    CHECK(scope.plot.origin == Approx(1.0 / std::sqrt(14.0)));
    CHECK(scope.reading.starts_with("magnitude: "));
}

TEST_CASE("an output that has a scope gets no second one of the same kind") {
    Bench it;
    for (int i = 0; i < 3; ++i) it.scopes.add("a.out");
    CHECK(it.scopes.list().size() == 1);
    CHECK(it.scopes.list()[0].is_called);
    it.scopes.add("a.out", true);
    CHECK(it.scopes.list().size() == 2);
}

TEST_CASE("a scope without values writes no file and says why") {
    Bench it;
    const Ramps feed(0.01);
    it.scopes.add("nothing.out");
    for (const char* name : {"none.png", "none.csv"}) {
        CHECK_THROWS_WITH(it.written(feed, name), "there are no values of nothing.out yet");
        CHECK_FALSE(std::filesystem::exists(it.folder.path / name));
    }
    it.scopes.list()[0].port = "a.out";
    it.scopes.list()[0].view = Scopes::Scope::View::spectrum;
    CHECK_THROWS_WITH(it.written(feed, "none.png"), "a.out: too few values for a spectrum");
}

TEST_CASE("a spectrum shows the signals over it, and its table has a column of each") {
    Bench it;
    const Ramps feed(1.0);
    it.scopes.add("a.out", true);
    Scopes::add_overlay(it.scopes.list()[0], "b.out");
    const std::string table = it.written(feed);
    CHECK(table.starts_with("frequency Hz,value dB/Hz,b.out value dB/Hz\n"));
    CHECK(it.scopes.list()[0].plot.curves.size() == 2);
}

TEST_CASE("files of a take go beside it, for a take holds its recordings only") {
    Bench it;
    it.scopes.folder_of_take = it.folder.path / "voice-take-1";
    CHECK(it.scopes.free_file("a/b.out", ".csv") == it.folder.path / "voice-take-1-a-b.out-1.csv");
}

TEST_CASE("everything that a scope does is a command, too") {
    Bench it;
    const Ramps feed(1.0);
    it.scopes.add("a.out");
    it.written(feed);
    std::vector<Command> all;
    it.scopes.add_commands(all);
    const auto run = [&](const std::string& name) {
        const auto found = std::ranges::find(all, name, &Command::name);
        INFO(name);
        REQUIRE(found != all.end());
        found->run();
    };
    run("Scope 1: x-y");
    CHECK(it.scopes.list()[0].view == Scopes::Scope::View::xy);
    run("Scope 1: freeze");
    CHECK(it.scopes.list()[0].is_frozen);
    run("Scope 1: trigger where it falls");
    CHECK_FALSE(it.scopes.list()[0].trigger->is_rising);
    run("Scope 1: CSV");
    CHECK(it.scopes.list()[0].wants_file == ".csv");
    run("Scope 1: close");
    CHECK(it.scopes.list()[0].wants_close);
    run("Show f.out in a scope");
    CHECK(it.scopes.list()[1].port == "f.out");
}
