// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_mirror.hpp"

#include "assets/bone/mesh_part.hpp"
#include "assets/plan/kept_result.hpp"
#include "assets/plan/mesh_unit.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/fit/mutual_gap.hpp"
#include "tools/analysis/bone/kept_numbers.hpp"
#include "tools/analysis/workers.hpp"

#include <glm/common.hpp>

#include <limits>

namespace tactus::analysis {

namespace {

// To be raised with every change of code that changes a registration: dsp/fit/registration, dsp/fit/gap.cpp,
// sampling and import of what is registered.
constexpr int mirror_algorithm = 6;

// m: of surfaces that only a registration uses; it takes some thousand points, and distances are from their planes.
constexpr double registered_spacing = 1e-3;
constexpr double beside = 8e-3;  // m around a fragment: more than the distance of faces that face each other

}  // namespace

MirrorStudy::MirrorStudy(const plan::CasePlan& plan, const std::filesystem::path& folder, int main,
                         const std::filesystem::path& healthy, bool is_mirrored)
    : fragments_(plan::fragments_of(plan)),
      folder_(folder),
      healthy_(healthy),
      main_(main),
      loaded_(plan.fragments.size()) {
    plan::check_files(plan, folder);
    plan::CasePlan named;
    plan::add_fragment(named, "healthy", healthy, folder, Vec3(0.0));
    plan::ResultKey key(is_mirrored ? "mirrored side on a fragment" : "same side on a fragment", mirror_algorithm);
    key.add_file(healthy).add_file(file_of_fragment(main));
    NumberReader read(known(key, mirror_fit_numbers, [&] {
        return numbers_of_mirror_fit(is_mirrored ? fit::fit_mirror(healthy_points(), main_points())
                                                 : fit::fit_same_side(healthy_points(), main_points()));
    }));
    fit_ = read.mirror_fit();
    target_.is_mirrored = is_mirrored;
    target_.file = named.fragments[0].file;
    target_.hash = named.fragments[0].hash;
    target_.plane_normal = fit_.plane.normal;
    target_.plane_offset = fit_.plane.offset;
    stands_ = plan::state_of(plan).arrangement.pose(main);
    target_.pose = stands_ * fit_.pose;
    target_.residual = fit_.registration.median;
}

std::vector<double> MirrorStudy::known(const plan::ResultKey& key, std::size_t count,
                                       const std::function<std::vector<double>()>& make) {
    std::string note;
    std::vector<double> numbers = plan::result_of(key, count, note, make);
    if (!note.empty()) notes_.push_back(note);
    return numbers;
}

std::filesystem::path MirrorStudy::file_of_fragment(int fragment) const {
    return plan::file_of(fragments_[static_cast<std::size_t>(fragment)].file, folder_);
}

const CaseFragment& MirrorStudy::loaded(int fragment) {
    auto& one = loaded_[static_cast<std::size_t>(fragment)];
    if (!one) one = load_fragment(fragments_[static_cast<std::size_t>(fragment)], folder_);
    return *one;
}

const std::vector<contact::SurfacePoint>& MirrorStudy::healthy_points() {
    if (points_.empty()) points_ = points_of_file(healthy_, registered_spacing);
    return points_;
}

std::vector<contact::SurfacePoint> MirrorStudy::main_points() {
    const std::filesystem::path file = file_of_fragment(main_);
    if (!is_mesh(file)) return loaded(main_).bone.points;
    try {
        const volume::Grid coarse = bone::distance_of_mesh(
            {.input = file, .unit = plan::unit_of_file(file), .is_coarse = true, .within = {}, .run = on_threads()});
        std::vector<contact::SurfacePoint> points = contact::sample_surface(coarse, {.spacing = registered_spacing});
        if (!points.empty()) return points;
    } catch (const Error&) {
        // Loading it whole says the same, and names the fragment.
    }
    return loaded(main_).bone.points;
}

MirrorStudy::MainPart MirrorStudy::main_part(int other, std::span<const Pose> poses) {
    const std::filesystem::path file = file_of_fragment(main_);
    if (!is_mesh(file)) return {loaded(main_).bone.points, loaded(main_).map};
    // A whole bone in fine voxels takes most of the time; only what is near the other fragment is looked at.
    std::array<Vec3, 2> box{Vec3(std::numeric_limits<double>::infinity()),
                            Vec3(-std::numeric_limits<double>::infinity())};
    for (const Pose& pose : poses) {
        const Pose into = stands_.inverse() * pose;
        for (const contact::SurfacePoint& p : loaded(other).bone.points) {
            box[0] = glm::min(box[0], into.apply(p.position) - Vec3(beside));
            box[1] = glm::max(box[1], into.apply(p.position) + Vec3(beside));
        }
    }
    const volume::Grid distance = bone::distance_of_mesh(
        {.input = file, .unit = plan::unit_of_file(file), .is_coarse = false, .within = box, .run = on_threads()});
    return {contact::sample_surface(distance, {}), contact::make_voxmap(distance)};
}

const fit::RegistrationTarget& MirrorStudy::surface() {
    if (!surface_)
        surface_.emplace(target_.is_mirrored ? fit::mirrored(healthy_points(), fit_.plane, target_.pose)
                                             : fit::moved(healthy_points(), target_.pose));
    return *surface_;
}

FacesThere MirrorStudy::faces_there(int moving, const Pose& at, const MainPart& main) {
    const CaseFragment& other = loaded(moving);
    const fit::MutualGap gap = fit::mutual_gap(placed_bone(other, at), {main.points, &main.map, stands_, stands_});
    return {gap.facing, gap.contact, gap.median, gap.deepest,
            fit::overlap_volume(other.map.grid, at, main.map, stands_)};
}

namespace {

void add_faces(std::vector<double>& numbers, const FacesThere& f) {
    numbers.insert(numbers.end(), {f.facing, f.contact, f.median, f.deepest, f.overlap});
}

FacesThere read_faces(NumberReader& read) {
    FacesThere f;
    for (double* number : {&f.facing, &f.contact, &f.median, &f.deepest, &f.overlap}) *number = read.next();
    return f;
}

std::vector<double> numbers_of_comparison(const MirrorComparison& c) {
    std::vector<double> numbers;
    add_registration(numbers, c.registration);
    numbers.insert(numbers.end(), {c.away.distance, c.away.angle_deg});
    add_faces(numbers, c.before);
    add_faces(numbers, c.after);
    return numbers;
}

}  // namespace

MirrorComparison MirrorStudy::compare(int other, const Pose& from) {
    constexpr std::size_t count = registration_numbers + 12;
    const auto key_at = [&](const Pose& pose) {
        plan::ResultKey key("fragment on the mirrored side", mirror_algorithm);
        for (const int n : {main_, other}) key.add_file(file_of_fragment(n));
        key.add_file(healthy_).add("mirrored", target_.is_mirrored);
        for (const Pose& p : {target_.pose, stands_, pose}) add_pose(key, p);
        return key;
    };
    NumberReader read(known(key_at(from), count, [&] {
        fit::RegistrationSettings settings;
        settings.widest = 10e-3;
        MirrorComparison made;
        const std::vector<contact::SurfacePoint>& points = loaded(other).bone.points;
        made.registration = fit::register_surface(points, surface(), from, settings);
        made.away = motion_between(from, made.registration.pose, middle_of(points));
        const MainPart main = main_part(other, std::array{from, made.registration.pose});
        made.before = faces_there(other, from, main);
        made.after = faces_there(other, made.registration.pose, main);
        // A fragment that has been moved there is there.
        MirrorComparison there = made;
        there.registration.before = made.registration.median;
        there.away = {};
        there.before = made.after;
        plan::keep_result(key_at(made.registration.pose), numbers_of_comparison(there));
        return numbers_of_comparison(made);
    }));
    MirrorComparison found;
    found.registration = read.registration();
    found.away.distance = read.next();
    found.away.angle_deg = read.next();
    found.before = read_faces(read);
    found.after = read_faces(read);
    return found;
}

}  // namespace tactus::analysis
