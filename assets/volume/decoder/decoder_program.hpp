// SPDX-License-Identifier: Apache-2.0
// The program that reads scans for DicomReader.
#pragma once

namespace tactus::volume {

/// Answers requests from the socket until it is closed. `argument`: the greatest number of bytes of memory. Returns the
/// exit code.
int run_scan_decoder(const char* argument);

}  // namespace tactus::volume
