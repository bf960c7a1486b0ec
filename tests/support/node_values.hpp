// SPDX-License-Identifier: Apache-2.0
// Random but repeatable values for any type of wire.
#pragma once

#include "dsp/core/random.hpp"
#include "tests/support/node_harness.hpp"

namespace tactus::test {

/// Value number `k` of a wire, written to `out`.
void sample_value(const ValueType& type, const Random& random, std::int64_t k, Feed feed, void* out);

/// Sample number `k` of a device.
DeviceSample sample_device(const Random& random, std::int64_t k, Feed feed);

}  // namespace tactus::test
