// SPDX-License-Identifier: Apache-2.0
// Exit codes of the commands.
#pragma once

namespace tactus {

enum ExitCode : int {
    done = 0,
    answer_is_no = 1,
    bad_input = 2,
    machine_failed = 3,  ///< failure of disk, memory or a device
    output_lost = 3      ///< the run continued, but an output could not be written
};

}  // namespace tactus
