// SPDX-License-Identifier: Apache-2.0
#include "tests/support/node_harness.hpp"

#include "dsp/core/random.hpp"
#include "dsp/core/realtime.hpp"
#include "nodes/catalogue.hpp"
#include "tests/support/node_values.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test {

namespace {

/// Activations for which a value or a parameter stays the same: calls are cut there, as the engine does.
constexpr std::int64_t hold = 24;
constexpr int max_in_batch = 20;

const NodeType& find_type(std::string_view name) {
    for (const NodeType* type : nodes::catalogue())
        if (type->name == name) return *type;
    throw Error("no node type '" + std::string(name) + "' in the catalogue");
}

}  // namespace

MemoryStream::MemoryStream(StreamFormat format_, std::size_t capacity) : format(std::move(format_)), bytes(capacity) {}

bool MemoryStream::write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept {
    gapless = gapless && first == expected;
    expected = first + static_cast<std::int64_t>(count);
    const std::size_t size = format.type->size;
    if (used + count * size > bytes.size()) return false;
    const auto* from = static_cast<const std::byte*>(values);
    for (std::size_t i = 0; i < count; ++i, used += size)
        std::memcpy(bytes.data() + used, from + static_cast<std::ptrdiff_t>(i) * stride, size);
    return true;
}

DevicePort& FakeHost::device(const std::string& name, DeviceUse use, const SourceLocation&) {
    auto& port = devices[name];
    driven = driven || use == DeviceUse::drive;
    if (!port) {
        port = std::make_unique<DevicePort>();
        port->info.fingers = 2;
        port->info.max_speed = 0.07;
    }
    return *port;
}

RecordStream& FakeHost::record(const StreamFormat& format, const SourceLocation&) {
    return *records.emplace_back(std::make_unique<MemoryStream>(format, 1 << 21));
}

RecordStream& FakeHost::audio(const StreamFormat& format, const SoundPlace&) {
    return *sounds.emplace_back(std::make_unique<MemoryStream>(format, 1 << 21));
}

RecordStream& FakeHost::send(const StreamFormat& format, const SourceLocation& where) { return record(format, where); }

const SoundInPort& FakeHost::listen(const SoundPlace& place, Flicks, std::optional<std::vector<float>>) {
    SoundInPort& port = *heard.emplace_back(std::make_unique<SoundInPort>());
    port.samples.resize(static_cast<std::size_t>(place.max_frames));
    return port;
}

struct NodeHarness::InputSlot {
    std::string name;
    Input* port;
    std::function<void(std::int64_t, void*)> function;
    std::vector<std::byte> buffer;
    std::vector<Flicks> times;
};

struct NodeHarness::OutputSlot {
    std::string name;
    Output* port;
    std::vector<std::byte> buffer, trace;
};

struct NodeHarness::Members final : MemberVisitor {
    void input(std::string_view name, Input& port) override {
        inputs.push_back({std::string(name), &port, {}, {}, {}});
    }
    void output(std::string_view name, Output& port) override { outputs.push_back({std::string(name), &port, {}, {}}); }
    void param(std::string_view name, Param& p) override {
        params.emplace_back(name, &p);
        setters[std::string(name)] = [&p](std::string_view text) { p.set(text); };
    }
    void choice(std::string_view name, Choice& c) override {
        setters[std::string(name)] = [&c](std::string_view text) { c.set(text); };
    }
    void text(std::string_view name, Text& t) override {
        setters[std::string(name)] = [&t](std::string_view text) { t.value = text; };
    }
    void flag(std::string_view name, Flag& f) override {
        setters[std::string(name)] = [&f](std::string_view text) { f.set(text); };
    }
    void vector(std::string_view name, Vector& v) override {
        setters[std::string(name)] = [&v](std::string_view text) { v.set(text); };
    }
    void asset(std::string_view name, AssetParam& a) override { assets[std::string(name)] = &a; }

    std::vector<InputSlot> inputs;
    std::vector<OutputSlot> outputs;
    std::vector<std::pair<std::string, Param*>> params;
    std::map<std::string, std::function<void(std::string_view)>> setters;
    std::map<std::string, AssetParam*> assets;
};

NodeHarness::NodeHarness(const NodeType& type, Options options)
    : options_(options), type_(type), node_(type.create()), members_(std::make_unique<Members>()) {
    flush_denormals_to_zero();
    type_.visit(node_, *members_);
    for (InputSlot& input : members_->inputs) {
        Input& port = *input.port;
        port.connected = true;
        if (port.kind == InputKind::any) port.type = options_.any;
        takes_blocks_ |= port.kind == InputKind::stream || (port.kind == InputKind::any && port.type == &value::signal);
    }
    for (const OutputSlot& output : members_->outputs)
        if (output.port->type == &value::undecided) output.port->type = options_.any;
    for (const OutputSlot& output : members_->outputs) takes_blocks_ |= output.port->type == &value::signal;
    for (auto& [name, asset] : members_->assets)
        if (!asset->is_optional) asset->loaded = sample_asset(asset->type_name);
    device_feed = [this](std::int64_t k, DevicePort& port) {
        port.sample = sample_device(Random{options_.seed}, k, options_.feed);
    };
}

