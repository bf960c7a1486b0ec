// SPDX-License-Identifier: Apache-2.0
// A guide as a function of position: bodies united, others subtracted.
#pragma once

#include "dsp/cutting_guide/guide.hpp"
#include "dsp/cutting_guide/seated_bone.hpp"
#include "dsp/geometry/dual_contour.hpp"

#include <memory>
#include <vector>

namespace tactus::cutting_guide {

/// Signed distance to a text, negative within letters, sampled every 0.05 mm.
class TextField {
public:
    explicit TextField(const GuideText& text);
    double value(double x, double y) const noexcept;  ///< m

private:
    double low_x_ = 0.0, low_y_ = 0.0;
    int columns_ = 0, rows_ = 0;
    std::vector<float> values_;
};

/// One face of a body.
struct Term {
    enum class Kind {
        plane,     ///< n · p - d
        above,     ///< d - distance from the seated bone: at least d away from it
        near,      ///< distance from a patch of the bone - d
        cylinder,  ///< distance from the line through `at` along n, less d
        text       ///< in the plane y = const of the text whose origin is `at`
    };
    Kind kind = Kind::plane;
    Vec3 n{0.0}, at{0.0};
    double d = 0.0;
    std::shared_ptr<const TextField> text{};
    std::shared_ptr<const Patch> patch{};
};
/// The intersection of its terms.
using Body = std::vector<Term>;

inline Term plane(const Vec3& normal, const Vec3& through) {
    return {Term::Kind::plane, normal, Vec3(0.0), normal.x * through.x + normal.y * through.y + normal.z * through.z};
}
/// On its negative side p[axis] < bound for sign 1, > bound for sign -1.
inline Term side(int axis, double sign, double bound) {
    Vec3 n(0.0);
    n[axis] = sign;
    return {Term::Kind::plane, n, Vec3(0.0), sign * bound};
}

/// The union of `parts` less all `cuts`.
class GuideSolid final : public geometry::ImplicitSolid {
public:
    explicit GuideSolid(const SeatedBone& bone) : bone_(bone) {}

    std::vector<Body> parts, cuts;

    double value(const Vec3& p) const noexcept override { return evaluate(p, nullptr, nullptr); }
    Vec3 normal(const Vec3& p) const noexcept override;
    /// Of the parts alone.
    double value_of_parts(const Vec3& p) const noexcept;

private:
    double value_of(const Term& term, const Vec3& p) const noexcept;
    /// Unit; from lesser to greater values of the term.
    Vec3 normal_of(const Term& term, const Vec3& p) const noexcept;
    /// Also the term that decides, and its sign.
    double evaluate(const Vec3& p, const Term** active, double* sign) const noexcept;

    const SeatedBone& bone_;
};

}  // namespace tactus::cutting_guide
