// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/beside.hpp"
#include "tools/command/catalogue.hpp"

#include <fcntl.h>
#include <unistd.h>

int main(int argc, char** argv) {
    // If a standard stream is closed, the next opened file would get its descriptor, and messages would be written into
    // that file.
    for (int handle = ::open("/dev/null", O_RDWR); handle >= 0; handle = ::open("/dev/null", O_RDWR))
        if (handle > STDERR_FILENO) {
            ::close(handle);
            break;
        }
    const int code = tactus::command::command_line(tactus::command::tactus_program(), argc, argv);
    tactus::analysis::end_beside();
    return code;
}
