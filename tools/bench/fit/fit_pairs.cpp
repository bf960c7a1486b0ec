// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/fit/fit_pairs.hpp"

#include "assets/library/fibula.hpp"
#include "assets/library/mandible.hpp"
#include "assets/plan/propose_paint.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fit_steps.hpp"
#include "dsp/fit/fragment_matcher.hpp"
#include "tools/analysis/bone/fracture.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::bench {

namespace {

struct Piece {
    std::vector<contact::SurfacePoint> points;
    volume::Grid distance;
    Pose place;  ///< into its bone
    int bone = 0;  ///< 0: the broken bone; 1: the same mirrored; 2: the strangers
    int mirror_of = -1;
};

const bone::Bone& whole(bool is_jaw) {
    static const bone::Bone jaw = library::make_mandible(), fibula = library::make_fibula();
    return is_jaw ? jaw : fibula;
}

void add_pieces(std::vector<Piece>& pieces, const PairGroup& group, bool is_jaw, std::uint64_t seed, int count,
                int bone) {
    analysis::FractureSettings settings;
    settings.pieces = count;
    settings.seed = seed;
    settings.chips = group.chips;
    settings.voxel = group.voxel;
    settings.spacing = std::max(0.42e-3, group.voxel);
    analysis::break_and_scan(whole(is_jaw), settings, [&](analysis::ScannedFragment fragment) {
        if (group.is_proposed) plan::propose_fracture(fragment.bone.points);
        pieces.push_back(
            {std::move(fragment.bone.points), std::move(fragment.bone.distance), fragment.place, bone, -1});
    });
}

/// Mirrored in x of its file.
Piece mirrored(const Piece& piece, int of) {
    Piece made = piece;
    made.bone = 1;
    made.mirror_of = of;
    const volume::Grid& from = piece.distance;
    for (int k = 0; k < from.size[2]; ++k)
        for (int j = 0; j < from.size[1]; ++j)
            for (int i = 0; i < from.size[0]; ++i) made.distance.at(i, j, k) = from.at(from.size[0] - 1 - i, j, k);
    made.distance.origin.x = -(from.origin.x + (from.size[0] - 1) * from.spacing.x);
    for (contact::SurfacePoint& p : made.points) p.position.x = -p.position.x, p.normal.x = -p.normal.x;
    return made;
}

/// m² of the paint of `a` that lies on `b` in the unbroken bone.
double common_area(const Piece& a, const Piece& b, const contact::Voxmap& map) {
    const Pose into = b.place.inverse() * a.place;
    double area = 0.0;
    for (const contact::SurfacePoint& p : a.points) {
        if (p.label != contact::surface_label::fracture) continue;
        const volume::Sample here = map.sample(into.apply(p.position));
        if (here.inside && std::abs(here.value) < 0.4e-3 && glm::dot(into.rotate(p.normal), here.gradient) < -0.7)
            area += p.area;
    }
    return area;
}

/// Root mean square over the paint of the nearest face between two poses, m.
double face_error(const Piece& piece, const Pose& pose, const Pose& truth, const Vec3& near) {
    double sum = 0.0, area = 0.0;
    for (const contact::SurfacePoint& p : piece.points) {
        if (p.label != contact::surface_label::fracture || glm::length(p.position - near) > 8e-3) continue;
        const Vec3 off = pose.apply(p.position) - truth.apply(p.position);
        sum += p.area * glm::dot(off, off);
        area += p.area;
    }
    return area > 0.0 ? std::sqrt(sum / area) : glm::length(pose.apply(near) - truth.apply(near));
}

Vec3 farthest_from(const Piece& piece, const Vec3& place) {
    Vec3 far = place;
    for (const contact::SurfacePoint& p : piece.points)
        if (glm::length(p.position - place) > glm::length(far - place)) far = p.position;
    return far;
}

Pose shaken(const Pose& pose, const Vec3& about, double offset, double angle, const Random& random) {
    const auto way = [&](std::uint64_t n) {
        return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
    };
    const Quat turned = glm::normalize(rotation_by(angle * way(0)) * pose.orientation);
    return {pose.apply(about) + offset * way(3) - turned * about, turned};
}

class Trials {
public:
    Trials(const PairGroup& group, std::vector<Piece> pieces) : group_(group), pieces_(std::move(pieces)) {
        std::vector<fit::FragmentSurface> surfaces;
        for (const Piece& p : pieces_) surfaces.push_back({p.points, &p.distance});
        fit::MatcherSettings settings;
        settings.max_points = 1000;
        matcher_ = std::make_unique<fit::FragmentMatcher>(surfaces, settings);
        stands_.assign(pieces_.size(), 0);
        for (const Piece& p : pieces_) maps_.push_back(contact::make_voxmap(p.distance));
    }

