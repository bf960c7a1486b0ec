// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/waterfall_text.hpp"

#include "tools/command/batch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace tactus::command {

namespace {

double position(const analysis::Waterfall& waterfall, std::size_t column) {
    return static_cast<double>(column) * waterfall.step;
}

}  // namespace

std::string waterfall_csv(const analysis::Orders& orders) {
    const analysis::Waterfall& first = *orders.channels.front().waterfall;
    std::string csv = "channel,time_s,rate_hz";
    for (std::size_t k = 0; k < first.rows.front().rms.size(); ++k)
        fmt::format_to(std::back_inserter(csv), ",rms_{}{}", position(first, k), first.settings.of_orders ? "" : "_hz");
    csv += '\n';
    for (const analysis::OrdersOfChannel& channel : orders.channels)
        for (const analysis::WaterfallRow& row : channel.waterfall->rows) {
            csv += csv_field(channel.name) + ",";
            if (!std::isnan(row.time)) csv += fmt::format("{}", row.time);
            csv += fmt::format(",{}", row.rate);
            for (const float rms : row.rms) csv += std::isnan(rms) ? std::string(",") : fmt::format(",{}", rms);
            csv += '\n';
        }
    return csv;
}

}  // namespace tactus::command
