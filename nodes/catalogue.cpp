// SPDX-License-Identifier: Apache-2.0
// One line per node type, sorted. A test fails when a file of nodes/ is missing here.
#include "nodes/catalogue.hpp"

#include <algorithm>
#include <vector>

// name of the struct, family (folder), file
#define TACTUS_NODES(X)       \
    X(Actuator, vibration)    \
    X(AudioOutput, output)    \
    X(BladeContact, contact)  \
    X(Carve, contact)         \
    X(Constant, input)        \
    X(DeviceInput, input)     \
    X(DeviceOutput, input)    \
    X(DeviceWrench, input)    \
    X(Envelope, vibration)    \
    X(Equaliser, vibration)   \
    X(Filter, vibration)      \
    X(Gain, vibration)        \
    X(Magnitude, math)        \
    X(Mix, vibration)         \
    X(Probe, output)          \
    X(Range, math)            \
    X(Record, output)         \
    X(Saw, vibration)         \
    X(Sine, input)            \
    X(SphereContact, contact) \
    X(Spring, coupling)       \
    X(Sweep, input)           \
    X(Workspace, input)

namespace tactus {

namespace nodes {
#define X(Type, family) const NodeType& node_type_##Type();
TACTUS_NODES(X)
#undef X
}  // namespace nodes

Catalogue catalogue() {
    static const std::vector<const NodeType*> types = [] {
        std::vector<const NodeType*> all{
#define X(Type, family) &nodes::node_type_##Type(),
            TACTUS_NODES(X)
#undef X
        };
        std::ranges::sort(all, {}, &NodeType::name);
        return all;
    }();
    return types;
}

}  // namespace tactus
