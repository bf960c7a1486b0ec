// SPDX-License-Identifier: Apache-2.0
// How the commands end.
#pragma once

namespace tactus {

enum ExitCode : int {
    done = 0,
    answer_is_no = 1,
    bad_input = 2,
    machine_failed = 3,  ///< disk, memory or a device fell short
    output_lost = 3      ///< the run went on without an output that could not be written
};

}  // namespace tactus
