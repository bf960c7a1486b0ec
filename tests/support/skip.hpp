// SPDX-License-Identifier: Apache-2.0
// Tests that need what this machine may not have.
#pragma once

#include <string>

namespace tactus::test {

/// Marks the running test case as skipped and prints why; return from it afterwards. A program whose test cases were all
/// skipped exits with 77, which ctest shows as "Skipped". A failed check counts more: then the case has failed.
void skip(const std::string& why);

}  // namespace tactus::test
