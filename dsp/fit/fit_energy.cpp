// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit_energy.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::fit {

namespace {

constexpr double outline_reach2 = 9e-6;  // m²: partners 3 mm apart count half
constexpr double outline_corner = 0.3e-3;  // m: beyond this a step of the outline has constant force
constexpr double chip_rim = 6.0;  // scales: how far the rounded rim of a chip reaches
constexpr double min_intact = 0.2;  // of the weight
constexpr double min_cosine = 0.5;  // mean of a face's slopes; less is no face with a direction to open along

struct Pull {
    double energy, force, stiffness;  // per weight: force = d energy / d d
};

Pull robust(const FitLaw& law, double d) noexcept {
    if (std::abs(d) > law.reach) return {};
    const double s2 = law.scale * law.scale, share = s2 / (s2 + d * d), k = law.strength * share * share;
    return {0.5 * law.strength * share * d * d, k * d, k};
}

Pull intact(const FitLaw& law, double d) noexcept {
    return {0.5 * law.strength * d * d, law.strength * d, law.strength};
}

/// Weight of an intact point at distance d, in scales.
double intact_weight(double d) noexcept {
    if (d < 0.0) return 1.0 / std::max(1.0, -d);
    return d < 1.0 ? (1.0 - d * d) * (1.0 - d * d) : 0.0;
}

Pull steady(const FitLaw& law, double d) noexcept {
    if (!(d > 0.0)) return {};
    const double soft = law.soft;
    if (d > law.reach) return {law.strength * (law.reach - 0.5 * soft), 0.0, 0.0};
    if (d < soft) return {0.5 * law.strength * d * d / soft, law.strength * d / soft, law.strength / soft};
    return {law.strength * (d - 0.5 * soft), law.strength, law.strength / d};
}

/// Adds force · J and stiffness · J Jᵀ (upper triangle) of one point with direction n at lever r.
void add_point(contact::ContactSum& sum, double force, double stiffness, const Vec3& n, const Vec3& r) noexcept {
    const Vec3 t = glm::cross(r, n);
    const double j[6] = {n.x, n.y, n.z, t.x, t.y, t.z};
    for (std::size_t a = 0; a < 6; ++a) {
        sum.gradient[a] += force * j[a];
        const double scaled = stiffness * j[a];
        for (std::size_t b = a; b < 6; ++b) sum.stiffness[6 * a + b] += scaled * j[b];
    }
}

/// Copies the upper triangle to the lower one.
void mirror(std::array<double, 36>& m) noexcept {
    for (std::size_t a = 0; a < 6; ++a)
        for (std::size_t b = 0; b < a; ++b) m[6 * a + b] = m[6 * b + a];
}

double median_of(std::vector<double>& values, std::size_t count, double share) noexcept {
    if (count == 0) return 0.0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1));
    std::nth_element(values.begin(), values.begin() + at, values.begin() + static_cast<std::ptrdiff_t>(count));
    return values[static_cast<std::size_t>(at)];
}

}  // namespace

FitEnergy::FitEnergy(const FitSurface& moving, const FitSurface& fixed) {
    reserve(std::max(moving.position.size(), fixed.position.size()),
            std::max(moving.outline.size(), fixed.outline.size()));
    rebind(moving, fixed);
}

void FitEnergy::reserve(std::size_t points, std::size_t outline) {
    for (Side& side : sides_) {
        side.weight.reserve(points);
        side.seen.reserve(points);
    }
    kept_.reserve(points);
    chips_.reserve(points);
    chip_tree_.reserve(points);
    links_.reserve(outline);
    depths_.reserve(2 * (points + outline));
}

void FitEnergy::rebind(const FitSurface& moving, const FitSurface& fixed) noexcept {
    moving_ = &moving;
    fixed_ = &fixed;
    for (std::size_t s = 0; s < 2; ++s) {
        Side& side = sides_[s];
        side.points = s == 0 ? moving_ : fixed_;
        side.field = s == 0 ? fixed_ : moving_;
        side.weight.assign(side.points->position.size(), 0.0);
        side.seen.assign(side.points->position.size(), {});
        side.seen_stride = 0;
    }
    links_.resize(moving.outline.size());
    link_count_ = 0;
    depths_.resize(moving.position.size() + fixed.position.size() + moving.outline.size() + fixed.outline.size());
}

