// SPDX-License-Identifier: Apache-2.0
// The vessel tracker on real scans.
#pragma once

#include "assets/file/json.hpp"

#include <filesystem>
#include <vector>

namespace tactus::bench {

/// Rows for vessels/aorta_mra_vmtk.nrrd and vessels/thorax_cta_dissection.nrrd below `folder`; a row that says so for
/// what is not there. Pictures go to the folder `pictures` unless it is empty.
std::vector<file::Json> real_vessels(const std::filesystem::path& folder, const std::filesystem::path& pictures);
void print_real(const file::Json& row);

}  // namespace tactus::bench
