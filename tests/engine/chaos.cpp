// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/chaos.hpp"

#include "nodes/catalogue.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tactus::test {

/// x ← 3.9 x (1 − x), nudged by what comes in.
struct Chaos {
    static constexpr auto about = "Logistic map.";

    In<double> in{optional, "nudge"};
    In<double> other{optional, "nudge"};
    Out<double> out{"x"};
    Out<Pose> pose{"x as a pose"};
    Param gain{"0.01", "0", "1", "size of the nudges"};
    Param work{discrete, "0", "0", "100000", "iterations of useless work"};

    void prepare(const Setup& setup) {
        x_ = 0.2 + 0.5 * Random{setup.seed}.uniform(0);
        out = x_;
    }
    void process(const Tick& tick) noexcept {
        double sink = x_;
        for (int i = 0; i < static_cast<int>(work); ++i) sink = std::sqrt(sink + 1.0);
        const double nudge = std::fmod(std::abs(in + other), 1.0) * gain + 1e-300 * sink;
        x_ = 3.9 * x_ * (1.0 - x_) * (1.0 - gain) + nudge * 0.2;
        x_ = std::clamp(x_, 0.01, 0.99);
        out = x_ + 1e-6 * static_cast<double>(tick.elapsed / tick.period);
        pose.get().position = Vec3(x_, 0.0, 0.0);
    }
    double x_ = 0.3;
};
TACTUS_NODE(Chaos, in, other, out, pose, gain, work)

/// A chaotic signal; its gain glides in from a slower group.
struct ChaosSignal {
    static constexpr auto about = "Logistic map per sample.";

    In<Ramp> glide{optional, "nudge"};
    In<double> held{optional, "nudge"};
    Out<Signal> signal{"x"};
    Out<double> level{"x"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) {
            x_ = 3.9 * x_ * (1.0 - x_) * 0.98 + 0.01 * std::fmod(std::abs(glide[i] + held), 1.0);
            signal[i] = static_cast<float>(x_);
            level[i] = x_;
        }
    }
    double x_ = 0.3;
};
TACTUS_NODE(ChaosSignal, glide, held, signal, level)

/// Sums what a batch brings.
struct BatchSum {
    static constexpr auto about = "Sum over a batch, order-dependent.";

    Batch<Pose> path{"path"};
    Batch<Signal> sound{optional, "sound"};
    Out<double> sum{"running sum"};
    Out<double> count{"values seen"};

    void process(const Tick&) noexcept {
        for (std::size_t i = 0; i < path.values().size(); ++i) {
            sum_ = std::fmod(
                sum_ * 1.7 + path.values()[i].position.x + 1e-9 * static_cast<double>(path.sample_times()[i]), 1.0);
            ++count_;
        }
        for (const float s : sound.values()) sum_ = std::fmod(sum_ * 1.3 + static_cast<double>(s), 1.0);
        sum = sum_;
        count = count_;
    }
    double sum_ = 0.0, count_ = 0.0;
};
TACTUS_NODE(BatchSum, path, sound, sum, count)

/// Pulls to the origin with 1 N/mm and 2 N·m/rad, and does something bad at a tick.
struct Planted {
    static constexpr auto about = "A spring with a planted fault.";

    In<Pose> pose{"of the hand", "m"};
    Out<Wrench> wrench{"on the hand", "N, N m"};
    Choice fault{{"none", "nan", "inf", "spike", "stall"}, "what happens"};
    Param at{discrete, "500", "0", "1e6", "in which tick it happens"};
    Param stall{"0 ms", "0 ms", "10 s", "how long the tick then lasts"};

    void process(const Tick& tick) noexcept {
        const Quat& q = pose->orientation;
        Wrench w{-1000.0 * pose->position, Vec3(q.x, q.y, q.z) * (q.w < 0.0 ? 4.0 : -4.0)};
        const auto now = static_cast<double>(tick.index);
        if (now == at && fault.is("nan")) w.torque.y = std::numeric_limits<double>::quiet_NaN();
        if (now == at && fault.is("inf")) w.force.z = -std::numeric_limits<double>::infinity();
        if (now >= at && now < at + 3 && fault.is("spike")) w.force.x = 1000.0;
        if (now == at && fault.is("stall")) {
            const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(stall.value);
            while (std::chrono::steady_clock::now() < end) {
            }
        }
        wrench = w;
    }
};
TACTUS_NODE(Planted, pose, wrench, fault, at, stall)

std::atomic<VirtualClock*> busy_clock{nullptr};

/// Uses the processor for some time in each tick of an interval.
struct Busy {
    static constexpr auto about = "A node that is busy.";

    Out<double> out{"0"};
    Param from{"0 s", "0 s", "1 h", "when it begins"};
    Param lasts{"0 s", "0 s", "1 h", "for how long"};
    Param cost{"0 ms", "0 ms", "10 s", "of a tick in that time"};