void FitEnergy::read(Side& side, const Pose& into) const noexcept {
    if (side.seen_stride == law.stride && side.seen_at.position == into.position &&
        side.seen_at.orientation == into.orientation)
        return;
    const Mat3 rotation = glm::mat3_cast(into.orientation);
    const std::vector<Vec3>& points = side.points->position;
    for (std::size_t i = 0; i < points.size(); i += law.stride)
        side.seen[i] = side.field->field.sample(into.position + rotation * points[i]);
    side.seen_at = into;
    side.seen_stride = law.stride;
}

void FitEnergy::look(Side& side, const Pose& into) noexcept {
    read(side, into);
    const Mat3 rotation = glm::mat3_cast(into.orientation);
    const FitSurface &points = *side.points, &field = *side.field;
    for (std::size_t i = 0; i < points.position.size(); i += law.stride) {
        side.weight[i] = 0.0;
        const volume::Sample& here = side.seen[i];
        if (!here.inside) continue;
        const double against = -glm::dot(rotation * points.normal[i], here.gradient);
        if (!(against > 0.0)) continue;
        if (law.gated && !field.is_painted_near(into.position + rotation * points.position[i])) continue;
        side.weight[i] = points.share[i] * static_cast<double>(law.stride) *
                         (law.power == 1.0 ? against : std::pow(against, law.power));
    }
    if (law.kernel == FitKernel::intact) leave_out_chips(side);
}

void FitEnergy::leave_out_chips(Side& side) noexcept {
    const std::vector<Vec3>& points = side.points->position;
    chips_.clear();
    for (std::size_t i = 0; i < points.size(); i += law.stride)
        if (side.seen[i].inside && side.seen[i].value > law.scale) chips_.push_back(points[i]);
    chip_tree_.assign(chips_);
    kept_.assign(points.size(), 0.0);
    double before = 0.0, after = 0.0;
    for (std::size_t i = 0; i < points.size(); i += law.stride) {
        if (!(side.weight[i] > 0.0)) continue;
        before += side.weight[i];
        if (!chip_tree_.has_nearer(points[i], chip_rim * law.scale))
            after += kept_[i] = side.weight[i] * intact_weight(side.seen[i].value / law.scale);
    }
    if (after >= min_intact * before) {
        side.weight.swap(kept_);
        return;
    }
    for (std::size_t i = 0; i < points.size(); i += law.stride) {
        const double s2 = law.scale * law.scale, d = side.seen[i].value, share = s2 / (s2 + d * d);
        side.weight[i] *= share * share;
    }
}

void FitEnergy::link(const Pose& pose) noexcept {
    link_count_ = 0;
    if (!(law.outline > 0.0) || fixed_->outline.empty() || moving_->outline.empty()) return;
    const Mat3 rotation = glm::mat3_cast(pose.orientation);
    const double each = law.outline * law.strength / static_cast<double>(moving_->outline.size());
    const std::size_t step = law.stride > 1 ? 2 : 1;
    for (std::size_t i = 0; i < moving_->outline.size(); i += step) {
        const Vec3 x = pose.position + rotation * moving_->outline[i];
        double least = std::numeric_limits<double>::infinity();
        std::size_t nearest = 0;
        for (std::size_t j = 0; j < fixed_->outline.size(); j += step) {
            const Vec3 difference = x - fixed_->outline[j];
            const double d2 = glm::dot(difference, difference);
            if (d2 < least) least = d2, nearest = j;
        }
        const Vec3 normal = rotation * moving_->outline_normal[i], other = fixed_->outline_normal[nearest];
        const double alike = glm::dot(normal, other);
        if (!(alike > 0.0)) continue;
        links_[link_count_++] = {moving_->outline[i], fixed_->outline[nearest], 0.5 * (normal + other),
                                 each * static_cast<double>(step) * alike / (1.0 + least / outline_reach2)};
    }
}

