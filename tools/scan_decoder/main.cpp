// SPDX-License-Identifier: Apache-2.0
// `tactus-scan-decoder`: reads DICOM files in a process of its own. Commands that read scans start it.
#include "assets/volume/decoder/decoder_program.hpp"

int main(int count, char** arguments) { return tactus::volume::run_scan_decoder(count > 1 ? arguments[1] : "0"); }