NodeHarness::NodeHarness(std::string_view type_name, Options options) : NodeHarness(find_type(type_name), options) {}

NodeHarness::~NodeHarness() { type_.destroy(node_); }

NodeHarness& NodeHarness::set(const std::string& param, std::string_view text) {
    members_->setters.at(param)(text);
    return *this;
}

NodeHarness& NodeHarness::set_value(const std::string& name, double value) {
    for (auto& [known, param] : members_->params)
        if (known == name) {
            if (!(value >= param->min && value <= param->max)) throw Error("'" + name + "' is out of range");
            param->value = value;
            return *this;
        }
    throw Error("no parameter '" + name + "'");
}

NodeHarness& NodeHarness::asset(const std::string& param, std::shared_ptr<const void> loaded) {
    members_->assets.at(param)->loaded = std::move(loaded);
    return *this;
}

NodeHarness& NodeHarness::disconnect(const std::string& name) {
    for (InputSlot& input : members_->inputs)
        if (input.name == name) {
            if (!input.port->is_optional) throw Error("input '" + name + "' is not optional");
            input.port->connected = false;
            return *this;
        }
    throw Error("no input '" + name + "'");
}

NodeHarness& NodeHarness::connect(const std::string& name) {
    for (InputSlot& input : members_->inputs)
        if (input.name == name) {
            input.port->connected = true;
            return *this;
        }
    throw Error("no input '" + name + "'");
}

NodeHarness& NodeHarness::disconnect_optional() {
    for (InputSlot& input : members_->inputs)
        if (input.port->is_optional) input.port->connected = false;
    return *this;
}

void NodeHarness::forget() {
    for (OutputSlot& output : members_->outputs) output.trace.clear();
    hash_ = {};
    finite_ = true;
}

NodeHarness& NodeHarness::feed_bytes(const std::string& name, std::function<void(std::int64_t, void*)> function) {
    for (InputSlot& input : members_->inputs)
        if (input.name == name) {
            input.function = std::move(function);
            return *this;
        }
    throw Error("no input '" + name + "'");
}

ValueKinds NodeHarness::takes() const {
    for (const InputSlot& input : members_->inputs)
        if (input.port->kind == InputKind::any) return input.port->takes;
    return 0;
}

void NodeHarness::prepare() {
    const auto frames = static_cast<std::size_t>(takes_blocks_ ? options_.max_frames : 1);
    std::uint64_t salt = options_.seed;
    for (InputSlot& input : members_->inputs) {
        Input& port = *input.port;
        const bool is_batch = port.kind == InputKind::batch;
        input.buffer.assign(port.type->size * (is_batch ? max_in_batch : frames), std::byte{});
        if (port.type == &value::pose) {
            const Pose rest;
            for (std::size_t at = 0; at < input.buffer.size(); at += sizeof(Pose))
                std::memcpy(input.buffer.data() + at, &rest, sizeof(Pose));
        }
        input.times.assign(is_batch ? max_in_batch : 0, 0);
        const Random random{mix(++salt)};
        if (!input.function)
            input.function = [this, random, type = port.type](std::int64_t k, void* out) {
                sample_value(*type, random, k, options_.feed, out);
            };
        const bool is_stream = port.kind == InputKind::stream || port.type == &value::signal;
        port.data = input.buffer.data();
        port.stride = is_stream && port.connected ? static_cast<std::ptrdiff_t>(port.type->size) : 0;
        port.times = input.times.data();
        port.period = is_batch ? options_.period / max_in_batch : options_.period;
    }
    for (OutputSlot& output : members_->outputs) {
        Output& port = *output.port;
        output.buffer.assign(port.type->size * frames, std::byte{});
        if (port.type == &value::pose) {
            const Pose rest;
            for (std::size_t at = 0; at < output.buffer.size(); at += sizeof(Pose))
                std::memcpy(output.buffer.data() + at, &rest, sizeof(Pose));
        }
        port.data = output.buffer.data();
        port.stride = takes_blocks_ ? static_cast<std::ptrdiff_t>(port.type->size) : 0;
    }
    Setup setup;
    setup.name = "node";
    setup.period = options_.period;
    setup.max_frames = static_cast<int>(frames);
    setup.seed = options_.seed;
    setup.host = &host;
    type_.prepare(node_, setup);
}

