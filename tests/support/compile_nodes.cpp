// SPDX-License-Identifier: Apache-2.0
#include "tests/support/compile_nodes.hpp"

#include "graph/node/node.hpp"

#include <array>

namespace tactus {

namespace {

struct Source {
    static constexpr auto about = "A number.";
    Out<double> value{"value"};
    Param level{"1 N", "0 N", "10 N", "level"};
    Param memory{structural, "1", "1", "9", "memory"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Source, value, level, memory)

struct Relay {
    static constexpr auto about = "Passes a number on.";
    In<double> in{"in"};
    Out<double> out{"out"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Relay, in, out)

struct Sum {
    static constexpr auto about = "Adds two numbers.";
    In<double> a{"first"};
    In<double> b{optional, "second"};
    Out<double> out{"sum"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Sum, a, b, out)

struct Stiff {
    static constexpr auto about = "A spring.";
    In<double> in{"distance"};
    Out<double> out{"force"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "force per distance"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Stiff, in, out, stiffness)

struct Wave {
    static constexpr auto about = "A signal.";
    Out<Signal> out{"signal"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Wave, out)

struct Gain {
    static constexpr auto about = "Multiplies a signal.";
    In<Signal> in{"signal"};
    Out<Signal> out{"product"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Gain, in, out)

struct Path {
    static constexpr auto about = "Takes every value.";
    Batch<double> values{"values"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Path, values)

struct Truth {
    static constexpr auto about = "True or false.";
    Out<bool> out{"truth"};
    In<bool> in{optional, "truth"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Truth, out, in)

struct Pair {
    static constexpr auto about = "Two values of one type.";
    AnyIn a{"first", kinds::number | kinds::signal};
    AnyIn b{optional, "second", kinds::number | kinds::signal};
    AnyOut out{"both"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Pair, a, b, out)

struct DeviceInput {
    static constexpr auto about = "Where a path begins.";
    static constexpr NodeRole role = NodeRole::hand_source;
    Out<double> out{"value"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(DeviceInput, out)

struct DeviceOutput {
    static constexpr auto about = "Where a path ends.";
    static constexpr NodeRole role = NodeRole::hand_sink;
    In<double> in{"value"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(DeviceOutput, in)

}  // namespace

compile::Catalogue test_catalogue() {
    static const std::array types{&node_type_Source(),      &node_type_Relay(),       &node_type_Sum(),
                                  &node_type_Wave(),        &node_type_Gain(),        &node_type_Path(),
                                  &node_type_Truth(),       &node_type_Pair(),        &node_type_Stiff(),
                                  &node_type_DeviceInput(), &node_type_DeviceOutput()};
    return types;
}

}  // namespace tactus
