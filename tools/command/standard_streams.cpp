// SPDX-License-Identifier: Apache-2.0
#include "tools/command/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace tactus::command {

void hold_standard_streams() {
    for (int handle = ::open("/dev/null", O_RDWR); handle >= 0; handle = ::open("/dev/null", O_RDWR))
        if (handle > STDERR_FILENO) {
            ::close(handle);
            break;
        }
}

}  // namespace tactus::command
