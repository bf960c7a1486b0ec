// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/recording_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tactus::log_or_refuse(data, size, tactus::table::read_matlab_file);
    return 0;
}
