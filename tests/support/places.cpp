// SPDX-License-Identifier: Apache-2.0
// The only file whose compile command names folders of this machine, so that a compiler cache serves any checkout.
#include "tests/support/places.hpp"

namespace tactus::test {

std::filesystem::path source_folder() { return TACTUS_SOURCE_DIR; }

std::string command() { return TACTUS_COMMAND; }

std::string failing_disk() { return TACTUS_FAILING_DISK; }

std::string fake_device_host() { return TACTUS_FAKE_DEVICE_HOST; }

std::filesystem::path library_folder() { return std::filesystem::path(command()).parent_path() / "library"; }

}  // namespace tactus::test
