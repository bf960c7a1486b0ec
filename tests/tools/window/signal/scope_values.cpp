// SPDX-License-Identifier: Apache-2.0
// Values of scopes that are typed: the level of the trigger and the cursors.
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/signal/scopes.hpp"

#include <algorithm>
#include <map>

using namespace tactus;
using namespace tactus::window;
using Catch::Matchers::ContainsSubstring;
using tactus::test::Folder;

namespace {

/// A hand that moves at 1 m/s along x, and a number that rises by 1/s, for 1 s.
class Moves : public Feed {
public:
    Moves() {
        for (int row = 0; row <= 1000; ++row)
            for (auto& [port, trace] : traces_) {
                trace.times.push_back(row * 1e-3);
                for (std::size_t c = 0; c < trace.columns.size(); ++c)
                    trace.columns[c].push_back(c == 0 ? row * 1e-3 : 0.0);
            }
    }
    std::vector<Port> ports() const override {
        return {{"hand.pose", &value::pose, 1000.0}, {"a.out", &value::number, 1000.0}};
    }
    double now() const override { return 1.0; }
    void follow(const std::set<std::string>&, const std::set<std::string>&) override {}
    Latest latest(const std::string&) const override { return {}; }
    const Trace* trace(const std::string& port) const override {
        const auto known = traces_.find(port);
        return known == traces_.end() ? nullptr : &known->second;
    }

private:
    std::map<std::string, Trace> traces_{
        {"hand.pose", {{}, std::vector<std::vector<double>>(7), {"x", "y", "z", "qw", "qx", "qy", "qz"}, 1e-3}},
        {"a.out", {{}, {{}}, {"value"}, 1e-3}}};
};

struct ValueBench {
    Folder folder;
    Workbench bench{choice()};
    Scopes scopes{bench};
    Moves feed;
    ValueQuestion asked;

    explicit ValueBench(const std::string& port) {
        scopes.ask_value = [this](ValueQuestion question) { asked = std::move(question); };
        scopes.add(port);
        shows();
    }
    run::RunChoice choice() const {
        run::RunChoice choice;
        choice.patch = folder.write("voice.toml", test::voice).string();
        choice.out = folder.path / "out";
        return choice;
    }
    Scopes::Scope& scope() { return scopes.list()[0]; }
    void shows(Scopes::Scope::View view = Scopes::Scope::View::wave) {
        scope().view = view;
        scope().computed_at = -1.0;
        scopes.write(0, feed, folder.path / "shown.csv");
    }
    bool offers(const std::string& name) {
        std::vector<Command> all;
        scopes.add_commands(all);
        return std::ranges::find(all, name, &Command::name) != all.end();
    }
    /// What the question holds at first.
    std::string run(const std::string& name) {
        std::vector<Command> all;
        scopes.add_commands(all);
        const auto found = std::ranges::find(all, name, &Command::name);
        INFO(name);
        REQUIRE(found != all.end());
        found->run();
        return asked.value;
    }
};

}  // namespace

