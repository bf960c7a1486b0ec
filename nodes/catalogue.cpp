// SPDX-License-Identifier: Apache-2.0
// One line per node type, sorted. A test fails when a file of nodes/ is missing here.
#include "nodes/catalogue.hpp"

#include "dsp/core/error.hpp"
#include "graph/plugin/plugins.hpp"
#include "nodes/declare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

// name of the struct, family (folder), file
#define TACTUS_NODES(X)                 \
    X(Absolute, math)                   \
    X(Actuator, vibration)              \
    X(Add, math)                        \
    X(AdmittanceController, admittance) \
    X(Adsr, time)                       \
    X(And, logic)                       \
    X(Angle, geometry)                  \
    X(AudioInput, device)               \
    X(AudioOutput, device)              \
    X(BladeContact, contact)            \
    X(Body, contact)                    \
    X(BoxGuide, guide)                  \
    X(Brush, plan)                      \
    X(Burr, contact)                    \
    X(Button, device)                   \
    X(ButtonEvents, event)              \
    X(Carve, contact)                   \
    X(CaseScene, plan)                  \
    X(Clip, math)                       \
    X(Clock, logic)                     \
    X(Comb, vibration)                  \
    X(Compare, logic)                   \
    X(Compose, geometry)                \
    X(Compressor, vibration)            \
    X(Constant, math)                   \
    X(ContactEvents, event)             \
    X(Counter, logic)                   \
    X(Cross, geometry)                  \
    X(Curve, math)                      \
    X(Debounce, logic)                  \
    X(Delay, time)                      \
    X(Detents, guide)                   \
    X(DeviceInput, device)              \
    X(DeviceOutput, device)             \
    X(DeviceWrench, device)             \
    X(Dial, guide)                      \
    X(Differentiate, time)              \
    X(DirectCoupling, coupling)         \
    X(Distance, geometry)               \
    X(Divide, math)                     \
    X(Dot, geometry)                    \
    X(DynamicCoupling, coupling)        \
    X(Edge, logic)                      \
    X(Envelope, vibration)              \
    X(Equaliser, vibration)             \
    X(EventCounter, event)              \
    X(EventDelay, event)                \
    X(EventFilter, event)               \
    X(EventTrigger, event)              \
    X(EventValue, event)                \
    X(Expression, math)                 \
    X(Filter, vibration)                \
    X(ForceShaping, coupling)           \
    X(ForceTone, vibration)             \
    X(FragmentMatcher, plan)            \
    X(Gain, vibration)                  \
    X(Gate, logic)                      \
    X(GrantedPower, device)             \
    X(Grasp, coupling)                  \
    X(GripperInput, admittance)         \
    X(GripperOutput, admittance)        \
    X(GuideSeat, training)              \
    X(HandCoupling, coupling)           \
    X(HeldWeight, admittance)           \
    X(Impact, vibration)                \
    X(Insertion, contact)               \
    X(Integrate, time)                  \
    X(Interpolate, geometry)            \
    X(Inverse, geometry)                \
    X(JoinPose, geometry)               \
    X(JoinTwist, geometry)              \
    X(JoinVector, geometry)             \
    X(JoinWrench, geometry)             \
    X(KerfHeat, contact)                \
    X(Latch, logic)                     \
    X(LineGuide, guide)                 \
    X(LookAt, geometry)                 \
    X(Magnitude, math)                  \
    X(Maximum, math)                    \
    X(Minimum, math)                    \
    X(Mix, vibration)                   \
    X(Multiply, math)                   \
    X(Negate, math)                     \
    X(Noise, vibration)                 \
    X(Normalise, geometry)              \
    X(Not, logic)                       \
    X(OnePole, vibration)               \
    X(Onset, event)                     \
    X(OpenigtlinkOutput, device)        \
    X(Or, logic)                        \
    X(Oscillator, vibration)            \
    X(Panner, vibration)                \
    X(PassivityObserver, coupling)      \
    X(PathGuide, guide)                 \
    X(PlanFrame, training)              \
    X(PlaneGuide, guide)                \
    X(PlannedPlace, plan)               \
    X(Player, vibration)                \
    X(PointGuide, guide)                \
    X(PointProxy, coupling)             \
    X(Probe, record)                    \
    X(QuasiStaticCoupling, coupling)    \
    X(Ramp, time)                       \
    X(RandomNumber, time)               \
    X(Range, math)                      \
    X(Record, record)                   \
    X(Rotate, geometry)                 \
    X(SampleAndHold, logic)             \
    X(Saw, vibration)                   \
    X(SawBlade, contact)                \
    X(Scene, contact)                   \
    X(Select, logic)                    \
    X(Sequencer, logic)                 \
    X(Shape, contact)                   \
    X(SimulatedHead, device)            \
    X(Sine, math)                       \
    X(Slew, time)                       \
    X(SlowOscillator, time)             \
    X(Smooth, time)                     \
    X(SnapToFit, coupling)              \
    X(SpectralMonitor, vibration)       \
    X(SpectrumAnalyser, vibration)      \
    X(SphereContact, contact)           \
    X(SphereProxy, coupling)            \
    X(SplitPose, geometry)              \
    X(SplitTwist, geometry)             \
    X(SplitVector, geometry)            \
    X(SplitWrench, geometry)            \
    X(Spring, coupling)                 \
    X(StateVariable, vibration)         \
    X(Subtract, math)                   \
    X(Sweep, vibration)                 \
    X(Task, training)                   \
    X(TestRig, admittance)              \
    X(ThresholdEvents, event)           \
    X(Timer, logic)                     \
    X(ToNumber, math)                   \
    X(ToSignal, math)                   \
    X(TransformPoint, geometry)         \
    X(TumourMargin, plan)               \
    X(Vessel, plan)                     \
    X(Viscosity, guide)                 \
    X(VoxmapContact, contact)           \
    X(Workspace, device)                \
    X(Wrap, math)                       \
    X(WrenchSum, geometry)              \
    X(Xor, logic)

