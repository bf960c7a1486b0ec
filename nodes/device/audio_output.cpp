// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::nodes {

struct AudioOutput {
    static constexpr auto about =
        "Plays a signal on a sound card, for a listener or an actuator; writes a file when there is no card.";
    static constexpr NodeRole role = NodeRole::sound_sink;

    In<Signal> signal{"the signal to play"};
    Text actuator{"", "name of an entry of [actuators], which has the settings that are not given here"};
    Text card{"", "part of the card's name; empty: the card of the run"};
    Param channel{structural, "0", "0", "64",
                  "of the card; all channels of a card play sample by sample. 0: a stream with one channel"};
    Param full_scale{"1", "1e-6", "1e6", "signal value (SI) that drives the card fully; larger values are clipped"};

    void prepare(const Setup& setup) {
        if (channel != std::floor(channel)) setup.fail("a channel is a whole number");
        stream_ =
            &setup.host->audio({setup.name + ".wav", "", &value::signal, setup.period},
                               {card.value, static_cast<int>(channel), setup.name, setup.max_frames, setup.where});
        block_.resize(static_cast<std::size_t>(setup.max_frames));
        name_ = setup.name;
    }

    void process(const Tick& tick) noexcept {
        const auto factor = static_cast<float>(1.0 / full_scale);
        for (int i = 0; i < tick.frames; ++i) {
            const float wanted = factor * signal[i];
            const float given = std::isfinite(wanted) ? std::clamp(wanted, -1.0f, 1.0f) : 0.0f;
            clipped_ += given != wanted;
            block_[static_cast<std::size_t>(i)] = given;
        }
        stream_->write(tick.index, block_.data(), static_cast<std::size_t>(tick.frames), sizeof(float));
    }

    void report(Report& report) const { report.set(name_, "clipped_samples", static_cast<double>(clipped_)); }

private:
    RecordStream* stream_ = nullptr;
    std::vector<float> block_;
    std::int64_t clipped_ = 0;
    std::string name_;
};

TACTUS_NODE(AudioOutput, signal, actuator, card, channel, full_scale)

}  // namespace tactus::nodes
