// SPDX-License-Identifier: Apache-2.0
// Node types that the program declares by tactus_declare_node.
#include "tests/support/catch.hpp"
#include "tools/embed/tactus.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

using Catch::Matchers::ContainsSubstring;

namespace {

struct FreePatch {
    void operator()(tactus_patch* patch) const { tactus_free_patch(patch); }
};
struct FreeRun {
    void operator()(tactus_run* run) const { tactus_free_run(run); }
};
using Patch = std::unique_ptr<tactus_patch, FreePatch>;
using Run = std::unique_ptr<tactus_run, FreeRun>;
using Process = int (*)(void*, const tactus_block*, tactus_error*);

tactus_error error;

/// A declaration and the lists that it refers to.
struct Declaration {
    const char* name;
    std::vector<tactus_port> inputs, outputs;
    std::vector<tactus_parameter> parameters;
    Process process = nullptr;
    int (*prepare)(void*, const tactus_setup*, void**, tactus_error*) = nullptr;
    void (*release)(void*) = nullptr;
    void* context = nullptr;

    int declare() const {
        const tactus_node_type type{sizeof(type),
                                    name,
                                    "of the test",
                                    inputs.data(),
                                    int(inputs.size()),
                                    outputs.data(),
                                    int(outputs.size()),
                                    parameters.data(),
                                    int(parameters.size()),
                                    context,
                                    prepare,
                                    process,
                                    release};
        return tactus_declare_node(&type, &error);
    }
};

void declared(const Declaration& type) {
    const int done = type.declare();
    INFO(error.text);
    REQUIRE(done == 0);
}

Patch parsed(const std::string& toml) {
    Patch patch(tactus_parse(toml.c_str(), nullptr, &error));
    INFO(error.text);
    REQUIRE(patch);
    return patch;
}

Run started(const Patch& patch, double seconds = 0.0, int threads = 0) {
    tactus_options options{};
    options.size = sizeof(options);
    options.seconds = seconds;
    options.threads = threads;
    Run run(tactus_start(patch.get(), &options, &error));
    INFO(error.text);
    REQUIRE(run);
    return run;
}

std::uint64_t hash_of(const Run& run) {
    REQUIRE(tactus_finish(run.get(), &error) == 0);
    return tactus_hash(run.get());
}

std::uint64_t rendered_hash(const Patch& patch, double seconds, int threads) {
    const Run run = started(patch, seconds, threads);
    const int done = tactus_render(run.get(), &error);
    INFO(error.text);
    REQUIRE(done == 0);
    return hash_of(run);
}

std::vector<double> values_of(const Patch& patch, const char* output, double seconds) {
    const Run run = started(patch, seconds);
    tactus_output_info info{};
    const int number = tactus_output(run.get(), output, 1, &info, &error);
    INFO(error.text);
    REQUIRE(number >= 0);
    REQUIRE(tactus_render(run.get(), &error) == 0);
    std::vector<double> values(tactus_available(run.get(), number) * static_cast<std::size_t>(info.columns));
    tactus_fetch(run.get(), number, nullptr, values.data(), values.size());
    return values;
}

template <class T>
T* row(const tactus_rows& rows, int i) {
    return reinterpret_cast<T*>(static_cast<char*>(rows.values) + i * rows.stride);
}

/// Smooths a signal; its level, of the last sample that was larger, is left alone otherwise.
Declaration smoother() {
    return {.name = "test_smoother",
            .inputs = {{"in", "signal", nullptr, nullptr, 0}},
            .outputs = {{"out", "signal", nullptr, nullptr, 0}, {"peak", "number", nullptr, nullptr, 0}},
            .parameters = {{"share", "0.1", "0", "1", "of the new sample"}},
            .process =
                [](void* state, const tactus_block* block, tactus_error*) {
                    auto& values = *static_cast<std::array<float, 2>*>(state);
                    for (int i = 0; i < block->frames; ++i) {
                        values[0] +=
                            static_cast<float>(block->parameters[0]) * (*row<float>(block->inputs[0], i) - values[0]);
                        *row<float>(block->outputs[0], i) = values[0];
                        if (values[0] <= values[1]) continue;
                        values[1] = values[0];
                        for (int k = i; k < block->frames; ++k) *row<double>(block->outputs[1], k) = values[1];
                    }
                    return 0;
                },
            .prepare =
                [](void*, const tactus_setup*, void** state, tactus_error*) {
                    *state = new std::array<float, 2>{0.0f, 0.0f};
                    return 0;
                },
            .release = [](void* state) { delete static_cast<std::array<float, 2>*>(state); }};
}

constexpr const char* smoothed = R"(
wires = ["source.signal -> smooth.in"]
[nodes.source]
type = "sine"
rate = "48 kHz"
[nodes.smooth]
type = "test_smoother"
rate = "48 kHz"
share = "0.2"
)";

