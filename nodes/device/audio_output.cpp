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
    Param limit{"1", "0", "1", "fraction of full scale that is never exceeded: larger values are clipped to it"};

    void prepare(const Setup& setup) {
        if (channel != std::floor(channel)) setup.fail("a channel is a whole number");
        stream_ =
            &setup.host->audio({setup.name + ".wav", "", &value::signal, setup.period},
                               {card.value, static_cast<int>(channel), setup.name, setup.max_frames, setup.where});
        block_.resize(static_cast<std::size_t>(setup.max_frames));
        name_ = setup.name;
    }

    void process(const Tick& tick) noexcept {
        const auto factor = static_cast<float>(1.0 / full_scale), loudest = static_cast<float>(limit);
        for (int i = 0; i < tick.frames; ++i) {
            const float wanted = factor * signal[i];
            const float given = std::isfinite(wanted) ? std::clamp(wanted, -loudest, loudest) : 0.0f;
            clipped_ += given != wanted;
            if (std::isfinite(wanted)) peak_ = std::max(peak_, std::abs(wanted));
            block_[static_cast<std::size_t>(i)] = given;
        }
        samples_ += tick.frames;
        stream_->write(tick.index, block_.data(), static_cast<std::size_t>(tick.frames), sizeof(float));
    }

    void report(Report& report) const {
        report.set(name_, "samples", static_cast<double>(samples_));
        report.set(name_, "clipped_samples", static_cast<double>(clipped_));
        report.set(name_, "peak", static_cast<double>(peak_));
    }

private:
    RecordStream* stream_ = nullptr;
    std::vector<float> block_;
    std::int64_t samples_ = 0, clipped_ = 0;
    float peak_ = 0.0f;  // of full scale, before it is clipped
    std::string name_;
};

TACTUS_NODE(AudioOutput, signal, actuator, card, channel, full_scale, limit)

}  // namespace tactus::nodes
