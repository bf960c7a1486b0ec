// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

/// A number that the patch or a live change sets.
struct Constant {
    static constexpr auto about = "A constant number.";

    Out<double> value{"the number"};
    Param number{"0", "-1e12", "1e12", "the number"};

    void prepare(const Setup&) { value = number; }
    void process(const Tick&) noexcept { value = number; }
};

TACTUS_NODE(Constant, value, number)

}  // namespace tactus::nodes
