// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_mirror.hpp"

#include "tools/study/bones/kept_numbers.hpp"
#include "tools/study/bones/kept_result.hpp"

namespace tactus::study {

namespace {

// To be raised with every change of code that changes a registration: dsp/fit/registration.cpp, mirror.cpp, gap.cpp,
// sampling and import of what is registered.
constexpr int algorithm = 1;

}  // namespace

MirrorStudy::MirrorStudy(const cases::CasePlan& plan, const std::filesystem::path& folder, int main,
                         const std::filesystem::path& healthy)
    : plan_(plan), folder_(folder), healthy_(healthy), main_(main), loaded_(plan.fragments.size()) {
    cases::check_files(plan, folder);
    cases::CasePlan named;
    cases::add_fragment(named, "healthy", healthy, folder, Vec3(0.0));
    ResultKey key("mirrored side on a fragment", algorithm);
    key.add_file(healthy).add_file(cases::file_of(plan.fragments[static_cast<std::size_t>(main)].file, folder));
    NumberReader read(known(key, mirror_fit_numbers, [&] {
        return numbers_of_mirror_fit(fit::fit_mirror(healthy_points(), loaded(main_).bone.points));
    }));
    fit_ = read.mirror_fit();
    target_.file = named.fragments[0].file;
    target_.hash = named.fragments[0].hash;
    target_.plane_normal = fit_.plane.normal;
    target_.plane_offset = fit_.plane.offset;
    stands_ = cases::state_of(plan).arrangement.pose(main);
    target_.pose = stands_ * fit_.pose;
    target_.residual = fit_.registration.median;
}

std::vector<double> MirrorStudy::known(const ResultKey& key, std::size_t count,
                                       const std::function<std::vector<double>()>& make) {
    std::string note;
    std::vector<double> numbers = result_of(key, count, note, make);
    if (!note.empty()) notes_.push_back(note);
    return numbers;
}

const CaseFragment& MirrorStudy::loaded(int fragment) {
    auto& one = loaded_[static_cast<std::size_t>(fragment)];
    if (!one) one = load_fragment(plan_.fragments[static_cast<std::size_t>(fragment)], folder_);
    return *one;
}

const std::vector<contact::SurfacePoint>& MirrorStudy::healthy_points() {
    if (points_.empty()) points_ = points_of_file(healthy_);
    return points_;
}

const fit::RegistrationTarget& MirrorStudy::surface() {
    if (!surface_) surface_.emplace(fit::mirrored(healthy_points(), fit_.plane, target_.pose));
    return *surface_;
}

FacesThere MirrorStudy::faces_there(int moving, const Pose& at) {
    const CaseFragment &other = loaded(moving), &main = loaded(main_);
    const fit::SurfaceGap gap = fit::gap_between(other.bone.points, at, main.map, stands_);
    return {gap.facing_area, gap.contact_area, gap.median, gap.deepest,
            fit::overlap_volume(other.bone.distance, at, main.map, stands_)};
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
        ResultKey key("fragment on the mirrored side", algorithm);
        for (const int n : {main_, other})
            key.add_file(cases::file_of(plan_.fragments[static_cast<std::size_t>(n)].file, folder_));
        key.add_file(healthy_);
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
        made.before = faces_there(other, from);
        made.after = faces_there(other, made.registration.pose);
        // A fragment that has been moved there is there.
        MirrorComparison there = made;
        there.registration.before = made.registration.median;
        there.away = {};
        there.before = made.after;
        keep_result(key_at(made.registration.pose), numbers_of_comparison(there));
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

}  // namespace tactus::study