void NodeHarness::fill_inputs(std::int64_t first, int frames) {
    for (InputSlot& input : members_->inputs) {
        Input& port = *input.port;
        if (!port.connected) continue;
        const std::size_t size = port.type->size;
        if (port.kind == InputKind::batch) {
            port.count = static_cast<int>(Random{options_.seed ^ size}.bits(static_cast<std::uint64_t>(first)) %
                                          (max_in_batch + 1));
            for (int i = 0; i < port.count; ++i) {
                const auto at = static_cast<std::size_t>(i);
                input.function(first * max_in_batch + i, input.buffer.data() + at * size);
                input.times[at] = first * options_.period + options_.period * i / max_in_batch;
            }
        } else if (port.stride != 0) {
            for (int i = 0; i < frames; ++i)
                input.function(first + i, input.buffer.data() + static_cast<std::size_t>(i) * size);
        } else {
            input.function(takes_blocks_ ? first - first % hold : first, input.buffer.data());
        }
    }
    for (auto& [name, port] : host.devices) device_feed(first, *port);
    for (const auto& port : host.heard) {
        port->first = first;
        for (int i = 0; i < frames; ++i)
            sample_value(value::signal, Random{options_.seed}, first + i, options_.feed,
                         &port->samples[static_cast<std::size_t>(i)]);
    }
}

void NodeHarness::spoil_signals() {
    for (OutputSlot& output : members_->outputs)
        if (output.port->type == &value::signal) std::ranges::fill(output.buffer, std::byte{0xff});
        else if (output.port->type == &value::event) std::ranges::fill(output.buffer, std::byte{});
}

void NodeHarness::drive_params(std::int64_t first) {
    if (!options_.drive_params || first % hold != 0) return;
    std::uint64_t salt = mix(options_.seed ^ 0x5a17);
    for (auto& [name, param] : members_->params) {
        const Random random{++salt};
        const auto k = static_cast<std::uint64_t>(first);
        if (param->is_structural || random.uniform(2 * k) < 0.75) continue;
        const double low = std::max(param->min, -1e3), high = std::min(param->max, 1e3);
        param->drive(low + (high - low) * random.uniform(2 * k + 1));
    }
}

int NodeHarness::next_block(std::int64_t left, std::uint64_t partition) const {
    if (!takes_blocks_) return 1;
    std::int64_t frames = options_.max_frames;
    if (partition != 0)
        frames = 1 + static_cast<std::int64_t>(Random{partition}.bits(static_cast<std::uint64_t>(index_)) %
                                               static_cast<std::uint64_t>(options_.max_frames));
    return static_cast<int>(std::min({frames, left, hold - index_ % hold}));
}

void NodeHarness::run(std::int64_t activations, std::uint64_t partition) {
    for (const std::int64_t end = index_ + activations; index_ < end;) {
        const int frames = next_block(end - index_, partition);
        drive_params(index_);
        fill_inputs(index_, frames);
        spoil_signals();
        const Flicks missed = left_out ? left_out(index_) * options_.period : 0;
        const Tick tick{index_, options_.period, options_.period + missed, frames};
        {
            const RealtimeScope scope;
            type_.process(node_, tick);
        }
        collect(frames);
        index_ += frames;
    }
}

void NodeHarness::collect(int frames) {
    for (int i = 0; i < frames; ++i) {
        for (OutputSlot& output : members_->outputs) {
            const ValueType& type = *output.port->type;
            const std::byte* value = output.port->data + i * output.port->stride;
            type.hash(hash_, value);
            output.trace.insert(output.trace.end(), value, value + type.size);
            double columns[8] = {};
            if (!type.columns.empty()) type.to_columns(value, columns);
            finite_ = finite_ && std::ranges::all_of(columns, [](double v) { return std::isfinite(v); });
        }
    }
}

const std::vector<std::byte>& NodeHarness::trace(const std::string& name) const {
    for (const OutputSlot& output : members_->outputs)
        if (output.name == name) return output.trace;
    throw Error("no output '" + name + "'");
}

std::uint64_t NodeHarness::output_hash() const {
    Hash all = hash_;
    for (const auto& list : {std::cref(host.records), std::cref(host.sounds)})
        for (const auto& stream : list.get())
            // By the type: its bytes may hold padding.
            for (std::size_t at = 0; at < stream->used; at += stream->format.type->size)
                stream->format.type->hash(all, stream->bytes.data() + at);
    for (const auto& [name, port] : host.devices) all.add_bytes(&port->wrench, sizeof(Wrench));
    return all.value();
}

Report NodeHarness::report(Report report) const {
    type_.report(node_, report);
    return report;
}

}  // namespace tactus::test
