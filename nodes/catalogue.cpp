// SPDX-License-Identifier: Apache-2.0
// One line per node type, sorted. A test fails when a file of nodes/ is missing here.
#include "nodes/catalogue.hpp"

#include <algorithm>
#include <vector>

// name of the struct, family (folder), file
#define TACTUS_NODES(X)                 \
    X(Actuator, vibration)              \
    X(AdmittanceController, admittance) \
    X(AudioOutput, device)              \
    X(BladeContact, contact)            \
    X(Body, contact)                    \
    X(Brush, planning)                  \
    X(Burr, contact)                    \
    X(Button, device)                   \
    X(Carve, contact)                   \
    X(CaseScene, planning)              \
    X(Constant, math)                   \
    X(DeviceInput, device)              \
    X(DeviceOutput, device)             \
    X(DeviceWrench, device)             \
    X(DirectCoupling, coupling)         \
    X(DynamicCoupling, coupling)        \
    X(Envelope, vibration)              \
    X(Equaliser, vibration)             \
    X(Filter, vibration)                \
    X(ForceShaping, coupling)           \
    X(FragmentMatcher, planning)        \
    X(Gain, vibration)                  \
    X(GrantedPower, device)             \
    X(Grasp, coupling)                  \
    X(GripperInput, admittance)         \
    X(GripperOutput, admittance)        \
    X(HeldWeight, admittance)           \
    X(Insertion, contact)               \
    X(KerfHeat, contact)                \
    X(Magnitude, math)                  \
    X(Mix, vibration)                   \
    X(PassivityObserver, coupling)      \
    X(PlanFrame, training)              \
    X(PointProxy, coupling)             \
    X(Probe, record)                    \
    X(QuasiStaticCoupling, coupling)    \
    X(Range, math)                      \
    X(Record, record)                   \
    X(Saw, vibration)                   \
    X(SawBlade, contact)                \
    X(Scene, contact)                   \
    X(Shape, contact)                   \
    X(SimulatedHead, device)            \
    X(Sine, math)                       \
    X(SnapToFit, coupling)              \
    X(SpectralMonitor, vibration)       \
    X(SpectrumAnalyser, vibration)      \
    X(SphereContact, contact)           \
    X(SphereProxy, coupling)            \
    X(Spring, coupling)                 \
    X(Sweep, vibration)                 \
    X(Task, training)                   \
    X(TestRig, admittance)              \
    X(VoxmapContact, contact)           \
    X(Workspace, device)

namespace tactus::nodes {

#define X(Type, family) const NodeType& node_type_##Type();
TACTUS_NODES(X)
#undef X

compile::Catalogue catalogue() {
    static const std::vector<const NodeType*> types = [] {
        std::vector<const NodeType*> all{
#define X(Type, family) &node_type_##Type(),
            TACTUS_NODES(X)
#undef X
        };
        std::ranges::sort(all, {}, &NodeType::name);
        return all;
    }();
    return types;
}

}  // namespace tactus::nodes
