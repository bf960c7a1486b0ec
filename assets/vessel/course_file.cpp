// SPDX-License-Identifier: Apache-2.0
#include "assets/vessel/course_file.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/table/number_table.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::vessel {

double Course::median_radius() const {
    std::vector<double> sorted = radius;
    std::ranges::sort(sorted);
    return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
}

Course read_course(std::string_view text, const std::string& file) {
    const table::NumberTable table = table::read_number_table(text, file);
    table.know({"branch", "x_mm", "y_mm", "z_mm", "radius_mm", "contrast", "confidence", "parent"});
    const std::vector<double> branch = table.numbers("branch"), x = table.numbers("x_mm"), y = table.numbers("y_mm"),
                              z = table.numbers("z_mm"), radius = table.numbers("radius_mm");
    Course course;
    for (std::size_t n = 0; n < table.rows(); ++n) {
        if (branch[n] != 0.0) continue;
        const Vec3 place(x[n], y[n], z[n]);
        const auto fail = [&](const char* what) { throw Error(fmt::format("{}:{}: {}", file, table.lines[n], what)); };
        if (!is_finite(place) || !(glm::length(place) < 1e5)) fail("no place: x_mm, y_mm and z_mm must be below 1e5");
        // A narrowing may close it.
        if (!(radius[n] >= 0.0 && radius[n] <= 20.0)) fail("radius_mm must be 0 to 20");
        if (!course.points.empty() && glm::length(course.points.back() - 1e-3 * place) < 1e-6) continue;
        course.points.push_back(1e-3 * place);
        course.radius.push_back(1e-3 * radius[n]);
    }
    if (course.points.size() < 2) throw Error(fmt::format("{}: branch 0 has fewer than two points", file));
    if (!(course.median_radius() >= 0.1e-3))
        throw Error(fmt::format("{}: the median radius_mm of branch 0 must be at least 0.1", file));
    return course;
}

Course load_course(const std::filesystem::path& path) {
    return read_course(file::read_whole_file(path), path.string());
}

}  // namespace tactus::vessel