Vec3 opening_direction(const FitSurface& moving, const FitSurface& fixed, const Pose& pose) noexcept {
    const Vec3 both = 0.5 * (fixed.plane_normal - pose.rotate(moving.plane_normal));
    const double length = glm::length(both);
    // Faces that do not look at each other have none in common.
    return length > min_cosine ? both / length : fixed.plane_normal;
}

Vec3 FitEnergy::opening(const Pose& pose) const noexcept {
    if (!(law.kerf > 0.0)) return Vec3(0.0);
    // The length of a mean normal is the mean cosine of the relief's slopes, so that the gap is wider than the distance
    // of the surfaces.
    const Vec3 &fixed = fixed_->mean_normal, both = 0.5 * (fixed - pose.rotate(moving_->mean_normal));
    const double cosine = glm::length(glm::length(both) > min_cosine ? both : fixed);
    return law.kerf / std::max(cosine, min_cosine) * opening_direction(*moving_, *fixed_, pose);
}

Pose FitEnergy::closed(const Pose& pose, const Vec3& opening) noexcept {
    return {pose.position - opening, pose.orientation};
}

void FitEnergy::look(const Pose& pose) noexcept {
    opening_ = opening(pose);
    const Pose shut = closed(pose, opening_);
    look(sides_[0], shut);
    if (law.two_sided) look(sides_[1], shut.inverse());
    link(pose);
}

void FitEnergy::add(contact::ContactSum& sum, Side& side, const Pose& pose, const Pose& into,
                    double sign) const noexcept {
    read(side, into);
    const Mat3 rotation = glm::mat3_cast(into.orientation);
    const FitSurface& points = *side.points;
    const bool is_moving = sign > 0.0;
    for (std::size_t i = 0; i < points.position.size(); i += law.stride) {
        const double weight = side.weight[i];
        if (!(weight > 0.0) && !(law.contact > 0.0)) continue;
        const volume::Sample& here = side.seen[i];
        if (!here.inside) continue;
        Pull pull = law.kernel == FitKernel::robust   ? robust(law, here.value)
                    : law.kernel == FitKernel::intact ? intact(law, here.value)
                                                      : steady(law, here.value);
        pull = {weight * pull.energy, weight * pull.force, weight * pull.stiffness};
        if (law.contact > 0.0 && here.value < 0.0) {
            pull.energy += 0.5 * law.contact * here.value * here.value;
            pull.force += law.contact * here.value;
            pull.stiffness += law.contact;
            ++sum.in_contact;
            sum.penetration = std::max(sum.penetration, -here.value);
        }
        sum.energy += pull.energy;
        ++sum.evaluated;
        // A moving field pushes the fixed point: the same direction with opposite sign.
        if (is_moving) {
            add_point(sum, pull.force, pull.stiffness, here.gradient, rotation * points.position[i]);
        } else {
            const Vec3 n = -pose.rotate(here.gradient);
            add_point(sum, pull.force, pull.stiffness, n, points.position[i] - pose.position);
        }
    }
}

void FitEnergy::add_outline(contact::ContactSum& sum, const Pose& pose) const noexcept {
    for (std::size_t n = 0; n < link_count_; ++n) {
        const Link& link = links_[n];
        const Vec3 arm = pose.rotate(link.from);
        const double step = glm::dot(link.along, pose.position + arm - link.to), size = std::abs(step);
        const double k = link.weight * (size > outline_corner ? outline_corner / size : 1.0);
        sum.energy += size > outline_corner ? link.weight * outline_corner * (size - 0.5 * outline_corner)
                                            : 0.5 * link.weight * size * size;
        add_point(sum, k * step, k, link.along, arm);
    }
}

contact::ContactSum FitEnergy::operator()(const Pose& pose, contact::ContactParts) noexcept {
    contact::ContactSum sum;
    const Pose shut = closed(pose, opening_);
    add(sum, sides_[0], shut, shut, 1.0);
    if (law.two_sided) add(sum, sides_[1], shut, shut.inverse(), -1.0);
    add_outline(sum, pose);
    mirror(sum.stiffness);
    return sum;
}

