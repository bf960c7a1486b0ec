// SPDX-License-Identifier: Apache-2.0
#include "assets/transform/transform_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string transform_text(const std::string& type, const std::string& parameters, const std::string& fixed = "0 0 0") {
    return "#Insight Transform File V1.0\n#Transform 0\nTransform: " + type + "\nParameters: " + parameters +
           "\nFixedParameters: " + fixed + "\n";
}

Vec3 moved(const std::string& text, const Vec3& at_mm) {
    return transform::motion_of_text(text, "f.tfm").apply(at_mm * mm) / mm;
}

std::string refusal_of_transform(const std::string& text) {
    try {
        transform::motion_of_text(text, "f.tfm");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a transform that is written and read again is the same motion") {
    std::uint64_t count = 0;
    const auto between = [&](double low, double high) { return low + (high - low) * Random{3}.uniform(++count); };
    for (int n = 0; n < 100; ++n) {
        const Pose motion{Vec3(between(-1, 1), between(-1, 1), between(-1, 1)),
                          glm::normalize(Quat(between(-1, 1), between(-1, 1), between(-1, 1), between(0.1, 1)))};
        const Pose back = transform::motion_of_text(transform::text_of(motion), "f.tfm");
        CHECK(glm::length(back.position - motion.position) < 1e-12);
        CHECK(std::abs(std::abs(glm::dot(back.orientation, motion.orientation)) - 1.0) < 1e-12);
    }
}

TEST_CASE("a file stores the map to the space before the motion, about its centre") {
    // ITK: x_before = M (x_after - c) + c + t; here a quarter turn about z, which takes x to y.
    const std::string quarter = "0 -1 0 1 0 0 0 0 1 ";
    CHECK(glm::length(moved(transform_text("AffineTransform_double_3_3", quarter + "10 0 0"), {0, 0, 0}) -
                      Vec3(0, 10, 0)) < 1e-9);
    CHECK(glm::length(
              moved(transform_text("MatrixOffsetTransformBase_double_3_3", quarter + "0 0 0", "5 0 0"), {5, 0, 0}) -
              Vec3(5, 0, 0)) < 1e-9);
    CHECK(glm::length(moved(transform_text("AffineTransform_float_3_3", quarter + "0 0 0"), {0, 1, 0}) -
                      Vec3(1, 0, 0)) < 1e-9);
}

TEST_CASE("Euler, versor and quaternion transforms are the turns that ITK takes them for") {
    // By ITK's definitions: R = Rz Rx Ry; computeZYX: Rz Ry Rx; a versor is the vector part of a unit quaternion.
    const double a = 0.3, b = -0.5, c = 0.7;
    const Quat x = glm::angleAxis(a, Vec3(1, 0, 0)), y = glm::angleAxis(b, Vec3(0, 1, 0)),
               z = glm::angleAxis(c, Vec3(0, 0, 1));
    const std::string angles = fmt::format("{} {} {} 1 2 3", a, b, c);
    const auto check = [](const std::string& text, const Quat& turn) {
        const Vec3 before(4, 5, 6), after = moved(text, before);
        CHECK(glm::length(turn * after + Vec3(1, 2, 3) - before) < 1e-9);
    };
    check(transform_text("Euler3DTransform_double_3_3", angles, "0 0 0 0"), z * x * y);
    check(transform_text("Euler3DTransform_double_3_3", angles, "0 0 0 1"), z * y * x);
    const Quat q = z * x * y;
    check(transform_text("VersorRigid3DTransform_double_3_3", fmt::format("{} {} {} 1 2 3", q.x, q.y, q.z)), q);
    check(transform_text("QuaternionRigidTransform_double_3_3", fmt::format("{} {} {} {} 1 2 3", q.x, q.y, q.z, q.w)),
          q);
}

TEST_CASE("a transform that is not one rigid motion is refused with the reason") {
    const std::string one = "1 0 0 0 1 0 0 0 1 0 0 0";
    CHECK_THAT(refusal_of_transform("1 0 0"), ContainsSubstring("does not begin with '#Insight Transform File'"));
    CHECK_THAT(refusal_of_transform("#Insight Transform File V1.0\n"), ContainsSubstring("has no transform"));
    CHECK_THAT(refusal_of_transform(transform_text("AffineTransform_double_3_3", "1 0 0")),
               ContainsSubstring("f.tfm:4:1: AffineTransform needs 12"));
    CHECK_THAT(refusal_of_transform(transform_text("AffineTransform_double_3_3", "1 0 0 0 1 0 0 0 z 0 0 0")),
               ContainsSubstring("'z' is not a number"));
    CHECK_THAT(refusal_of_transform(transform_text("AffineTransform_double_3_3", "2 0 0 0 1 0 0 0 1 0 0 0")),
               ContainsSubstring("scales or shears"));
    CHECK_THAT(refusal_of_transform(transform_text("AffineTransform_double_3_3", "-1 0 0 0 1 0 0 0 1 0 0 0")),
               ContainsSubstring("mirrors"));
    CHECK_THAT(refusal_of_transform(transform_text("AffineTransform_double_2_2", one)),
               ContainsSubstring("not one of three dimensions"));
    CHECK_THAT(refusal_of_transform(transform_text("BSplineTransform_double_3_3", one)),
               ContainsSubstring("'BSplineTransform' is not read"));
    CHECK_THAT(refusal_of_transform(transform_text("AffineTransform_double_3_3", one) +
                                    transform_text("AffineTransform_double_3_3", one)),
               ContainsSubstring("a second transform"));
}