namespace tactus::nodes {

namespace {

/// The file of a plug-in, or "Tactus".
std::string origin_of(const NodeType& type) {
    const plugin::Plugin* const of = plugin::plugin_of(type);
    return of ? of->file.string() : "Tactus";
}

void add(const plugin::Plugin& plugin, std::vector<const NodeType*>& all) {
    for (const NodeType* type : plugin.types) {
        const auto known = std::ranges::find(all, type->name, &NodeType::name);
        if (known == all.end()) {
            all.push_back(type);
            continue;
        }
        throw Error(fmt::format(
            "{}: {} has a node type '{}' already; give the struct another name, or leave out one of the two",
            plugin.file.string(), origin_of(**known), type->name));
    }
}

}  // namespace

#define X(Type, family) const NodeType& node_type_##Type();
TACTUS_NODES(X)
#undef X

namespace {

using Types = std::vector<const NodeType*>;

/// Every table that was ever current: callers may still read it.
struct Tables {
    std::mutex lock;
    std::deque<Types> all;
    std::vector<const NodeType*> declared;
    std::atomic<const Types*> current;
};

Tables& tables() {
    static Tables& made = []() -> Tables& {
        Types all{
#define X(Type, family) &node_type_##Type(),
            TACTUS_NODES(X)
#undef X
        };
        for (const plugin::Plugin& plugin : plugin::all()) add(plugin, all);
        std::ranges::sort(all, {}, &NodeType::name);
        auto& first = *new Tables;  // never destroyed: threads may outlive static objects
        first.current = &first.all.emplace_back(std::move(all));
        return first;
    }();
    return made;
}

}  // namespace

compile::Catalogue catalogue() { return *tables().current.load(std::memory_order_acquire); }

void declare(const NodeType& type) {
    Tables& known = tables();
    const std::lock_guard hold(known.lock);
    Types next = *known.current.load(std::memory_order_relaxed);
    const auto at = std::ranges::lower_bound(next, type.name, {}, &NodeType::name);
    if (at == next.end() || (*at)->name != type.name) {
        next.insert(at, &type);
    } else {
        if (std::ranges::find(known.declared, *at) == known.declared.end())
            throw Error(fmt::format("{} has a type of this name already; choose another one", origin_of(**at)));
        *at = &type;
    }
    known.declared.push_back(&type);
    known.current.store(&known.all.emplace_back(std::move(next)), std::memory_order_release);
}

}  // namespace tactus::nodes
