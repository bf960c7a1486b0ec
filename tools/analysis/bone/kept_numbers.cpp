// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/kept_numbers.hpp"

namespace tactus::analysis {

namespace {

void add(std::vector<double>& numbers, const Pose& p) {
    numbers.insert(numbers.end(), {p.position.x, p.position.y, p.position.z, p.orientation.w, p.orientation.x,
                                   p.orientation.y, p.orientation.z});
}

}  // namespace

void add_pose(plan::ResultKey& key, const Pose& pose) {
    std::vector<double> numbers;
    add(numbers, pose);
    for (const double number : numbers) key.add("pose", number);
}

void add_registration(std::vector<double>& numbers, const fit::Registration& r) {
    add(numbers, r.pose);
    numbers.insert(numbers.end(), {r.median, r.p90, r.before, r.covered});
}

std::vector<double> numbers_of_mirror_fit(const fit::MirrorFit& fit) {
    const Vec3& n = fit.plane.normal;
    std::vector<double> numbers{n.x, n.y, n.z, fit.plane.offset};
    add(numbers, fit.pose);
    numbers.insert(numbers.end(), {fit.rotation, fit.glide});
    add_registration(numbers, fit.registration);
    return numbers;
}

Pose NumberReader::pose() {
    double n[7];
    for (double& number : n) number = next();
    return {{n[0], n[1], n[2]}, Quat(n[3], n[4], n[5], n[6])};
}

fit::Registration NumberReader::registration() {
    fit::Registration r;
    r.pose = pose();
    for (double* number : {&r.median, &r.p90, &r.before, &r.covered}) *number = next();
    return r;
}

fit::MirrorFit NumberReader::mirror_fit() {
    fit::MirrorFit fit;
    for (double* number : {&fit.plane.normal.x, &fit.plane.normal.y, &fit.plane.normal.z, &fit.plane.offset})
        *number = next();
    fit.pose = pose();
    fit.rotation = next();
    fit.glide = next();
    fit.registration = registration();
    return fit;
}

}  // namespace tactus::analysis
