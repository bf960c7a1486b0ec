// SPDX-License-Identifier: Apache-2.0
// Writes CSV files.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::table {

/// Removes the sign of zeros: "-0", "-0.000" and "-0e+00" become "0", "0.000" and "0e+00". A negative zero is left
/// by the computation and no measured value, and other programs group and compare cells as text. Fields between double
/// quotes are kept.
std::string with_plain_zeros(std::string csv);

/// Writes a CSV text with plain zeros, as a whole. Throws Error like file::write_whole_file.
void save_csv(const std::filesystem::path& path, std::string csv);

}  // namespace tactus::table