Declaration failing(const char* name, Process process) {
    return {.name = name,
            .inputs = {},
            .outputs = {{"out", "signal", nullptr, nullptr, 0}},
            .parameters = {},
            .process = process};
}

std::string source_of(const char* type, const char* rate = "48 kHz") {
    return std::string("[nodes.a]\ntype = \"") + type + "\"\nrate = \"" + rate + "\"\n";
}

}  // namespace

TEST_CASE("a declared node has the same bits rendered, on several threads, and advanced by any steps") {
    declared(smoother());
    const Patch patch = parsed(smoothed);
    const std::uint64_t expected = rendered_hash(patch, 0.3, 1);
    CHECK(rendered_hash(patch, 0.3, 3) == expected);
    std::mt19937 random(5);
    for (int round = 0; round < 5; ++round) {
        const Run run = started(patch);
        for (double t = 0.0; t < 0.3;) {
            const double step = std::min(0.3 - t, 1e-5 * static_cast<double>(random() % 400));
            REQUIRE(tactus_advance(run.get(), step, &error) == 0);
            t += step;
        }
        REQUIRE(tactus_advance(run.get(), 0.3 - tactus_time(run.get()), &error) == 0);
        CHECK(hash_of(run) == expected);
    }
    REQUIRE(tactus_configure(patch.get(), "smooth.share=0.3", &error) == 0);
    CHECK(rendered_hash(patch, 0.3, 1) != expected);
}

TEST_CASE("a declared gain has the values of the gain of Tactus") {
    declared({.name = "test_gain",
              .inputs = {{"in", "signal", "m/s^2", nullptr, 0}},
              .outputs = {{"out", "signal", "m/s^2", nullptr, 0}},
              .parameters = {{"factor", "1", "-100", "100", nullptr}},
              .process = [](void*, const tactus_block* block, tactus_error*) {
                  for (int i = 0; i < block->frames; ++i)
                      *row<float>(block->outputs[0], i) =
                          *row<float>(block->inputs[0], i) * static_cast<float>(block->parameters[0]);
                  return 0;
              }});
    const auto patch_of = [](const char* type, const char* output) {
        const Patch patch =
            parsed(std::string("wires = [\"s.signal -> g.in\"]\n[nodes.s]\ntype = \"sine\"\nrate = \"8 kHz\"\n"
                               "[nodes.g]\nrate = \"8 kHz\"\nfactor = \"3\"\ntype = \"") +
                   type + "\"\n");
        return values_of(patch, output, 0.1);
    };
    const std::vector<double> ours = patch_of("gain", "g.out"), declared_ones = patch_of("test_gain", "g.out");
    REQUIRE(ours.size() == 800);
    CHECK(ours == declared_ones);
}