    std::vector<PairTrial> run() {
        const auto count = static_cast<int>(pieces_.size());
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j) {
                if (i == j || piece(i).bone != 0) continue;
                if (piece(j).bone == 2) add(i, j, "foreign", alike(i, j, false));
                if (piece(j).bone == 0) {
                    const double common = common_area(piece(i), piece(j), maps_[static_cast<std::size_t>(j)]);
                    if (common > 30e-6) {
                        add(i, j, "true", placed(i, j));
                        add(i, j, "slipped", slipped(i, j));
                    } else if (common < 2e-6) add(i, j, "neighbour", alike(i, j, true));
                }
                if (piece(j).bone == 1) {
                    const int of = piece(j).mirror_of;
                    if (of != i && common_area(piece(i), piece(of), maps_[static_cast<std::size_t>(of)]) > 30e-6)
                        add(i, j, "mirrored", reflected(i, j));
                }
            }
        return std::move(trials_);
    }

private:
    const Piece& piece(int n) const { return pieces_[static_cast<std::size_t>(n)]; }

    /// The faces of both of the most similar area; -1 when one has none.
    std::pair<int, int> similar(int i, int j) const {
        std::pair<int, int> best{-1, -1};
        double least = 1e9;
        for (std::size_t m = 0; m < matcher_->faces(); ++m)
            for (std::size_t f = 0; f < matcher_->faces(); ++f) {
                if (matcher_->fragment_of(m) != i || matcher_->fragment_of(f) != j) continue;
                const double ratio = std::abs(std::log(matcher_->face(m).area / matcher_->face(f).area));
                if (ratio < least) least = ratio, best = {static_cast<int>(m), static_cast<int>(f)};
            }
        return best;
    }

    /// The faces that look most alike on each other; as both lie in the bone, or with any spin.
    Pose alike(int i, int j, bool is_as_in_bone) const {
        const auto [m, f] = similar(i, j);
        if (m < 0) return {};
        const fit::FitSurface &a = matcher_->face(static_cast<std::size_t>(m)),
                              &b = matcher_->face(static_cast<std::size_t>(f));
        const Random random{group_.seed * 31 + static_cast<std::uint64_t>(i * 64 + j)};
        Quat from = (piece(j).place.inverse() * piece(i).place).orientation;
        if (!is_as_in_bone)
            from = rotation_by(2.0 * std::numbers::pi * random.uniform(7) * fit::direction_of(b.mean_normal));
        const Quat turned = fit::opposed(a, b, from);
        return {b.centre - turned * a.centre, turned};
    }

    Pose placed(int i, int j) const { return piece(j).place.inverse() * piece(i).place; }

    /// One relief period along the face from the true place.
    Pose slipped(int i, int j) const {
        Pose pose = placed(i, j);
        const auto [m, f] = similar(i, j);
        if (m < 0) return pose;
        const Vec3 n = fit::direction_of(matcher_->face(static_cast<std::size_t>(f)).mean_normal);
        const Vec3 t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
        pose.position += relief_period * t;
        return pose;
    }

    /// Where the true place would be if the mirror image of the partner were turned over the plane through its face.
    Pose reflected(int i, int j) const {
        const int of = piece(j).mirror_of;
        const auto [m, f] = similar(i, of);
        if (m < 0) return {};
        const fit::FitSurface& b = matcher_->face(static_cast<std::size_t>(f));
        const Vec3 n = fit::direction_of(b.mean_normal);
        const Vec3 t = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
        // p' = S_t p about the face, which is the rotation R = S_t S_x of what was mirrored in x.
        const Mat3 plane = Mat3(1.0) - 2.0 * glm::outerProduct(t, t);
        Mat3 x(1.0);
        x[0][0] = -1.0;
        const Quat turned = glm::normalize(glm::quat_cast(plane * x));
        const Pose image{b.centre - plane * b.centre, turned};  // the mirrored file in the frame of the true partner
        return image.inverse() * placed(i, of);
    }

