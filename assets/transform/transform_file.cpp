// SPDX-License-Identifier: Apache-2.0
#include "assets/transform/transform_file.hpp"

#include "assets/file/extension.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/transform/h5_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// The content of a file: x_before = matrix (x_after - centre) + centre + translation, mm.
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

/// `line`: that of the parameters; 0 in a file without lines.
Stored stored_of(const ItkTransform& transform, const std::string& file, int line) {
    const std::string& type = transform.type;
    const std::vector<double>&given = transform.parameters, &fixed = transform.fixed;
    const auto needs = [&](std::size_t count) {
        if (given.size() == count) return;
        const std::string words = fmt::format("{} needs {} parameters, not {}", type, count, given.size());
        if (line > 0) throw Error({file, line, 1}, words);
        throw Error(fmt::format("{}: {}", file, words));
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

/// The name of a type without its precision and dimensions, which must be three.
std::string type_of(std::string_view name, const std::string& file, int line) {
    const std::size_t from = name.find_first_not_of(' '), to = name.find('_');
    const char* words = nullptr;
    if (from == std::string_view::npos || to == std::string_view::npos || to <= from)
        words = "a transform needs a type such as AffineTransform_double_3_3";
    else if (name.substr(to).find("_3_3") == std::string_view::npos)
        words = "the transform is not one of three dimensions";
    if (words && line > 0) throw Error({file, line, 1}, words);
    if (words) throw Error(fmt::format("{}: {}", file, words));
    return std::string(name.substr(from, to - from));
}

Pose motion_of(const ItkTransform& transform, const std::string& file, int line) {
    const Stored stored = stored_of(transform, file, line);
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

bool is_h5(const std::filesystem::path& path) {
    const std::string extension = file::extension_of(path);
    return extension == ".h5" || extension == ".hdf5";
}

}  // namespace

ItkTransform itk_transform_of(const Pose& motion) {
    const Pose back = motion.inverse();
    const Mat3 m = glm::mat3_cast(back.orientation);
    ItkTransform made{"AffineTransform_double_3_3", {}, {0.0, 0.0, 0.0}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) made.parameters.push_back(m[column][row]);
    for (int axis = 0; axis < 3; ++axis) made.parameters.push_back(back.position[axis] / mm);
    return made;
}

std::string text_of(const Pose& motion) {
    const ItkTransform made = itk_transform_of(motion);
    return fmt::format(
        "#Insight Transform File V1.0\n#Transform 0\nTransform: {}\nParameters: {}\nFixedParameters: {}\n", made.type,
        fmt::join(made.parameters, " "), fmt::join(made.fixed, " "));
}

Pose motion_of_transforms(const std::vector<ItkTransform>& transforms, const std::string& file) {
    if (transforms.empty()) throw Error(fmt::format("{}: contains no transform", file));
    if (transforms.size() > 1)
        throw Error(
            fmt::format("{}: contains {} transforms: harden them to one before saving", file, transforms.size()));
    ItkTransform one = transforms.front();
    one.type = type_of(one.type, file, 0);
    for (const auto* list : {&one.parameters, &one.fixed})
        for (const double value : *list)
            if (!(std::abs(value) <= farthest_mm))
                throw Error(fmt::format("{}: {} is not a number of a transform in mm", file, value));
    return motion_of(one, file, 0);
}

Pose motion_of_text(std::string_view text, const std::string& file) {
    if (!text.starts_with("#Insight Transform File"))
        throw Error(
            fmt::format("{}: does not begin with '#Insight Transform File': expected a transform (.tfm)", file));
    std::string type;
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
            type = type_of(value, file, number);
        } else if (key == "Parameters") parameters = Line{number, value};
        else if (key == "FixedParameters") fixed = Line{number, value};
    }
    if (type.empty() || !parameters) throw Error(fmt::format("{}: has no transform with 'Parameters'", file));
    return motion_of({type, numbers_of(*parameters, file), fixed ? numbers_of(*fixed, file) : std::vector<double>{}},
                     file, parameters->number);
}

Pose read_motion(const std::filesystem::path& path) {
    if (is_h5(path)) return motion_of_transforms(read_h5(path), path.string());
    return motion_of_text(file::read_whole_file(path), path.string());
}

void write_motion(const std::filesystem::path& path, const Pose& motion) {
    if (is_h5(path)) return write_h5(path, itk_transform_of(motion));
    file::write_whole_file(path, text_of(motion));
}

}  // namespace tactus::transform
