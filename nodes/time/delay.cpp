// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

namespace tactus::nodes {

struct Delay {
    static constexpr auto about =
        "The value of some time ago, to whole ticks of its group; before that the first default: zero, identity, "
        "false. "
        "Ticks that are left out leave their values out.";
    static constexpr UnitRule units = UnitRule::same;
    static constexpr bool shapes_values = true;

    AnyIn in{"the value", kinds::plain};
    AnyOut out{"the value of 'time' ago"};
    Param time{structural, "10 ms", "0 s", "10 s", "how long ago"};

    void prepare(const Setup& setup) {
        size_ = in.type->size;
        ticks_ = static_cast<std::size_t>(std::llround(time * setup.rate()));
        if (ticks_ * size_ > max_bytes)
            setup.fail("a delay holds at most 64 MB; make 'time' shorter or the group slower");
        kept_.assign(ticks_ * size_, std::byte{});
        for (std::size_t i = 0; i < ticks_; ++i) in.type->make_default(kept_.data() + i * size_);
        at_ = 0;
        in.type->make_default(out.data);
    }
    void process(const Tick& tick) noexcept {
        const int count = in.type == &value::signal ? tick.frames : 1;
        for (int i = 0; i < count; ++i) {
            const auto offset = static_cast<std::size_t>(i) * size_;
            if (ticks_ == 0) {
                std::memcpy(out.data + offset, in.data + offset, size_);
                continue;
            }
            std::byte* const place = kept_.data() + at_ * size_;
            // A signal's output may lie where its input lies.
            std::byte taken[sizeof(Pose)];
            std::memcpy(taken, in.data + offset, size_);
            std::memcpy(out.data + offset, place, size_);
            std::memcpy(place, taken, size_);
            at_ = at_ + 1 == ticks_ ? 0 : at_ + 1;
        }
    }

private:
    static constexpr std::size_t max_bytes = 64'000'000;
    std::vector<std::byte> kept_;
    std::size_t size_ = 8, ticks_ = 0, at_ = 0;
};

TACTUS_NODE(Delay, in, out, time)

}  // namespace tactus::nodes
