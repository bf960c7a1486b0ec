// SPDX-License-Identifier: Apache-2.0
// The orders of a machine as a result.
#pragma once

#include "tools/analysis/vibration/orders.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>

namespace tactus::report {

struct FileOrders {
    std::filesystem::path file;
    const analysis::Orders* found;
};

const Fields<FileOrders>& orders_fields();

/// Levels row by row: JSON of --waterfall.
const Fields<analysis::Waterfall>& waterfall_fields();

}  // namespace tactus::report