    void add(int i, int j, const char* kind, const Pose& place) {
        if (matcher_->faces_of(i) == 0 || matcher_->faces_of(j) == 0) return;
        const bool is_slipped = std::string_view(kind) == "slipped",
                   is_true = is_slipped || std::string_view(kind) == "true";
        std::vector<Pose> poses(pieces_.size());
        std::ranges::fill(stands_, 0);
        stands_[static_cast<std::size_t>(j)] = 1;
        const auto [m, f] = similar(i, j);
        const Vec3 middle = is_true ? touching(i, j) : matcher_->face(static_cast<std::size_t>(m)).centre;
        const Random random{group_.seed * 97 + static_cast<std::uint64_t>(i * 64 + j)};
        poses[static_cast<std::size_t>(i)] = is_true && !is_slipped ? shaken(place, middle, 4e-3, 10.0 * degree, random)
                                                                    : shaken(place, middle, 2e-3, 5.0 * degree, random);
        // A global search does not depend on the start.
        const Pose truth = is_slipped ? placed(i, j) : place;
        for (const bool is_global : {false, true}) {
            if (is_slipped && is_global) continue;
            PairTrial trial;
            trial.kind = kind;
            trial.is_global = is_global;
            trial.moving = i;
            trial.partner = j;
            const fit::FitSettings usual = matcher_->settings.fit;
            fit::FitSettings& s = matcher_->settings.fit;
            s.min_score = s.min_margin = s.min_share = s.min_overlap = 0.0;
            s.max_rms = 2.0;
            s.max_far = std::numeric_limits<double>::infinity();
            const fit::FragmentMatch loose = look(i, poses, is_global);
            s = usual;
            s.max_far = std::numeric_limits<double>::infinity();
            const fit::FragmentMatch unheld = look(i, poses, is_global);
            s = usual;
            // The limit changes nothing where it refuses nothing.
            const bool is_refused = unheld.verdict == fit::FitVerdict::fit && unheld.precision.far > usual.max_far;
            const fit::FragmentMatch strict = is_refused ? look(i, poses, is_global) : unheld;
            trial.unheld = unheld.verdict;
            trial.held = unheld.precision.far;
            trial.loose = loose.verdict;
            trial.verdict = strict.verdict;
            trial.has_rival = strict.bound.has_rival;
            trial.score = loose.quality.score;
            trial.margin = loose.margin;
            trial.share = loose.quality.share;
            trial.overlap = loose.quality.overlap;
            trial.rms = loose.quality.rms;
            if (is_true) {
                trial.error = face_error(piece(i), loose.pose, truth, middle);
                trial.verdict_error = face_error(piece(i), strict.pose, truth, middle);
                const Vec3 end = farthest_from(piece(i), middle);
                trial.far_error = glm::length(unheld.pose.apply(end) - truth.apply(end));
            }
            trials_.push_back(trial);
        }
    }

    /// The middle of the paint of i that lies on j, in the file of i.
    Vec3 touching(int i, int j) const {
        const Pose into = placed(i, j);
        Vec3 sum(0.0);
        double area = 0.0;
        for (const contact::SurfacePoint& p : piece(i).points) {
            if (p.label != contact::surface_label::fracture) continue;
            const volume::Sample here = maps_[static_cast<std::size_t>(j)].sample(into.apply(p.position));
            if (!here.inside || std::abs(here.value) > 0.4e-3) continue;
            sum += p.area * p.position;
            area += p.area;
        }
        return area > 0.0 ? sum / area : Vec3(0.0);
    }

    fit::FragmentMatch look(int i, const std::vector<Pose>& poses, bool is_global) {
        if (!is_global) return matcher_->near(i, poses, stands_);
        fit::FragmentMatch match;
        matcher_->begin_search();
        do match = matcher_->search(i, poses, stands_);
        while (matcher_->left() > 0);
        return match;
    }

    PairGroup group_;
    std::vector<Piece> pieces_;
    std::unique_ptr<fit::FragmentMatcher> matcher_;
    std::vector<contact::Voxmap> maps_;
    std::vector<char> stands_;
    std::vector<PairTrial> trials_;
};

}  // namespace

PairGroup pair_group(int number) {
    PairGroup group;
    group.is_jaw = number % 2 == 0;
    group.seed = 7000 + static_cast<std::uint64_t>(number);
    group.chips = 0.1 * (number / 2 % 3);
    group.voxel = number / 3 % 2 == 0 ? 0.35e-3 : 0.5e-3;
    group.is_proposed = number / 4 % 2 == 1;
    return group;
}

std::vector<PairTrial> try_pairs(const PairGroup& group) {
    std::vector<Piece> pieces;
    add_pieces(pieces, group, group.is_jaw, group.seed, group.is_jaw ? 5 : 4, 0);
    const std::size_t own = pieces.size();
    for (std::size_t n = 0; n < own; ++n) pieces.push_back(mirrored(pieces[n], static_cast<int>(n)));
    add_pieces(pieces, group, !group.is_jaw, group.seed + 500'000, 3, 2);
    return Trials(group, std::move(pieces)).run();
}

}  // namespace tactus::bench
