// SPDX-License-Identifier: Apache-2.0
#include "tools/embed/host_node.hpp"

#include "graph/patch/patch_wire.hpp"
#include "graph/plugin/declaration.hpp"
#include "nodes/declare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::embed {

void CallbackFailure::note(Error failure) noexcept {
    {
        const std::lock_guard hold(lock_);
        if (first_) return;
        first_.emplace(std::move(failure));
    }
    stop_();
}

void CallbackFailure::check() const {
    const std::lock_guard hold(lock_);
    if (first_) throw Error(*first_);
}

namespace {

constexpr std::size_t pose_columns = 7;
// Rows of these types are read and written where they lie.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Twist) == 6 * sizeof(double) &&
              sizeof(Wrench) == 6 * sizeof(double) && sizeof(bool) == 1);

struct Port {
    std::string name, about, unit;
    const ValueType* type = nullptr;
    bool is_ramp = false, is_optional = false;
};

struct Parameter {
    std::string name, initial, lowest, highest, about;
};

/// A declared type. It is never freed: nodes, plans and summaries of runs refer to it.
struct HostNodeType {
    std::string name, about;
    std::vector<Port> inputs, outputs;
    std::vector<Parameter> parameters;
    tactus_node_type callbacks{};
    NodeType node;
};

/// A pose in the order of the columns: px, py, pz, qw, qx, qy, qz.
void put_pose(const std::byte* pose, double* row) { value::pose.to_columns(pose, row); }

Pose pose_of(const double* row) { return {{row[0], row[1], row[2]}, Quat(row[3], row[4], row[5], row[6])}; }

class HostNode {
public:
    explicit HostNode(const HostNodeType& type)
        : type_(type), inputs_(type.inputs.size()), outputs_(type.outputs.size()) {
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            const Port& port = type.inputs[i];
            inputs_[i].type = port.type;
            inputs_[i].about = port.about.c_str();
            inputs_[i].unit = port.unit.c_str();
            inputs_[i].is_optional = port.is_optional;
            inputs_[i].kind = port.is_ramp || port.type == &value::signal ? InputKind::stream : InputKind::value;
        }
        for (std::size_t i = 0; i < outputs_.size(); ++i) {
            outputs_[i].type = type.outputs[i].type;
            outputs_[i].about = type.outputs[i].about.c_str();
            outputs_[i].unit = type.outputs[i].unit.c_str();
        }
        for (const Parameter& made : type.parameters)
            params_.emplace_back(made.initial, made.lowest, made.highest, made.about.c_str());
    }
    ~HostNode() {
        if (is_prepared_ && type_.callbacks.release) type_.callbacks.release(state_);
    }
    HostNode(const HostNode&) = delete;
    HostNode& operator=(const HostNode&) = delete;

    void visit(MemberVisitor& visitor) {
        for (std::size_t i = 0; i < inputs_.size(); ++i) visitor.input(type_.inputs[i].name, inputs_[i]);
        for (std::size_t i = 0; i < outputs_.size(); ++i) visitor.output(type_.outputs[i].name, outputs_[i]);
        for (std::size_t i = 0; i < params_.size(); ++i) visitor.param(type_.parameters[i].name, params_[i]);
    }

    void prepare(const Setup& setup) {
        name_ = setup.name;
        where_ = setup.where;
        const auto frames = static_cast<std::size_t>(setup.max_frames);
        input_rows_.resize(inputs_.size());
        output_rows_.resize(outputs_.size());
        values_.resize(params_.size());
        input_poses_.resize(inputs_.size());
        output_poses_.resize(outputs_.size());
        for (std::size_t i = 0; i < inputs_.size(); ++i)
            if (inputs_[i].type == &value::pose) input_poses_[i].resize(frames * pose_columns);
        for (std::size_t i = 0; i < outputs_.size(); ++i) {
            if (outputs_[i].type == &value::pose) output_poses_[i].resize(frames * pose_columns);
            outputs_[i].type->make_default(last_.emplace_back().data());
        }
        state_ = type_.callbacks.context;
        if (type_.callbacks.prepare) {
            const tactus_setup given{setup.name.c_str(), setup.rate(), setup.max_frames, setup.seed};
            error_.text[0] = '\0';
            if (type_.callbacks.prepare(type_.callbacks.context, &given, &state_, &error_) != 0)
                throw Error(where_, message());
        }
        is_prepared_ = true;
    }

    void process(const Tick& tick) noexcept {
        hold_outputs(tick.frames);
        if (!has_failed_ && !call(tick)) {
            has_failed_ = true;
            hold_outputs(tick.frames);
            if (failure_) failure_->note(Error(where_, message()));
        }
        keep_outputs(tick.frames);
    }

    void report_to(CallbackFailure& failure) { failure_ = &failure; }

