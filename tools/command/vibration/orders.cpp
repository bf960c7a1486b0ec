// SPDX-License-Identifier: Apache-2.0
// tactus orders: order analysis of a machine with a changing rate.
#include "tools/analysis/vibration/orders.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/csv_field.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/command/vibration/waterfall_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/waterfall_figure.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/orders_result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace tactus::command {

namespace {

struct OrdersChoice : RecordChoice {
    analysis::OrdersSettings orders;
    std::filesystem::path csv;
    std::string band;  // LOW:HIGH in Hz; empty: found
    bool peak = false;
    std::vector<std::filesystem::path> waterfalls;
    std::string over, against;  // of waterfalls; empty: orders, time
    ResultChoice result;
};

/// CSV of level over order.
std::string csv_of(const analysis::Orders& found, bool peak) {
    std::string csv = "order";
    for (const analysis::OrdersOfChannel& one : found.channels)
        csv += "," + table::csv_field(fmt::format("{}_{}", one.name, peak ? "peak" : "rms"));
    csv += '\n';
    const signal::OrderSpectrum& first = found.channels.front().spectrum;
    for (std::size_t k = 0; k < first.amplitude.size(); ++k) {
        csv += fmt::format("{}", static_cast<double>(k) * first.step);
        for (const analysis::OrdersOfChannel& one : found.channels)
            csv += fmt::format(",{}", one.spectrum.amplitude[k] / (peak ? 1.0 : std::sqrt(2.0)));
        csv += '\n';
    }
    return csv;
}

/// Adds the record's name to errors.
template <class Function>
void about_file(const std::filesystem::path& file, const Function& function) {
    try {
        function();
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file.string(), error.message()));
    }
}

/// By the ending: a figure or a table.
void write_waterfall(const analysis::Orders& found, const std::filesystem::path& record,
                     const std::filesystem::path& out, const FigureChoice& figure) {
    if (out.extension() == ".csv") {
        table::save_csv(out, waterfall_csv(found));
    } else if (out.extension() == ".json") {
        file::Json json{{"file", record.string()}, {"unit", found.calibration.unit}, {"channels", file::Json::array()}};
        for (const analysis::OrdersOfChannel& channel : found.channels) {
            json["channels"].push_back(file::Json{{"name", channel.name}});
            json["channels"].back().update(report::json_of(report::waterfall_fields().of(*channel.waterfall)));
        }
        file::write_whole_file(out, json.dump() + "\n");
    } else {
        save_figure(report::draw_waterfall(found, record, figure.figure_style()), out, figure);
    }
}

std::optional<analysis::WaterfallSettings> waterfall_of(const OrdersChoice& choice) {
    if (choice.waterfalls.empty()) {
        if (!choice.over.empty() || !choice.against.empty())
            throw Error("--over and --against are of a waterfall; name its file with --waterfall");
        return std::nullopt;
    }
    return analysis::WaterfallSettings{choice.over != "frequency", choice.against == "speed"};
}

int orders(const OrdersChoice& choice) {
    if (choice.files.size() != 1) throw Error("orders takes one file");
    const std::filesystem::path& file = choice.files.front();
    analysis::OrdersSettings settings = choice.orders;
    settings.record = choice.settings();
    if (!choice.band.empty()) settings.range = parse_band(choice.band, "--band");
    settings.waterfall = waterfall_of(choice);
    ResultChoice result = choice.result;
    if (!settings.waterfall) result.has_figure = ResultFigure::none;
    std::vector<std::filesystem::path> others = choice.waterfalls;
    others.push_back(choice.csv);
    check_result_files(result, choice.files, others);
    const analysis::Orders found = analysis::analyse_orders(file, settings);
    if (!choice.csv.empty()) about_file(file, [&] { table::save_csv(choice.csv, csv_of(found, choice.peak)); });
    for (const std::filesystem::path& out : choice.waterfalls)
        about_file(file, [&] { write_waterfall(found, file, out, result.figure); });
    const report::FileOrders shown{file, &found};
    write_result(report::orders_fields().of(shown), result);
    return done;
}

Action declare_orders(VerbOptions& verb) {
    const auto choice = std::make_shared<OrdersChoice>();
    analysis::OrdersSettings& settings = choice->orders;
    add_record_options(verb, *choice, "a sound file or CSV log", "--sample-rate");
    const Option tacho = verb.add("--tacho", settings.tacho, "channel of the tachometer, from 1").range(1, 1024);
    verb.add("--pulses", settings.pulses, "tachometer pulses per revolution").shows_default().range(0.01, 1e5);
    verb.add("--rate", settings.fixed, "known constant rate, Hz").unit("Hz").range(0.01, 1e6).excludes(tacho);
    verb.add("--band", choice->band,
             "search range of a tracked rate, Hz (default: around the fundamental, else 20:400)")
        .value_name("LOW:HIGH");
    verb.old("--range", "--band");
    verb.add("--orders", settings.highest, "highest order").shows_default().range(1, 200);
    verb.output("--csv", choice->csv, {{".csv"}}, "CSV file for the level over order");
    verb.output("--waterfall", choice->waterfalls, {{".svg", ".png", ".pdf", ".csv", ".json"}},
                "file for the levels row by row: a figure, .svg, .png or .pdf, or a table, .csv or .json; repeatable")
        .one_each();
    verb.add("--over", choice->over, "columns of a waterfall: orders (default) or frequency")
        .one_of({"orders", "frequency"});
    verb.add("--against", choice->against, "rows of a waterfall: time (default) or speed").one_of({"time", "speed"});
    add_result_options(verb, choice->result, ResultFigure::styled);
    verb.flag("--peak", choice->peak, "peak values instead of rms in --csv");
    return [choice] { return orders(*choice); };
}

}  // namespace

Verb orders_verb() {
    return {.name = "orders",
            .about = "measure the orders of a machine with a changing rate",
            .add = declare_orders,
            .schema = [] { return report::schema_of_output({report::orders_fields().schema()}); }};
}

}  // namespace tactus::command