contact::ContactSum FitEnergy::look_at_half(FitHalf half, const Pose& pose) noexcept {
    contact::ContactSum sum;
    opening_ = opening(pose);
    const Pose shut = closed(pose, opening_);
    if (half == FitHalf::moving_points) {
        look(sides_[0], shut);
        link(pose);
        add(sum, sides_[0], shut, shut, 1.0);
        add_outline(sum, pose);
    } else if (law.two_sided) {
        look(sides_[1], shut.inverse());
        add(sum, sides_[1], shut, shut.inverse(), -1.0);
    }
    mirror(sum.stiffness);
    return sum;
}

double FitEnergy::noise() noexcept {
    constexpr double of_median = 1.4826;  // normal distribution: standard deviation, in median absolute deviations
    std::size_t count = 0;
    for (const Side& side : sides_)
        for (std::size_t i = 0; i < side.weight.size() && side.seen_stride == law.stride; i += law.stride)
            if (side.weight[i] > 0.0) depths_[count++] = side.seen[i].value;
    const double middle = median_of(depths_, count, 0.5);
    for (std::size_t n = 0; n < count; ++n) depths_[n] = std::abs(depths_[n] - middle);
    return of_median * median_of(depths_, count, 0.5);
}

double FitEnergy::share_beyond(double distance) const noexcept {
    double all = 0.0, beyond = 0.0;
    for (const Side& side : sides_)
        for (std::size_t i = 0; i < side.weight.size() && side.seen_stride == law.stride; i += law.stride) {
            all += side.weight[i];
            if (side.seen[i].value > distance) beyond += side.weight[i];
        }
    return all > 0.0 ? beyond / all : 0.0;
}

FitQuality FitEnergy::quality(const Pose& pose, double sigma) noexcept {
    FitQuality q;
    double squares = 0.0, covered = 0.0, signed_sum = 0.0, area = 0.0;
    std::size_t seen = 0;
    const Pose poses[2] = {pose, pose.inverse()};
    const Pose shut = closed(pose, opening(pose)), closed_poses[2] = {shut, shut.inverse()};
    for (std::size_t s = 0; s < 2; ++s) {
        const Mat3 rotation = glm::mat3_cast(poses[s].orientation);
        const FitSurface& points = *sides_[s].points;
        const contact::Voxmap& field = sides_[s].field->field;
        for (std::size_t i = 0; i < points.position.size(); i += law.stride) {
            const volume::Sample there = field.sample(poses[s].position + rotation * points.position[i]);
            if (there.inside) depths_[seen++] = there.value;
            const Vec3 at = closed_poses[s].position + rotation * points.position[i];
            const volume::Sample here = law.kerf > 0.0 ? field.sample(at) : there;
            if (!here.inside) continue;
            const double against = std::clamp(-glm::dot(rotation * points.normal[i], here.gradient), 0.0, 1.0);
            const double off = here.value;
            if (!(against > 0.0) || std::abs(off) > 5.0 * sigma || !sides_[s].field->is_painted_near(at)) continue;
            const double share = points.share[i] * static_cast<double>(law.stride);
            q.score += 0.5 * share * against * std::exp(-0.5 * off * off / (sigma * sigma));
            if (std::abs(off) > 2.0 * sigma || against < 0.7) continue;
            covered += share;
            squares += share * off * off;
            signed_sum += share * there.value;
            area += 0.5 * share * points.area;
            if (s == 0) q.overlap += share * points.area;
        }
        for (const Vec3& p : points.outline) {
            const volume::Sample here = field.sample(poses[s].position + rotation * p);
            if (here.inside) depths_[seen++] = here.value;
        }
    }
    q.covered = 0.5 * covered;
    q.share = std::min(1.0, area / std::max(std::min(moving_->area, fixed_->area), 1e-12));
    q.rms = covered > 0.0 ? std::sqrt(squares / covered) : 0.0;
    q.gap = covered > 0.0 ? signed_sum / covered : 0.0;
    q.penetration = std::max(0.0, -median_of(depths_, seen, 0.01));
    const FitLaw before = law;
    law.outline = 1.0;
    link(pose);
    law = before;
    for (std::size_t n = 0; n < link_count_; ++n)
        depths_[n] = std::abs(glm::dot(links_[n].along, pose.apply(links_[n].from) - links_[n].to));
    q.outline = median_of(depths_, link_count_, 0.5);
    return q;
}

}  // namespace tactus::fit
