// SPDX-License-Identifier: Apache-2.0
// Tests that draw.
#pragma once

#include "devices/display/gl_context.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/skip.hpp"

namespace tactus::test {

/// Whether this machine can draw without a window; if not, the running test case is skipped, with the reason.
inline bool can_render() {
    try {
        const display::SurfacelessContext context;
        return true;
    } catch (const Error& error) {
        skip(error.what());
        return false;
    }
}

}  // namespace tactus::test
