// SPDX-License-Identifier: Apache-2.0
// The nodes of a rate group, one after the other.
#include "engine/observe/observed_port.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/group_runtime.hpp"
#include "graph/node/node_memory.hpp"

#include <algorithm>
#include <span>

namespace tactus::run {

void GroupRuntime::drive(const build::StepWires& step, int i) noexcept {
    for (const build::Drive& drive : step.drives) {
        const std::byte* value = drive.source
                                     ? drive.source->data + i * drive.source->stride
                                     : drive.glide->glide.data() + static_cast<std::size_t>(i) * sizeof(double);
        drive.param->drive(*reinterpret_cast<const double*>(value));
    }
}

void GroupRuntime::run_one_at_a_time(const build::Step& step, const build::StepWires& of, const Tick& all) noexcept {
    const std::span<build::PublishedOutput> mine(program_->published.data() + step.first_output, step.output_count);
    for (int i = 0; i < all.frames; ++i) {
        drive(of, i);
        step.process(step.node, {all.index + i, all.period, i == 0 ? all.elapsed : all.period, 1});
        for (Input* input : of.inputs) {
            // A batch from another group belongs to the first activation of a call.
            if (input->kind == InputKind::batch && input->times != &now) input->count = 0;
            else input->data += input->stride;
        }
        for (build::PublishedOutput& output : mine) output.port->data += output.port->stride;
    }
    for (Input* input : of.inputs)
        if (input->kind != InputKind::batch || input->times == &now) input->data -= all.frames * input->stride;
    for (build::PublishedOutput& output : mine) output.port->data -= all.frames * output.port->stride;
}

void GroupRuntime::hash_outputs(const build::Step& step, int frames) noexcept {
    const auto position = static_cast<std::uint64_t>(ran_);
    for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
        build::PublishedOutput& output = program_->published[k];
        const std::byte* data = output.port->data;
        if (output.is_signal) {
            const auto* samples = reinterpret_cast<const float*>(data);
            if (frames == 1) output.samples.add(position, *samples);
            else output.samples.add(position, samples, static_cast<std::size_t>(frames));
        } else {
            for (int i = 0; i < frames; ++i) output.port->type->hash(output.hash, data + i * output.port->stride);
        }
    }
}

void GroupRuntime::record_outputs(const build::Step& step, int frames) noexcept {
    for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
        build::PublishedOutput& output = program_->published[k];
        if (RecordStream* const stream = output.recorded_into())
            stream->write(next_, output.port->data, static_cast<std::size_t>(frames), output.port->stride);
        if (output.seen)
            output.seen->see(next_, output.port->data, static_cast<std::size_t>(frames), output.port->stride);
    }
}

/// Asks for the cache line of a node's ports and first parameters, a few steps before they are needed: nodes are
/// scattered, and a thousand of them do not fit the nearest cache.
static void fetch_ahead(const build::Step* step, const build::Step* past) noexcept {
    constexpr std::ptrdiff_t distance = 4;
    if (past - step <= distance) return;
    __builtin_prefetch(static_cast<const std::byte*>(step[distance].node) + (cache_line - node_offset));
}

template <bool watched>
void GroupRuntime::run_each(const Tick& tick, bool timed) noexcept {
    const build::GroupProgram& program = *program_;
    const build::Step* const past = program.steps.data() + program.steps.size();
    [[maybe_unused]] std::int64_t began = watched && timed ? steady_ns() : 0;
    for (const build::Step& step : program.steps) {
        fetch_ahead(&step, past);
        if (!step.driven && !(step.one_at_a_time && tick.frames > 1)) {
            step.process(step.node, tick);
        } else if (const build::StepWires& of = program.wires[static_cast<std::size_t>(&step - program.steps.data())];
                   tick.frames == 1) {
            drive(of, 0);
            step.process(step.node, tick);
        } else {
            run_one_at_a_time(step, of, tick);
        }
        if constexpr (watched) {
            if (program.hashes_outputs) hash_outputs(step, tick.frames);
            if (program.records_outputs) record_outputs(step, tick.frames);
            if (!timed) continue;
            const std::int64_t now_ns = steady_ns();
            program.wires[static_cast<std::size_t>(&step - program.steps.data())].time->add(now_ns - began);
            began = now_ns;
        }
    }
}

void GroupRuntime::run_steps(int frames) noexcept {
    const Flicks elapsed = last_ < 0 ? plan->period : (next_ - last_) * plan->period;
    const Tick tick{next_, plan->period, elapsed, frames};
    const bool timed = times_nodes && (calls_++ % timed_every == 0 || closely_ > 0);
    closely_ = std::max(closely_ - 1, 0);
    if (timed || program_->hashes_outputs || program_->records_outputs) run_each<true>(tick, timed);
    else run_each<false>(tick, false);
    ran_ += frames;
}

}  // namespace tactus::run
