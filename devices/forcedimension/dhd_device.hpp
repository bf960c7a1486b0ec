// SPDX-License-Identifier: Apache-2.0
// Driver "force_dimension": delta, omega, sigma, lambda, and the Novint Falcon, by the SDK of Force Dimension.
#pragma once

#include "devices/driver/backend.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::forcedimension {

/// Options: library, serial. Throws Error.
std::unique_ptr<driver::Backend> make_force_dimension(Options& options);

}  // namespace tactus::forcedimension