    void process(const Tick& tick) noexcept {
        out = 0.0;
        if (tick.time_seconds() < from || tick.time_seconds() >= from + lasts) return;
        if (VirtualClock* const clock = busy_clock) return clock->compute(std::llround(cost * 1e9));
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(cost.value);
        while (std::chrono::steady_clock::now() < end) {
        }
    }
};
TACTUS_NODE(Busy, out, from, lasts, cost)

/// A pose that does not move.
struct Still {
    static constexpr auto about = "A fixed pose.";

    Out<Pose> pose{"fixed", "m"};
    Param height{"0 mm", "-1 m", "1 m", "of the position"};

    void process(const Tick&) noexcept { pose = Pose{Vec3(0.0, 0.0, height.value), Quat(1.0, 0.0, 0.0, 0.0)}; }
};
TACTUS_NODE(Still, pose, height)

/// Behind a call that the compiler cannot see through: a throw in a function that may not throw is a warning.
[[gnu::noinline]] static void throw_error() { throw std::runtime_error("a planted error"); }

/// Fails at a time, in one of two ways, and from then on.
struct Faulty {
    static constexpr auto about = "A node that fails.";

    Out<Pose> pose{"rest, then none", "m"};
    Out<Wrench> wrench{"zero, then NaN", "N, N m"};
    Out<double> number{"zero, then NaN"};
    Choice fault{{"nan", "throw"}, "what happens"};
    Param from{"0 s", "0 s", "1 h", "when it happens"};
    Param until{"1 h", "0 s", "1 h", "when it is over"};

    void process(const Tick& tick) noexcept {
        const bool fails = tick.time_seconds() >= from && tick.time_seconds() < until;
        if (fails && fault.is("throw")) throw_error();
        const double value = fails ? std::numeric_limits<double>::quiet_NaN() : 0.0;
        pose = Pose{Vec3(value), Quat(1.0, 0.0, 0.0, 0.0)};
        wrench = Wrench{Vec3(value), Vec3(value)};
        number = value;
    }
};
TACTUS_NODE(Faulty, pose, wrench, number, fault, from, until)

static std::vector<double> kept;

const std::vector<double>& kept_values() { return kept; }

/// Keeps what it sees.
struct Keeper {
    static constexpr auto about = "Keeps what it sees.";

    In<double> number{optional, "a number"};
    In<Wrench> wrench{optional, "a force", "N, N m"};

    void prepare(const Setup&) { kept.clear(); }
    void process(const Tick&) noexcept { kept.push_back(wrench.connected ? glm::length(wrench->force) : number.get()); }
};
TACTUS_NODE(Keeper, number, wrench)

compile::Catalogue chaos_catalogue() {
    static const std::vector<const NodeType*> types = [] {
        const compile::Catalogue all = nodes::catalogue();
        std::vector<const NodeType*> with(all.begin(), all.end());
        for (const NodeType* type :
             {&node_type_Chaos(), &node_type_ChaosSignal(), &node_type_BatchSum(), &node_type_Planted(),
              &node_type_Still(), &node_type_Keeper(), &node_type_Busy(), &node_type_Faulty()})
            with.push_back(type);
        return with;
    }();
    return types;
}

std::string PatchText::toml() const {
    std::string text = "wires = [\n";
    for (const std::string& wire : wires) text += "  \"" + wire + "\",\n";
    text += "]\n" + extra + "\n";
    for (const Node& node : nodes) {
        text += "[nodes." + node.name + "]\ntype = \"" + node.type + "\"\nrate = \"" + node.rate + "\"\n";
        for (const auto& [key, value] : node.settings) text += key + " = \"" + value + "\"\n";
    }
    return text;
}

std::string four_rates() {
    return PatchText{
        {{"a", "chaos", "1 kHz", {}},
         {"b", "chaos", "1 kHz", {}},
         {"slow", "chaos", "60 Hz", {}},
         {"grip", "chaos", "150 Hz", {}},
         {"voice", "chaos_signal", "48 kHz", {}},
         {"loud", "gain", "48 kHz", {}},
         {"path", "batch_sum", "60 Hz", {}}},
        {"a.out -> b.in", "b.out -> a.other as delay 2", "slow.out -> a.in as linear", "grip.out -> b.other",
         "a.out -> slow.in", "path.sum -> slow.other", "b.out -> grip.in", "slow.out -> grip.other",
         "a.out -> voice.glide as linear", "grip.out -> voice.held", "voice.signal -> loud.in", "b.out -> loud.factor",
         "voice.level -> slow.gain", "b.pose -> path.path as batch", "loud.out -> path.sound as batch"},
        "seed = 7"}
        .toml();
}

}  // namespace tactus::test
