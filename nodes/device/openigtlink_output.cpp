// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/sender.hpp"
#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct OpenigtlinkOutput {
    static constexpr auto about =
        "Sends a pose to 3D Slicer and others that connect, as an OpenIGTLink transform in mm, each time that values "
        "of "
        "the run are put away, some 50 times a second. Only in a live run.";

    In<Pose> pose{"the pose to send"};
    Text transform{"", "name of the transform, at most 19 characters; empty: the node's"};
    Text address{"127.0.0.1", "where clients may connect: this machine, or 0.0.0.0: any"};
    Param port{structural, "18944", "1", "65535", "shared by all nodes with the same one"};

    void prepare(const Setup& setup) {
        if (port != std::floor(port)) setup.fail("a port is a whole number");
        const std::string name = transform.value.empty() ? setup.name : transform.value;
        stream_ = &setup.host->send({"", "m, 1", &value::pose, setup.period,
                                     openigtlink::make_sender(address.value, static_cast<int>(port), name)},
                                    setup.where);
    }
    void process(const Tick& tick) noexcept {
        const Pose& now = pose;
        stream_->write(tick.index, &now, 1, sizeof(Pose));
    }

private:
    RecordStream* stream_ = nullptr;
};

TACTUS_NODE(OpenigtlinkOutput, pose, transform, address, port)

}  // namespace tactus::nodes