private:
    bool call(const Tick& tick) noexcept {
        for (std::size_t i = 0; i < inputs_.size(); ++i) input_rows_[i] = rows_of(i, tick.frames);
        for (std::size_t i = 0; i < params_.size(); ++i) values_[i] = params_[i].value;
        const tactus_block block{tick.index,         tick.rate(),         tick.frames,
                                 input_rows_.data(), output_rows_.data(), values_.data()};
        error_.text[0] = '\0';
        return type_.callbacks.process(state_, &block, &error_) == 0;
    }

    tactus_rows rows_of(std::size_t index, int frames) noexcept {
        const Input& port = inputs_[index];
        if (!port.connected) return {nullptr, 0};
        if (port.type == &value::pose) {
            double* const rows = input_poses_[index].data();
            for (int i = 0; i < frames; ++i)
                put_pose(port.data + i * port.stride, rows + static_cast<std::size_t>(i) * pose_columns);
            return {rows, pose_columns * sizeof(double)};
        }
        // The engine writes these values elsewhere; callbacks promise to read them only.
        return {const_cast<std::byte*>(port.data),
                port.type == &value::signal ? static_cast<std::ptrdiff_t>(sizeof(float)) : port.stride};
    }

    /// Fills each output with the last value before this block, so that a callback that leaves one alone holds it,
    /// whatever the partition into blocks. The memory of a signal is shared and must be filled anyway.
    void hold_outputs(int frames) noexcept {
        for (std::size_t k = 0; k < outputs_.size(); ++k) {
            const Output& port = outputs_[k];
            const std::size_t size = port.type->size;
            for (int i = 0; i < frames; ++i)
                std::memcpy(port.data + static_cast<std::size_t>(i) * size, last_[k].data(), size);
            output_rows_[k] = {port.data, static_cast<std::ptrdiff_t>(size)};
            if (port.type != &value::pose) continue;
            double* const rows = output_poses_[k].data();
            for (int i = 0; i < frames; ++i)
                put_pose(last_[k].data(), rows + static_cast<std::size_t>(i) * pose_columns);
            output_rows_[k] = {rows, pose_columns * sizeof(double)};
        }
    }

    void keep_outputs(int frames) noexcept {
        for (std::size_t k = 0; k < outputs_.size(); ++k) {
            const Output& port = outputs_[k];
            const std::size_t size = port.type->size;
            for (int i = 0; i < frames; ++i) {
                std::byte* const value = port.data + static_cast<std::size_t>(i) * size;
                if (port.type == &value::pose) {
                    const Pose pose = pose_of(output_poses_[k].data() + static_cast<std::size_t>(i) * pose_columns);
                    std::memcpy(value, &pose, size);
                } else if (port.type == &value::boolean) {
                    *value = *value == std::byte{0} ? std::byte{0} : std::byte{1};  // another byte is no bool
                }
            }
            std::memcpy(last_[k].data(), port.data + static_cast<std::size_t>(frames - 1) * size, size);
        }
    }

    std::string message() {
        error_.text[sizeof(error_.text) - 1] = '\0';
        return fmt::format("node '{}' of type '{}': {}", name_, type_.name,
                           error_.text[0] ? error_.text : "its callback failed and gave no reason");
    }

    const HostNodeType& type_;
    std::vector<Input> inputs_;
    std::vector<Output> outputs_;
    std::deque<Param> params_;  // a Param does not move
    std::vector<tactus_rows> input_rows_, output_rows_;
    std::vector<double> values_;  // of the parameters
    std::vector<std::vector<double>> input_poses_, output_poses_;  // in the order of columns; empty for other types
    struct alignas(Pose) Value : std::array<std::byte, sizeof(Pose)> {};
    std::vector<Value> last_;  // of each output
    std::string name_;
    SourceLocation where_;
    void* state_ = nullptr;
    tactus_error error_{};
    CallbackFailure* failure_ = nullptr;
    bool is_prepared_ = false, has_failed_ = false;
};
static_assert(sizeof(Pose) >= sizeof(Wrench));

// NodeType::create has no argument by which it could find its declaration, and a function that is made at run time is
// no plain function pointer: each name has a function of its own, made here in advance.
// Slot 0 is of the declaration that is being checked.
constexpr std::size_t max_types = 256;
std::array<std::atomic<const HostNodeType*>, max_types + 1> slots;

template <std::size_t slot>
void* create() {
    return new HostNode(*slots[slot].load(std::memory_order_acquire));
}

template <std::size_t... slot>
constexpr std::array<void* (*)(), sizeof...(slot)> creators_of(std::index_sequence<slot...>) {
    return {&create<slot>...};
}
constexpr auto creators = creators_of(std::make_index_sequence<max_types + 1>());

void process(void* node, const Tick& tick) noexcept { static_cast<HostNode*>(node)->process(tick); }

std::string text_of(const char* text) { return text ? text : ""; }