TEST_CASE("the level of a trigger is typed with its unit and a wrong one is refused with the reason") {
    ValueBench it("hand.pose");
    it.scope().y = {-100.0, 500.0};
    CHECK(it.run("Scope 1: level of the trigger...") == "200 mm");
    CHECK(it.asked.what == "scope 1: level of the trigger");
    it.asked.take("12.5 mm");
    REQUIRE(it.scope().trigger);
    CHECK(it.scope().trigger->level == Approx(12.5));
    CHECK(it.scope().trigger->is_rising);
    it.shows();
    CHECK(it.scope().plot.origin == Approx(0.0125));
    it.scope().trigger->is_rising = false;
    it.asked.take("0.3 m");
    CHECK(it.scope().trigger->level == Approx(300.0));
    CHECK_FALSE(it.scope().trigger->is_rising);
    CHECK(it.run("Scope 1: level of the trigger...") == "300 mm");
    CHECK_THROWS_WITH(it.asked.take("12"), ContainsSubstring("'12' needs a unit, as in \"12 mm\""));
    CHECK_THROWS_WITH(it.asked.take("12 N"), ContainsSubstring("wrong kind of unit"));
    CHECK_THROWS_WITH(it.asked.take("much"), ContainsSubstring("is not a number with a unit"));
    CHECK_THROWS_AS(it.asked.take("nan mm"), Error);
    CHECK_THROWS_WITH(it.asked.take("1e308 m"), ContainsSubstring("is too large"));
    CHECK(it.scope().trigger->level == Approx(300.0));
    // Only waves have one.
    it.shows(Scopes::Scope::View::spectrum);
    CHECK_FALSE(it.offers("Scope 1: level of the trigger..."));
    ValueBench bare("a.out");
    bare.run("Scope 1: level of the trigger...");
    bare.asked.take("0.25");
    CHECK(bare.scope().trigger->level == 0.25);
    CHECK_THROWS_WITH(bare.asked.take("0.5 mm"), ContainsSubstring("has a unit where a bare number is needed"));
}

TEST_CASE("cursors of a wave are typed as times and stay within what is shown") {
    ValueBench it("hand.pose");
    CHECK_FALSE(it.offers("Scope 1: cursor B at..."));
    CHECK_THROWS_WITH(Scopes::set_cursor(it.scope(), 1, false, "0.5 s"), "there is no cursor A yet");
    it.run("Scope 1: cursor A at...");
    it.asked.take("250 ms");
    REQUIRE(it.scope().cursors.size() == 1);
    CHECK(it.scope().cursors[0].x == Approx(0.25));
    it.run("Scope 1: cursor B at...");
    it.asked.take("0.5 s");
    REQUIRE(it.scope().cursors.size() == 2);
    CHECK(it.scope().cursors[1].x == Approx(0.5));
    CHECK(it.run("Scope 1: cursor A at...") == "0.25 s");
    it.asked.take("0.4 s");
    REQUIRE(it.scope().cursors.size() == 2);
    CHECK(it.scope().cursors[0].x == Approx(0.4));
    CHECK_THROWS_WITH(it.asked.take("7 s"), "7 s is not shown; the scope shows -1 to 1 s");
    CHECK_THROWS_WITH(it.asked.take("7 Hz"), ContainsSubstring("wrong kind of unit"));
    CHECK(it.scope().cursors[0].x == Approx(0.4));
    it.run("Scope 1: no cursors");
    CHECK(it.scope().cursors.empty());
    CHECK_FALSE(it.offers("Scope 1: no cursors"));
}

TEST_CASE("cursors of a spectrum are frequencies and those of a curve of pairs are typed across and up") {
    ValueBench it("hand.pose");
    it.shows(Scopes::Scope::View::spectrum);
    it.run("Scope 1: cursor A at...");
    it.asked.take("0.1 kHz");
    CHECK(it.scope().cursors.at(0).x == Approx(100.0));
    it.scope().cursors.clear();
    it.shows(Scopes::Scope::View::xy);
    CHECK_FALSE(it.offers("Scope 1: cursor A at..."));
    it.run("Scope 1: cursor A across at...");
    it.asked.take("30 cm");
    it.run("Scope 1: cursor A up at...");
    it.asked.take("0 mm");
    REQUIRE(it.scope().cursors.size() == 1);
    CHECK(it.scope().cursors[0].x == Approx(300.0));
    CHECK(it.scope().cursors[0].y == 0.0);
}

TEST_CASE("a scope that shows nothing yet has no place for a cursor") {
    ValueBench it("hand.pose");
    it.scopes.add("nothing.out");
    CHECK_THROWS_WITH(Scopes::set_cursor(it.scopes.list()[1], 0, false, "1 s"), "the scope shows nothing yet");
}
