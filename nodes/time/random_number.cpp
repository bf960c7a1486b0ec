// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/random.hpp"
#include "graph/node/node.hpp"

#include <cstdint>

namespace tactus::nodes {

struct RandomNumber {
    static constexpr auto about =
        "A random number, redrawn when the trigger becomes true, or in each tick when it is not wired. The same "
        "patch "
        "gives the same numbers; 'seed' gives others.";

    In<bool> trigger{optional, "draws when it becomes true; open: in each tick"};
    Out<double> out{"the number"};
    Choice distribution{{"uniform", "normal"},
                        "uniform: from centre - spread to centre + spread; normal: 'spread' is the "
                        "standard deviation"};
    Param centre{"0", "-1e12", "1e12", "mean, in SI units"};
    Param spread{"1", "0", "1e12", "half of the range, or standard deviation, in SI units"};
    Param seed{structural, "0", "0", "1e9", "another seed gives other numbers"};

    void prepare(const Setup& setup) {
        random_ = Random{mix(setup.seed ^ mix(static_cast<std::uint64_t>(seed)))};
        is_normal_ = distribution.is("normal");
        drawn_ = 0;
        was_ = false;
        unit_ = draw(0);
        out = centre + spread * unit_;
    }
    void process(const Tick&) noexcept {
        if (!trigger.connected || (trigger && !was_)) unit_ = draw(++drawn_);
        was_ = trigger.connected && trigger;
        out = centre + spread * unit_;
    }

private:
    double draw(std::uint64_t index) const noexcept {
        return is_normal_ ? random_.normal(index) : 2.0 * random_.uniform(index) - 1.0;
    }

    Random random_;
    std::uint64_t drawn_ = 0;
    double unit_ = 0.0;
    bool was_ = false, is_normal_ = false;
};

TACTUS_NODE(RandomNumber, trigger, out, distribution, centre, spread, seed)

}  // namespace tactus::nodes
