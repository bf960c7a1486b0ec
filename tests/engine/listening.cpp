// SPDX-License-Identifier: Apache-2.0
// Analysis in a slow group, fed from audio by batches: what it says of what plays.
#include "engine/run/engine.hpp"
#include "graph/compile/compile.hpp"
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"

#include <string>

using namespace tactus;

namespace {

Report rendered(const char* text, double seconds) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "test.toml", problems);
    std::optional<compile::Schedule> plan = compile::compile(patch, nodes::catalogue(), problems);
    for (const Error& error : problems.list) FAIL(error.what());
    run::EngineOptions options;
    options.seconds = seconds;
    run::Engine engine(std::move(*plan), options);
    engine.render(1);
    engine.finish();
    return engine.report();
}

double number(const Report& report, const char* section, const char* key) {
    return std::get<double>(report.sections.at(section).at(key));
}

}  // namespace

TEST_CASE("an analyser in a slow group of its own tells the level and the rate of what plays at audio rate") {
    const Report report = rendered(R"(
wires = ["tone.signal -> mix.in1", "octave.signal -> mix.in2", "mix.out -> heard.in as batch"]
[nodes.tone]
type = "sine"
rate = "48 kHz"
frequency = "231.7 Hz"
amplitude = "2"
[nodes.octave]
type = "sine"
rate = "48 kHz"
frequency = "463.4 Hz"
amplitude = "1"
[nodes.mix]
type = "mix"
rate = "48 kHz"
[nodes.heard]
type = "spectrum_analyser"
rate = "10 Hz"
)",
                                   4.0);
    CHECK(number(report, "heard", "fundamental_hz") == Approx(231.7).margin(0.02));
    const auto orders = std::get<std::vector<double>>(report.sections.at("heard").at("order_amplitudes"));
    REQUIRE(orders.size() >= 3);
    CHECK(orders[0] == Approx(2.0).epsilon(0.01));
    CHECK(orders[1] == Approx(1.0).epsilon(0.01));
    CHECK(orders[2] == 0.0);
}

TEST_CASE("a monitor says from when on an output is what was wanted, and that a filtered one is not") {
    const char* patch = R"(
wires = ["tone.signal -> mix.in1", "octave.signal -> mix.in2", "mix.out -> body.in",
         "mix.out -> likeness.reference as batch", "body.out -> likeness.output as batch"]
[nodes.tone]
type = "sine"
rate = "48 kHz"
frequency = "120 Hz"
[nodes.octave]
type = "sine"
rate = "48 kHz"
frequency = "360 Hz"
[nodes.mix]
type = "mix"
rate = "48 kHz"
[nodes.body]
type = "filter"
rate = "48 kHz"
kind = "lowpass"
frequency = "CUTOFF"
[nodes.likeness]
type = "spectral_monitor"
rate = "10 Hz"
)";
    const auto with = [&](const std::string& cutoff) {
        std::string text = patch;
        text.replace(text.find("CUTOFF"), 6, cutoff);
        return rendered(text.c_str(), 4.0);
    };
    const Report open = with("20 kHz"), closed = with("150 Hz");
    CHECK(number(open, "likeness", "alike_s") > 2.5);
    CHECK(number(open, "likeness", "lsd_db") < 0.1);
    CHECK(number(open, "likeness", "gain_db") == Approx(0.0).margin(0.05));
    CHECK(number(closed, "likeness", "heard_s") > 2.5);
    CHECK(number(closed, "likeness", "alike_s") == 0.0);
    CHECK(number(closed, "likeness", "third_octave_max_db") > 4.5);
    CHECK(number(closed, "likeness", "gain_db") > 2.0);
}

TEST_CASE("what a listening node says depends neither on threads nor on blocks") {
    const char* text = R"(
wires = ["tone.signal -> heard.in as batch", "tone.signal -> same.reference as batch",
         "louder.out -> same.output as batch", "tone.signal -> louder.in"]
[nodes.tone]
type = "sine"
rate = "48 kHz"
[nodes.louder]
type = "gain"
rate = "48 kHz"
[nodes.heard]
type = "spectrum_analyser"
rate = "10 Hz"
[nodes.same]
type = "spectral_monitor"
rate = "4 Hz"
)";
    const auto hash = [&](int threads, bool random_blocks) {
        patch::Problems problems;
        std::optional<compile::Schedule> plan =
            compile::compile(patch::read_patch(text, "test.toml", problems), nodes::catalogue(), problems);
        for (const Error& error : problems.list) FAIL(error.what());
        run::EngineOptions options;
        options.seconds = 3.0;
        options.random_blocks = random_blocks;
        if (random_blocks) options.block = 480;
        run::Engine engine(std::move(*plan), options);
        engine.render(threads);
        engine.finish();
        return engine.output_hash();
    };
    const std::uint64_t once = hash(1, false);
    CHECK(hash(3, false) == once);
    CHECK(hash(3, true) == once);
}