TEST_CASE("poses, twists, vectors, bools and wrenches pass a declared node by their columns") {
    declared({.name = "test_columns",
              .inputs = {{"pose_in", "pose", nullptr, nullptr, 0},
                         {"twist_in", "twist", nullptr, nullptr, 0},
                         {"open", "vector", "m", nullptr, 1}},
              .outputs = {{"pose", "pose", nullptr, nullptr, 0},
                          {"twist", "twist", nullptr, nullptr, 0},
                          {"vector", "vector", "m", nullptr, 0},
                          {"wrench", "wrench", nullptr, nullptr, 0},
                          {"flag", "bool", nullptr, nullptr, 0}},
              .parameters = {},
              .process = [](void*, const tactus_block* block, tactus_error* failure) {
                  if (block->frames != 1 || block->inputs[2].values) {
                      std::snprintf(failure->text, sizeof(failure->text),
                                    "not one frame, or a wire where there is none");
                      return 1;
                  }
                  std::copy_n(row<double>(block->inputs[0], 0), 7, row<double>(block->outputs[0], 0));
                  std::copy_n(row<double>(block->inputs[1], 0), 6, row<double>(block->outputs[1], 0));
                  std::copy_n(row<double>(block->inputs[0], 0), 3, row<double>(block->outputs[2], 0));
                  for (int k = 0; k < 6; ++k) row<double>(block->outputs[3], 0)[k] = k;
                  *row<unsigned char>(block->outputs[4], 0) = 77;  // no bool in C++
                  return 0;
              }});
    const Patch patch = parsed(R"(
wires = ["hand.pose -> c.pose_in", "hand.twist -> c.twist_in"]
[devices.simulated]
driver = "scripted"
targets = "0 s: 0 0 60 mm; 0.1 s: 10 20 50 mm"
[nodes]
hand = { type = "device_input", rate = "1 kHz" }
c = { type = "test_columns", rate = "1 kHz" }
)");
    CHECK(values_of(patch, "c.pose", 0.1) == values_of(patch, "hand.pose", 0.1));
    CHECK(values_of(patch, "c.twist", 0.1) == values_of(patch, "hand.twist", 0.1));
    const std::vector<double> vector = values_of(patch, "c.vector", 0.1), pose = values_of(patch, "hand.pose", 0.1);
    REQUIRE(vector.size() == 300);
    CHECK(vector[299] == pose[7 * 99 + 2]);
    CHECK(values_of(patch, "c.wrench", 0.001) == std::vector<double>{0, 1, 2, 3, 4, 5});
    CHECK(values_of(patch, "c.flag", 0.001) == std::vector<double>{1.0});
}

