// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tactus::command {

/// Opens /dev/null for each standard stream that is closed: the next opened file would get its descriptor, and messages
/// would be written into that file. To be called first in a program.
void hold_standard_streams();

}  // namespace tactus::command
