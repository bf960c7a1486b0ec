// SPDX-License-Identifier: Apache-2.0
#include "tools/command/bone/scan_options.hpp"

#include "dsp/core/error.hpp"

#include <cstdio>

namespace tactus::command {

namespace {

std::pair<double, double> rescale_by_points(const std::string& text) {
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
    if (std::sscanf(text.c_str(), "%lf:%lf,%lf:%lf", &a, &b, &c, &d) != 4 || a == c || b == d)
        throw Error("--hu-calibration takes two points VALUE:HU, as in --hu-calibration 60:-1000,1084:0");
    const double slope = (d - b) / (c - a);
    return {slope, b - slope * a};
}

std::pair<double, double> rescale_of(const std::string& text) {
    double slope = 0.0, intercept = 0.0;
    if (std::sscanf(text.c_str(), "%lf,%lf", &slope, &intercept) != 2)
        throw Error("--rescale takes SLOPE,INTERCEPT, as in --rescale 1,-1024");
    return {slope, intercept};
}

}  // namespace

void add_rescale(VerbOptions& verb, std::function<void(const Rescale&)> choose) {
    verb.call<std::string>(
        "--hu-calibration", [choose](const std::string& text) { choose(rescale_by_points(text)); },
        "scanner numbers to HU by two points: VALUE:HU,VALUE:HU");
    verb.call<std::string>(
        "--rescale", [choose](const std::string& text) { choose(rescale_of(text)); },
        "scanner numbers to HU: SLOPE,INTERCEPT");
}

void add_unit(VerbOptions& verb, std::optional<std::string>& unit) {
    verb.add("--unit", unit, "unit of length of a file that states none: mm, cm or m").one_of({"mm", "cm", "m"});
}

}  // namespace tactus::command
