// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/guide_solid.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::cutting_guide {

namespace {

constexpr double text_step = 0.05e-3, text_margin = 0.5e-3;  // m

double distance_to_piece(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 ab = b - a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * ab);
}

}  // namespace

TextField::TextField(const GuideText& text) {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const Outline& outline : text.outlines)
        for (const glm::dvec2& p : outline) low = glm::min(low, p), high = glm::max(high, p);
    if (!(low.x <= high.x)) return;
    low -= text_margin, high += text_margin;
    low_x_ = low.x, low_y_ = low.y;
    columns_ = static_cast<int>(std::ceil((high.x - low.x) / text_step)) + 1;
    rows_ = static_cast<int>(std::ceil((high.y - low.y) / text_step)) + 1;
    for (int r = 0; r < rows_; ++r)
        for (int c = 0; c < columns_; ++c) {
            const glm::dvec2 p(low.x + c * text_step, low.y + r * text_step);
            double away = text_margin;
            int winding = 0;
            for (const Outline& outline : text.outlines)
                for (std::size_t n = 0; n < outline.size(); ++n) {
                    const glm::dvec2 &a = outline[n], &b = outline[(n + 1) % outline.size()];
                    if (std::min(a.x, b.x) - p.x < away && p.x - std::max(a.x, b.x) < away)
                        away = std::min(away, distance_to_piece(p, a, b));
                    if ((a.y <= p.y) == (b.y <= p.y)) continue;
                    if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) winding += a.y < b.y ? 1 : -1;
                }
            values_.push_back(static_cast<float>(winding != 0 ? -away : away));
        }
}

double TextField::value(double x, double y) const noexcept {
    if (values_.empty()) return text_margin;
    const double u = (x - low_x_) / text_step, v = (y - low_y_) / text_step;
    const double a = std::clamp(u, 0.0, columns_ - 1.0), b = std::clamp(v, 0.0, rows_ - 1.0);
    const int i = std::min(static_cast<int>(a), columns_ - 2), j = std::min(static_cast<int>(b), rows_ - 2);
    const auto at = [&](int column, int row) {
        return static_cast<double>(values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                           static_cast<std::size_t>(column)]);
    };
    const double s = a - i, t = b - j;
    const double inside =
        (1.0 - t) * ((1.0 - s) * at(i, j) + s * at(i + 1, j)) + t * ((1.0 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
    const double outside = text_step * std::max(std::abs(u - a), std::abs(v - b));
    return outside > 0.0 ? std::max(inside, outside) : inside;
}

double GuideSolid::value_of(const Term& term, const Vec3& p) const noexcept {
    switch (term.kind) {
        case Term::Kind::plane: return glm::dot(term.n, p) - term.d;
        case Term::Kind::above: return term.d - bone_.value(p);
        case Term::Kind::near: return term.patch->distance.value(p) - term.d;
        case Term::Kind::cylinder: {
            const Vec3 r = p - term.at;
            return glm::length(r - glm::dot(r, term.n) * term.n) - term.d;
        }
        case Term::Kind::text: return term.text->value(p.x - term.at.x, p.z - term.at.z);
    }
    return 0.0;
}

Vec3 GuideSolid::normal_of(const Term& term, const Vec3& p) const noexcept {
    switch (term.kind) {
        case Term::Kind::plane: return term.n;
        case Term::Kind::above: return -bone_.gradient(p);
        case Term::Kind::near: return term.patch->distance.gradient(p);
        case Term::Kind::cylinder: {
            Vec3 r = p - term.at;
            r -= glm::dot(r, term.n) * term.n;
            const double length = glm::length(r);
            return length > 0.0 ? r / length : Vec3(1.0, 0.0, 0.0);
        }
        case Term::Kind::text: {
            const double h = 0.5 * text_step;
            const Vec3 g(value_of(term, p + Vec3(h, 0.0, 0.0)) - value_of(term, p - Vec3(h, 0.0, 0.0)), 0.0,
                         value_of(term, p + Vec3(0.0, 0.0, h)) - value_of(term, p - Vec3(0.0, 0.0, h)));
            const double length = glm::length(g);
            return length > 0.0 ? g / length : Vec3(1.0, 0.0, 0.0);
        }
    }
    return Vec3(0.0);
}

double GuideSolid::value_of_parts(const Vec3& p) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (const Body& body : parts) {
        double most = -std::numeric_limits<double>::infinity();
        for (const Term& term : body) {
            most = std::max(most, value_of(term, p));
            if (most >= least) break;
        }
        least = std::min(least, most);
    }
    return least;
}

double GuideSolid::evaluate(const Vec3& p, const Term** active, double* sign) const noexcept {
    double found = std::numeric_limits<double>::infinity();
    for (const Body& body : parts) {
        double most = -std::numeric_limits<double>::infinity();
        const Term* by = nullptr;
        for (const Term& term : body) {
            const double here = value_of(term, p);
            if (here > most) most = here, by = &term;
            if (most >= found) break;
        }
        if (most >= found) continue;
        found = most;
        if (active) *active = by, *sign = 1.0;
    }
    for (const Body& body : cuts) {
        double most = -std::numeric_limits<double>::infinity();
        const Term* by = nullptr;
        for (const Term& term : body) {
            const double here = value_of(term, p);
            if (here > most) most = here, by = &term;
            if (-most <= found) break;
        }
        if (-most <= found) continue;
        found = -most;
        if (active) *active = by, *sign = -1.0;
    }
    return found;
}

Vec3 GuideSolid::normal(const Vec3& p) const noexcept {
    const Term* term = nullptr;
    double sign = 1.0;
    evaluate(p, &term, &sign);
    return term ? sign * normal_of(*term, p) : Vec3(0.0, 0.0, 1.0);
}

}  // namespace tactus::cutting_guide
