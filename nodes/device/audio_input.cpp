// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/sound_input.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace tactus::nodes {

struct AudioInput {
    static constexpr auto about =
        "Hears a channel of a sound card, such as a microphone or an accelerometer, in step with the outputs of the "
        "card "
        "that have a channel. Offline, and without a card, it plays a file.";

    Out<Signal> signal{"the recorded sound"};
    Text sensor{"", "name of an entry of [sensors], which has the settings that are not given here"};
    Text card{"", "part of the card's name; empty: the card of the run"};
    Param channel{structural, "1", "1", "64", "of the card"};
    Param full_scale{"1", "1e-6", "1e6", "signal value (SI) that the card gives at full scale"};
    Asset<sound::Sound> file{optional,
                             "a sound that is heard from the beginning where there is no card: WAV, FLAC and others"};

    void prepare(const Setup& setup) {
        if (channel != std::floor(channel)) setup.fail("a channel is a whole number");
        auto* const inputs = dynamic_cast<SoundInputs*>(setup.host);
        if (!inputs) setup.fail("nothing can be heard here: the host of this patch has no sound inputs");
        std::optional<std::vector<float>> instead;
        if (file) {
            instead = sound::mix_to_mono(*file);
            if (std::abs(file->rate / setup.rate() - 1.0) > 1e-9) {
                const std::vector<double> converted = signal::resample(*instead, file->rate, setup.rate());
                instead->assign(converted.begin(), converted.end());
            }
        }
        heard_ = &inputs->listen({card.value, static_cast<int>(channel), setup.name, setup.max_frames, setup.where},
                                 setup.period, std::move(instead));
    }

    void process(const Tick& tick) noexcept {
        // A call may be a part of the one that the samples are of.
        const float* const samples = heard_->samples.data() + (tick.index - heard_->first);
        for (int i = 0; i < tick.frames; ++i)
            signal[i] = tactus::signal::to_sample(full_scale * tactus::signal::finite_or_zero(samples[i]));
    }

private:
    const SoundInPort* heard_ = nullptr;
};

TACTUS_NODE(AudioInput, signal, sensor, card, channel, full_scale, file)

}  // namespace tactus::nodes
