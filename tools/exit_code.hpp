// SPDX-License-Identifier: Apache-2.0
// How the commands end.
#pragma once

namespace tactus {

enum ExitCode : int { done = 0, answer_is_no = 1, bad_input = 2 };

}  // namespace tactus
