// SPDX-License-Identifier: Apache-2.0
// Where the source tree and the built command are.
#pragma once
#include <filesystem>
#include <string>

namespace tactus::test {

/// Root of the source tree; absolute.
std::filesystem::path source_folder();

/// The built `tactus`; absolute.
std::string command();

/// Library for LD_PRELOAD that lets a disk fail, see tests/preload/failing_disk.cpp; absolute.
std::string failing_disk();

/// In place of `tactus-device-host`, see tests/support/fake_device_host.cpp; absolute.
std::string fake_device_host();

/// The bundled library beside it; absolute.
std::filesystem::path library_folder();

}  // namespace tactus::test