TEST_CASE("a callback that fails ends the run with its text and the place of the node, and nothing else") {
    declared(failing("test_failing", [](void*, const tactus_block* block, tactus_error* failure) {
        if (block->index + block->frames <= 4800) return 0;
        std::snprintf(failure->text, sizeof(failure->text), "no more samples");
        return 1;
    }));
    const Patch patch = parsed(source_of("test_failing"));
    for (const int threads : {1, 3}) {
        const Run run = started(patch, 3600.0, threads);
        CHECK(tactus_render(run.get(), &error) == -1);
        CHECK(std::string(error.text).ends_with("node 'a' of type 'test_failing': no more samples"));
        CHECK(error.line == 1);
        CHECK(tactus_finish(run.get(), &error) == -1);
        CHECK_THAT(error.text, ContainsSubstring("no more samples"));
    }
    const Run run = started(patch);
    CHECK(tactus_advance(run.get(), 0.09, &error) == 0);
    CHECK(tactus_advance(run.get(), 0.02, &error) == -1);
    CHECK(tactus_advance(run.get(), 0.02, &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("no more samples"));
    CHECK(rendered_hash(patch, 0.05, 1) != 0);

    declared(failing("test_silent", [](void*, const tactus_block*, tactus_error*) { return 7; }));
    const Run silent = started(parsed(source_of("test_silent")), 0.1);
    CHECK(tactus_render(silent.get(), &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("gave no reason"));
}

TEST_CASE("the state of each node is made once per run and released once, also when a run cannot start") {
    static std::atomic<int> made{0}, released{0};
    static std::atomic<bool> may_start{true};
    Declaration type = failing("test_state", [](void*, const tactus_block*, tactus_error*) { return 0; });
    type.prepare = [](void* context, const tactus_setup* setup, void** state, tactus_error* failure) {
        if (!may_start && std::string(setup->name) == "b") {
            std::snprintf(failure->text, sizeof(failure->text), "no room at %g Hz", setup->rate);
            return -1;
        }
        ++made;
        *state = context;
        return setup->max_frames > 0 && setup->seed != 0 ? 0 : -1;
    };
    type.release = [](void*) { ++released; };
    declared(type);
    const Patch patch = parsed(source_of("test_state") + "[nodes.b]\ntype = \"test_state\"\nrate = \"24 kHz\"\n");
    CHECK(made == 0);
    rendered_hash(patch, 0.01, 2);
    CHECK(made == 2);
    CHECK(released == 2);
    may_start = false;
    CHECK_FALSE(tactus_start(patch.get(), nullptr, &error));
    CHECK_THAT(error.text, ContainsSubstring("no room at 24000 Hz"));
    CHECK(error.line == 4);
    CHECK(made == released);
}

TEST_CASE("a live run refuses a declared node, and names it") {
    declared(smoother());
    const Patch patch = parsed(smoothed);
    tactus_options options{};
    options.size = sizeof(options);
    options.seconds = 0.1;
    options.live = 1;
    CHECK_FALSE(tactus_start(patch.get(), &options, &error));
    CHECK_THAT(error.text, ContainsSubstring("node 'smooth' of type 'test_smoother'"));
    CHECK_THAT(error.text, ContainsSubstring("cannot run live"));
    CHECK(error.line == 6);
    options.live = 0;
    CHECK(Run(tactus_start(patch.get(), &options, &error)));
}

TEST_CASE("a declaration that is not valid is refused with the reason, and leaves the one before") {
    declared(smoother());
    const std::uint64_t expected = rendered_hash(parsed(smoothed), 0.05, 1);
    const auto refused = [](Declaration type, const char* words) {
        CAPTURE(words);
        CHECK(type.declare() == -1);
        CHECK_THAT(error.text, ContainsSubstring(words));
    };
    Declaration type = smoother();
    type.name = "gain";
    refused(type, "Tactus has a type of this name already");
    for (const char* name : {"", "a b", "a.b"}) {
        type.name = name;
        refused(type, "a name has letters");
    }
    type = smoother();
    type.process = nullptr;
    refused(type, "no callback 'process'");
    type = smoother();
    type.inputs[0].type = "event";
    refused(type, "'event' is not one of number");
    type.inputs[0].type = nullptr;
    refused(type, "is not one of");
    type = smoother();
    type.outputs[1].type = "ramp";
    refused(type, "'ramp' is not one of");
    type = smoother();
    type.outputs[1].name = "in";
    refused(type, "listed twice");
    type.outputs[1].name = "rate";
    refused(type, "key of every node");
    type = smoother();
    type.inputs[0].unit = "parsec";
    refused(type, "unit of 'in'");
    type = smoother();
    type.inputs.push_back({"place", "pose", "m", nullptr, 0});
    refused(type, "state no unit");
    type = smoother();
    type.parameters[0].initial = "2";
    refused(type, "default");
    type.parameters[0].initial = "much";
    refused(type, "parameter 'share'");
    CHECK(tactus_declare_node(nullptr, &error) == -1);
    const tactus_node_type short_size{};
    CHECK(tactus_declare_node(&short_size, &error) == -1);
    CHECK(rendered_hash(parsed(smoothed), 0.05, 1) == expected);
}

TEST_CASE("wires of a declared node are checked for type, unit and presence") {
    declared({.name = "test_units",
              .inputs = {{"in", "signal", "m/s^2", nullptr, 0}},
              .outputs = {{"out", "signal", "N", nullptr, 0}},
              .parameters = {},
              .process = [](void*, const tactus_block*, tactus_error*) { return 0; }});
    const auto refused = [](const char* wires, const char* words) {
        const std::string toml = std::string("wires = [") + wires + "]\n" + source_of("test_units") +
                                 "[nodes.b]\ntype = \"test_units\"\nrate = \"48 kHz\"\n"
                                 "[nodes.s]\ntype = \"sine\"\nrate = \"48 kHz\"\n";
        CHECK_FALSE(Patch(tactus_parse(toml.c_str(), nullptr, &error)));
        CHECK_THAT(error.text, ContainsSubstring(words));
    };
    refused("\"s.signal -> a.in\", \"a.out -> b.in\"", "m/s^2");
    refused("\"s.signal -> a.in\"", "input 'in' of node 'b' is not connected");
    refused("\"s.signal -> a.inn\"", "did you mean 'in'?");
}

TEST_CASE("a new declaration serves the runs that start afterwards, and the runs before keep theirs") {
    const auto constant = [](const char* name, Process process) {
        declared({.name = name,
                  .inputs = {},
                  .outputs = {{"out", "number", nullptr, nullptr, 0}},
                  .parameters = {},
                  .process = process});
    };
    constant("test_again", [](void*, const tactus_block* block, tactus_error*) {
        *row<double>(block->outputs[0], 0) = 1.0;
        return 0;
    });
    const Patch patch = parsed(source_of("test_again", "1 kHz"));
    const Run before = started(patch);
    constant("test_again", [](void*, const tactus_block* block, tactus_error*) {
        *row<double>(block->outputs[0], 0) = 2.0;
        return 0;
    });
    const Run after = started(patch);
    const auto newest = [](const Run& run) {
        double value = 0.0;
        const int output = tactus_output(run.get(), "a.out", 0, nullptr, &error);
        REQUIRE(tactus_advance(run.get(), 0.01, &error) == 0);
        tactus_newest(run.get(), output, &value);
        return value;
    };
    CHECK(newest(before) == 1.0);
    CHECK(newest(after) == 2.0);
}

TEST_CASE("threads that declare, load and render at once disturb nobody") {
    declared(smoother());
    const std::uint64_t expected = rendered_hash(parsed(smoothed), 0.02, 1);
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 20; ++i) {
                tactus_error own;
                const Declaration type = smoother();
                const tactus_node_type given{sizeof(given),
                                             type.name,
                                             nullptr,
                                             type.inputs.data(),
                                             1,
                                             type.outputs.data(),
                                             2,
                                             type.parameters.data(),
                                             1,
                                             nullptr,
                                             type.prepare,
                                             type.process,
                                             type.release};
                if (tactus_declare_node(&given, &own) != 0) ++wrong;
                const Patch patch(tactus_parse(smoothed, nullptr, &own));
                tactus_options options{};
                options.size = sizeof(options);
                options.seconds = 0.02;
                const Run run(tactus_start(patch.get(), &options, &own));
                if (!run || tactus_render(run.get(), &own) != 0 || tactus_finish(run.get(), &own) != 0 ||
                    tactus_hash(run.get()) != expected)
                    ++wrong;
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == 0);
}

TEST_CASE("a declared node computes the force of a hand that the program advances") {
    declared({.name = "test_spring",
              .inputs = {{"pose", "pose", nullptr, nullptr, 0}},
              .outputs = {{"wrench", "wrench", nullptr, nullptr, 0}},
              .parameters = {{"stiffness", "0.2 N/mm", "0 N/mm", "1 N/mm", "of the spring"}},
              .process = [](void*, const tactus_block* block, tactus_error*) {
                  const double depth = std::max(0.0, -row<double>(block->inputs[0], 0)[2]);
                  row<double>(block->outputs[0], 0)[2] = block->parameters[0] * depth;
                  return 0;
              }});
    const Patch patch = parsed(R"(
wires = ["hand.pose -> spring.pose", "spring.wrench -> out.wrench"]
[devices.simulated]
driver = "scripted"
targets = "0 s: 0 0 60 mm"
[nodes]
hand = { type = "device_input", rate = "1 kHz" }
spring = { type = "test_spring", rate = "1 kHz", stiffness = "0.5 N/mm" }
out = { type = "device_output", rate = "1 kHz" }
)");
    const tactus_device device{8.0, 0.0, 2.0, 0.0};
    REQUIRE(tactus_attach_hand(patch.get(), "simulated", &device, &error) == 0);
    const Run run = started(patch);
    for (int tick = 0; tick < 2000; ++tick) {
        tactus_motion motion{};
        motion.position[2] = 0.005 - 1e-5 * std::min(tick, 700);
        tactus_move_hand(run.get(), 0, &motion);
        const int done = tactus_advance(run.get(), 0.001, &error);
        INFO(error.text);
        REQUIRE(done == 0);
    }
    std::array<double, 6> wrench{};
    tactus_hand_force(run.get(), 0, wrench.data());
    CHECK(wrench[2] == Approx(1.0).margin(1e-3));
}
