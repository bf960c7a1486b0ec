// SPDX-License-Identifier: Apache-2.0
#include "assets/transform/transform_file.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus::transform {

namespace {

constexpr double farthest_mm = 1e5;

/// What stands in a file: x_before = matrix (x_after - centre) + centre + translation, mm.
struct Stored {
    Mat3 matrix{1.0};
    Vec3 translation{0.0}, centre{0.0};
};

struct Line {
    int number;
    std::string_view value;  ///< behind the colon
};

std::vector<double> numbers_of(const Line& line, const std::string& file) {
    std::vector<double> numbers;
    std::string_view rest = line.value;
    while (true) {
        const std::size_t start = rest.find_first_not_of(" \t\r");
        if (start == std::string_view::npos) return numbers;
        rest.remove_prefix(start);
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r"));
        double value = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size() || !(std::abs(value) <= farthest_mm))
            throw Error({file, line.number, 1}, fmt::format("'{}' is not a number of a transform in mm", word));
        numbers.push_back(value);
        rest.remove_prefix(word.size());
    }
}

Vec3 three(const std::vector<double>& numbers, std::size_t from) {
    return {numbers[from], numbers[from + 1], numbers[from + 2]};
}

/// The turn of a versor, the vector part of a unit quaternion.
Mat3 turn_of_versor(const Vec3& v, double w) { return glm::mat3_cast(glm::normalize(Quat(w, v.x, v.y, v.z))); }

/// Turns about x, y and z: z·x·y, or z·y·x if the file says so.
Mat3 turn_of_angles(const Vec3& angles, bool is_zyx) {
    const Quat x = glm::angleAxis(angles.x, Vec3(1.0, 0.0, 0.0)), y = glm::angleAxis(angles.y, Vec3(0.0, 1.0, 0.0)),
               z = glm::angleAxis(angles.z, Vec3(0.0, 0.0, 1.0));
    return glm::mat3_cast(is_zyx ? z * y * x : z * x * y);
}

Stored stored_of(std::string_view type, const Line& parameters, const std::vector<double>& fixed,
                 const std::string& file) {
    const std::vector<double> given = numbers_of(parameters, file);
    const auto needs = [&](std::size_t count) {
        if (given.size() != count)
            throw Error({file, parameters.number, 1},
                        fmt::format("{} needs {} parameters, not {}", type, count, given.size()));
    };
    Stored stored;
    if (fixed.size() >= 3) stored.centre = three(fixed, 0);
    if (type == "AffineTransform" || type == "MatrixOffsetTransformBase") {
        needs(12);
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                stored.matrix[column][row] = given[static_cast<std::size_t>(3 * row + column)];
        stored.translation = three(given, 9);
    } else if (type == "Euler3DTransform") {
        needs(6);
        stored.matrix = turn_of_angles(three(given, 0), fixed.size() > 3 && fixed[3] != 0.0);
        stored.translation = three(given, 3);
    } else if (type == "VersorRigid3DTransform") {
        needs(6);
        const Vec3 v = three(given, 0);
        stored.matrix = turn_of_versor(v, std::sqrt(std::max(0.0, 1.0 - glm::dot(v, v))));
        stored.translation = three(given, 3);
    } else if (type == "QuaternionRigidTransform") {
        needs(7);
        stored.matrix = turn_of_versor(three(given, 0), given[3]);
        stored.translation = three(given, 4);
    } else
        throw Error(
            fmt::format("{}: a '{}' is not read: use a rigid or linear transform, hardened to one matrix", file, type));
    return stored;
}

}  // namespace

std::string text_of(const Pose& motion) {
    const Pose back = motion.inverse();
    const Mat3 m = glm::mat3_cast(back.orientation);
    std::string text = "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\nParameters:";
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) text += fmt::format(" {}", m[column][row]);
    for (int axis = 0; axis < 3; ++axis) text += fmt::format(" {}", back.position[axis] / mm);
    return text + "\nFixedParameters: 0 0 0\n";
}

Pose motion_of_text(std::string_view text, const std::string& file) {
    if (!text.starts_with("#Insight Transform File"))
        throw Error(
            fmt::format("{}: does not begin with '#Insight Transform File': expected a transform (.tfm)", file));
    std::string_view type;
    std::optional<Line> parameters, fixed;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        const std::size_t colon = line.find(':');
        if (line.starts_with('#') || colon == std::string_view::npos) continue;
        const std::string_view key = line.substr(0, colon), value = line.substr(colon + 1);
        if (key == "Transform") {
            if (!type.empty())
                throw Error({file, number, 1}, "a second transform: harden the transforms to one before saving");
            const std::size_t from = value.find_first_not_of(' '), to = value.find('_');
            if (from == std::string_view::npos || to == std::string_view::npos || to <= from)
                throw Error({file, number, 1}, "a transform needs a type such as AffineTransform_double_3_3");
            type = value.substr(from, to - from);
            if (value.substr(to).find("_3_3") == std::string_view::npos)
                throw Error({file, number, 1}, "the transform is not one of three dimensions");
        } else if (key == "Parameters") parameters = Line{number, value};
        else if (key == "FixedParameters") fixed = Line{number, value};
    }
    if (type.empty() || !parameters) throw Error(fmt::format("{}: has no transform with 'Parameters'", file));
    const Stored stored = stored_of(type, *parameters, fixed ? numbers_of(*fixed, file) : std::vector<double>{}, file);
    // Numbers that other programs print have six digits or more.
    constexpr double tolerance = 1e-4;
    const Mat3 product = glm::transpose(stored.matrix) * stored.matrix;
    for (int n = 0; n < 3; ++n)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(product[n][k] - (n == k ? 1.0 : 0.0)) < tolerance))
                throw Error(fmt::format("{}: the transform scales or shears; bones are rigid", file));
    if (glm::determinant(stored.matrix) < 0.0) throw Error(fmt::format("{}: the transform mirrors", file));
    const Vec3 offset = stored.translation + stored.centre - stored.matrix * stored.centre;
    return Pose{offset * mm, glm::normalize(glm::quat_cast(stored.matrix))}.inverse();
}

Pose read_motion(const std::filesystem::path& path) {
    return motion_of_text(file::read_whole_file(path), path.string());
}

}  // namespace tactus::transform
