// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/equaliser.hpp"

#include "dsp/signal/filter/fir.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::nodes {

struct Equaliser {
    static constexpr auto about =
        "Compensates the frequency response of an actuator with a filter made by 'tactus equalise'.";

    In<Signal> in{"the desired vibration"};
    Out<Signal> out{"drive signal that makes the actuator produce it"};
    Text actuator{"", "name of an entry of [actuators], which has the settings that are not given here"};
    Asset<tactus::vibration::Equaliser> filter{"file written by 'tactus equalise'"};
    Param amount{"1", "0", "1", "0: only the delay of the filter; 1: full equalisation; a mix in between"};

    void prepare(const Setup& setup) {
        if (std::abs(filter->rate / setup.rate() - 1.0) > 1e-9)
            setup.fail(fmt::format(
                "the equaliser was made for {:g} Hz and this node runs at {:g} Hz; repeat 'tactus equalise' with "
                "--rate {:g}",
                filter->rate, setup.rate(), setup.rate()));
        fir_ = signal::Fir(filter->taps);
        delay_ = static_cast<std::size_t>(std::llround(filter->delay * filter->rate));
    }

    void process(const Tick& tick) noexcept {
        const auto share = static_cast<float>(amount);
        for (int i = 0; i < tick.frames; ++i) {
            const float equalised = fir_(bounded(in[i]));
            out[i] = signal::to_sample(static_cast<double>(share * equalised) +
                                       static_cast<double>((1.0f - share) * fir_.past(delay_)));
        }
    }

private:
    /// A sample that is not finite, or would overflow the sum, would stay in the filter's memory.
    static float bounded(float x) noexcept {
        constexpr double largest = 1e12;
        return static_cast<float>(std::clamp(signal::finite_or_zero(x), -largest, largest));
    }

    signal::Fir fir_;
    std::size_t delay_ = 0;
};

TACTUS_NODE(Equaliser, in, out, actuator, filter, amount)

}  // namespace tactus::nodes
