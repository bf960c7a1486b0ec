// SPDX-License-Identifier: Apache-2.0
// The header of an NRRD file (teem.sourceforge.net/nrrd/format.html). Parsed here, because teem ends the program on
// some damaged headers and loads all samples at once; the fields that a scan needs are few.
#pragma once

#include "assets/volume/packed_file.hpp"
#include "dsp/core/types.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::volume {

enum class NrrdEncoding { raw, gzip, bzip2, text, hex };

/// "raw", "gzip", "bzip2", "text" or "hex".
std::string_view name_of(NrrdEncoding encoding);

struct NrrdHeader {
    SampleType type;
    std::vector<std::int64_t> sizes;  ///< samples per axis, fastest first; 1 to 16 axes
    std::string space;                ///< in lower case, such as "left-posterior-superior"; empty: not stated
    std::vector<std::optional<Vec3>>
        directions;  ///< per axis, in the unit of the space; none: not a direction in space
    std::optional<Vec3> origin;                   ///< centre of the first sample
    std::vector<std::string> space_units;
    NrrdEncoding encoding = NrrdEncoding::raw;
    bool is_swapped = false;      ///< the byte order differs from this machine's
    std::uint64_t line_skip = 0;  ///< lines before the samples
    std::int64_t byte_skip = 0;   ///< bytes before the samples, after the lines; −1: the samples end the file
    std::map<std::string, std::string> values;  ///< key/value pairs
    std::vector<std::filesystem::path> data;    ///< files of the samples; the header's own file when it is attached
    std::uint64_t start = 0;                    ///< offset of the samples in an attached file, bytes

    /// Number of samples along all axes, as a double, which cannot overflow.
    double count() const;
    /// The value of a key; empty when there is none.
    std::string value(const std::string& key) const;
};

/// Reads the header of a file. Throws Error with file:line for fields that are damaged, repeated or missing, for 10 000
/// lines, 16 MB in all, and 700 bytes in a field that is neither a comment, a key/value pair nor 'content'.
NrrdHeader read_nrrd_header(const std::filesystem::path& path);

}  // namespace tactus::volume
