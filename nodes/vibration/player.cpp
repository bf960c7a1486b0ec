// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tactus::nodes {

struct Player {
    static constexpr auto about =
        "Plays a sound once, from its beginning, when a trigger becomes true. A sound that still plays fades out while "
        "the new one begins, however soon that is. Several channels are averaged; another rate is converted.";

    In<bool> trigger{"plays when it becomes true"};
    Out<Signal> out{"the sound, then silence; full scale is 1"};
    Out<bool> playing{"true while the sound plays"};
    Asset<sound::Sound> sound{"the sound: WAV, FLAC and others"};
    Param gain{"1", "-1000", "1000", "factor of the sound"};
    Param fade{"5 ms", "0 ms", "1 s", "in which one that still plays fades out"};

    void prepare(const Setup& setup) {
        const std::vector<float> mono = sound::mix_to_mono(*sound);
        const double rate = setup.rate();
        samples_ = mono;
        if (std::abs(sound->rate / rate - 1.0) > 1e-9) {
            const std::vector<double> converted = signal::resample(mono, sound->rate, rate);
            samples_.assign(converted.begin(), converted.end());
        }
        rate_ = rate;
        new_ = {samples_.size(), 0.0};
        old_.fill(new_);
        rest_ = 0.0;
        playing = was_ = false;
    }
    void process(const Tick& tick) noexcept {
        if (trigger && !was_) {
            // The most faded voice is replaced; its last value fades out with `rest_`.
            std::rotate(old_.begin(), old_.end() - 1, old_.end());
            rest_ += next(old_.front());
            old_.front() = new_;
            new_ = {0, 1.0};
        }
        was_ = trigger;
        const double step = fade > 0.0 ? 1.0 / (fade * rate_) : 1.0;
        for (int i = 0; i < tick.frames; ++i) {
            playing[i] = new_.at < samples_.size();
            double sum = next(new_);
            for (Voice& voice : old_) {
                if (!(voice.level > 0.0)) continue;
                voice.level = std::max(voice.level - step, 0.0);
                sum += next(voice);
            }
            rest_ *= 1.0 - step;
            out[i] = signal::to_sample(gain * (sum + rest_));
        }
    }

private:
    struct Voice {
        std::size_t at = 0;
        double level = 0.0;
    };
    double next(Voice& voice) const noexcept {
        return voice.at < samples_.size() ? voice.level * static_cast<double>(samples_[voice.at++]) : 0.0;
    }

    std::vector<float> samples_;
    Voice new_;
    std::array<Voice, 4> old_{};  ///< those that fade, the latest first
    double rest_ = 0.0;  ///< of those that had no place
    double rate_ = 48000.0;
    bool was_ = false;
};

TACTUS_NODE(Player, trigger, out, playing, sound, gain, fade)

}  // namespace tactus::nodes
