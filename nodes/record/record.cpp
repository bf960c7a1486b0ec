// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Record {
    static constexpr auto about = "Writes every value of a wire to a file: signals as WAV, other types as CSV.";
    static constexpr NodeRole role = NodeRole::file_sink;

    AnyIn in{"the wire to record"};
    Text file{"", "file name in the run folder; empty: the node's name with .wav or .csv"};
    Text unit{"", "unit of the values, noted in the file"};

    void prepare(const Setup& setup) {
        if (!in.type) setup.fail("record needs a wire to 'in'");
        if (in.type->columns.empty())
            setup.fail("record cannot write a " + std::string(in.type->name) + "; it has no columns of numbers");
        is_signal_ = in.type == &value::signal;
        const std::string name = file.value.empty() ? setup.name + (is_signal_ ? ".wav" : ".csv") : file.value;
        stream_ = &setup.host->record({name, unit.value, in.type, setup.period}, setup.where);
    }

    void process(const Tick& tick) noexcept {
        const std::size_t count = is_signal_ ? static_cast<std::size_t>(tick.frames) : 1;
        stream_->write(tick.index, in.data, count, in.stride);
    }

private:
    RecordStream* stream_ = nullptr;
    bool is_signal_ = false;
};

TACTUS_NODE(Record, in, file, unit)

}  // namespace tactus::nodes
