// SPDX-License-Identifier: Apache-2.0
// The response between two channels of a record as a result.
#pragma once

#include "tools/analysis/vibration/two_channels.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>

namespace tactus::report {

struct FileResponse {
    std::filesystem::path file;
    const analysis::TwoChannels* found;
};

const Fields<FileResponse>& response_fields();

}  // namespace tactus::report
