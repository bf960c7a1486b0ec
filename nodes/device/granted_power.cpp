// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct GrantedPower {
    static constexpr auto about =
        "Declares power that a patch gives the hand on purpose, as a guided fragment does: device_output.granted lets "
        "so "
        "much pass that the hand has not put in. The summary lists it.";

    In<bool> active{optional, "grant it now; unconnected: always"};
    Out<double> power{"granted now, for device_output.granted", "W"};
    Param limit{"0.1 W", "0 W", "50 W", "of the power: the largest force times the speed that it may lead the hand at"};

    Param after{"0 s", "0 s", "1 min", "grant it so long after 'active' has ended, while what it moves comes to rest"};

    void process(const Tick& tick) noexcept {
        const bool is_active = !active.connected || active.get();
        left_s_ = is_active ? after.value : left_s_ - tick.elapsed_seconds();
        power = is_active || left_s_ > 0.0 ? limit.value : 0.0;
        largest_ = std::max(largest_, power.get());
        granted_s_ += power.get() > 0.0 ? tick.elapsed_seconds() : 0.0;
    }

    void report(Report& report) const {
        report.set("granted_power", "max_W", largest_);
        report.set("granted_power", "time_s", granted_s_);
    }

private:
    double left_s_ = 0.0, largest_ = 0.0, granted_s_ = 0.0;
};

TACTUS_NODE(GrantedPower, active, power, limit, after)

}  // namespace tactus::nodes