std::string name_of(const char* text, std::string_view what) {
    std::string name = text_of(text);
    if (!patch::is_name(name))
        throw Error(fmt::format("{} cannot be called '{}': a name has letters, digits, '_' and '-'", what, name));
    return name;
}

Port port_of(const tactus_port& given, bool is_input) {
    Port port{
        name_of(given.name, "a port"), text_of(given.about), text_of(given.unit), nullptr, false, given.optional != 0};
    const std::string type = text_of(given.type);
    port.is_ramp = is_input && type == "ramp";
    std::vector<std::string> names;
    for (const ValueType* plain : value::plain_types()) {
        if (plain->name == (port.is_ramp ? "number" : type)) port.type = plain;
        names.emplace_back(plain->name);
    }
    if (is_input) names.emplace_back("ramp");
    if (!port.type)
        throw Error(fmt::format("port '{}': type '{}' is not one of {}", port.name, type, fmt::join(names, ", ")));
    const bool has_own_unit = port.type == &value::number || port.type == &value::signal || port.type == &value::vector;
    if (!port.unit.empty() && !has_own_unit)
        throw Error(fmt::format("port '{}': {} has the units of its type; state no unit", port.name,
                                value::with_article(*port.type)));
    return port;
}

template <class Given>
std::span<const Given> list_of(const Given* first, int count, std::string_view what) {
    if (count < 0 || count > 1000 || (count > 0 && !first))
        throw Error(fmt::format("a list of {} {} cannot be read", count, what));
    return {first, static_cast<std::size_t>(count)};
}

std::unique_ptr<HostNodeType> read(const tactus_node_type& given) {
    auto type = std::make_unique<HostNodeType>();
    type->name = name_of(given.name, "a node type");
    type->about = text_of(given.about);
    if (type->about.empty()) type->about = "A node of this program.";
    type->callbacks = given;
    try {
        if (!given.process) throw Error("it has no callback 'process'");
        for (const tactus_port& port : list_of(given.inputs, given.input_count, "inputs"))
            type->inputs.push_back(port_of(port, true));
        for (const tactus_port& port : list_of(given.outputs, given.output_count, "outputs"))
            type->outputs.push_back(port_of(port, false));
        for (const tactus_parameter& p : list_of(given.parameters, given.parameter_count, "parameters")) {
            const Parameter& made =
                type->parameters.emplace_back(Parameter{name_of(p.name, "a parameter"), text_of(p.initial),
                                                        text_of(p.lowest), text_of(p.highest), text_of(p.about)});
            try {
                static_cast<void>(Param(made.initial, made.lowest, made.highest));
            } catch (const Error& error) {
                throw Error(fmt::format("parameter '{}': {}", made.name, error.message()));
            }
        }
    } catch (const Error& error) {
        throw Error(fmt::format("node type '{}': {}", type->name, error.message()));
    }
    return type;
}

/// The slot of this name, or a free one.
std::size_t slot_of(const std::string& name) {
    for (std::size_t slot = 1; slot <= max_types; ++slot) {
        const HostNodeType* const known = slots[slot];
        if (!known || known->name == name) return slot;
    }
    throw Error(fmt::format("node type '{}': a program may declare {} types", name, max_types));
}

}  // namespace

void declare_node(const tactus_node_type& given) {
    static std::mutex lock;
    std::unique_ptr<HostNodeType> type = read(given);
    const std::lock_guard hold(lock);
    const std::size_t slot = slot_of(type->name);
    type->node = {
        .name = type->name,
        .about = type->about,
        .shapes_values = true,
        .create = creators[0],
        .destroy = [](void* node) { delete static_cast<HostNode*>(node); },
        .visit = [](void* node, MemberVisitor& visitor) { static_cast<HostNode*>(node)->visit(visitor); },
        .prepare = [](void* node, const Setup& setup) { static_cast<HostNode*>(node)->prepare(setup); },
        .process = process,
        .report = [](const void*, Report&) {},
    };
    slots[0] = type.get();
    try {
        plugin::check_declaration(type->node);
        type->node.create = creators[slot];
        const HostNodeType* const before = slots[slot].exchange(type.get());
        try {
            nodes::declare(type->node);
        } catch (...) {
            slots[slot] = before;
            throw;
        }
    } catch (const Error& error) {
        throw Error(fmt::format("node type '{}': {}", type->name, error.message()));
    }
    static_cast<void>(type.release());
}

void admit_host_nodes(const compile::Schedule& plan, bool is_live, CallbackFailure& failure) {
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (node.type->process != process) continue;
        if (is_live)
            throw Error(
                node.where,
                fmt::format("node '{}' of type '{}' is a callback of this program, which may wait: it cannot run "
                            "live. Render the patch or advance it, or write the node in C++",
                            node.name, node.type->name));
        static_cast<HostNode*>(node.instance.get())->report_to(failure);
    }
}

}  // namespace tactus::embed
