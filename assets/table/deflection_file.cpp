// SPDX-License-Identifier: Apache-2.0
#include "assets/table/deflection_file.hpp"

#include "assets/table/number_table.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <set>

namespace tactus::table {

control::DeflectionTable load_deflection_table(const std::filesystem::path& path) {
    const NumberTable file = load_number_table(path);
    file.know({"force_N", "loading_mm", "unloading_mm"});
    control::DeflectionTable table{file.numbers("force_N"), file.numbers("loading_mm"), file.numbers("unloading_mm")};
    for (double& x : table.loading) x *= 1e-3;
    for (double& x : table.unloading) x *= 1e-3;
    if (const std::string fault = table.fault(); !fault.empty()) throw Error({path.string(), 0, 0}, fault);
    return table;
}

simulate::LineFit load_force_calibration(const std::filesystem::path& path) {
    const NumberTable file = load_number_table(path);
    file.know({"reading", "force_N"});
    const std::vector<double> readings = file.numbers("reading"), forces = file.numbers("force_N");
    if (std::set<double>(forces.begin(), forces.end()).size() < 3)
        throw Error({path.string(), 0, 0}, "a calibration needs at least three different forces");
    const simulate::LineFit fit = simulate::fit_line(readings, forces);
    if (!(fit.r_squared > 0.99))
        throw Error({path.string(), 0, 0},
                    fmt::format("readings and forces do not lie on a line (r² {:.3f}, worst point {:.2g} N off)",
                                fit.r_squared, fit.worst_residual));
    return fit;
}

}  // namespace tactus::table
