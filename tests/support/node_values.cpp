// SPDX-License-Identifier: Apache-2.0
#include "tests/support/node_values.hpp"

#include "dsp/carve/cut_front.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tactus::test {

namespace {

constexpr double nasty[] = {std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::max(),
                            -1e300,
                            5e-324,
                            1e-310,
                            -0.0};

/// Draws numbers one after the other for one value.
struct Draw {
    const Random& random;
    std::uint64_t at;
    Feed feed;

    double number(double span) {
        const double u = random.uniform(at++);
        if (feed == Feed::hostile && random.uniform(at++) < 0.2) return nasty[random.bits(at++) % std::size(nasty)];
        return (2.0 * u - 1.0) * span;
    }
    Vec3 vector(double span) {
        const double x = number(span), y = number(span), z = number(span);
        return {x, y, z};
    }
    Pose pose() {
        const Vec3 position = vector(0.05);
        const double w = number(1.0), x = number(1.0), y = number(1.0), z = number(1.0);
        const Quat q(w, x, y, z);
        const double length = std::sqrt(glm::dot(q, q));
        if (length > 1e-6 && length < 10.0) return {position, q / length};
        return {position, feed == Feed::hostile ? q : Quat(1.0, 0.0, 0.0, 0.0)};
    }
};

template <class T>
void put(void* out, const T& value) {
    std::memcpy(out, &value, sizeof(T));
}

Draw draw_at(const Random& random, std::int64_t k, Feed feed) {
    return {random, static_cast<std::uint64_t>(k) * 64, feed};
}

}  // namespace

namespace {

/// A cube of bone, the same for every activation.
const volume::BoneEditor& sample_bone() {
    static const volume::BoneEditor bone = [] {
        volume::Grid distance{{20, 20, 20}, Vec3(-0.01), Vec3(0.001), std::vector<float>(8000)};
        for (int k = 0; k < 20; ++k)
            for (int j = 0; j < 20; ++j)
                for (int i = 0; i < 20; ++i) {
                    const Vec3 p = distance.position(i, j, k);
                    distance.at(i, j, k) =
                        static_cast<float>(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 0.006);
                }
        const volume::Grid density{distance.size, distance.origin, distance.spacing, std::vector<float>(8000, 1600.0f)};
        return volume::BoneEditor(distance, density, {.band = 0.1, .max_dirty = 1, .max_versions = 1});
    }();
    return bone;
}

}  // namespace

/// A ball of bone on a table, the same for every activation.
const coupling::Scene& sample_scene() {
    static const contact::Pointshell shell = contact::make_pointshell(contact::Ball{5e-3}.points(1e-3));
    static const contact::Voxmap map = contact::sample_voxmap(
        {{31, 31, 31}, Vec3(-15e-3), Vec3(1e-3), {}}, [](const Vec3& p) { return contact::Ball{5e-3}.distance(p); });
    static const geometry::TriangleTree triangles(geometry::iso_surface(map.grid, 0.0f, false));
    static const coupling::Scene scene = [] {
        coupling::Scene made;
        made.count = 2;
        for (std::size_t i = 0; i < 2; ++i) {
            made.objects[i].body = {&shell, &map, &triangles, {}, 1, 7};
            made.objects[i].pose.position.x = 9e-3 * static_cast<double>(i);
        }
        made.version = 1;
        made.content_hash = coupling::hash_of(made);
        return made;
    }();
    return scene;
}

void sample_value(const ValueType& type, const Random& random, std::int64_t k, Feed feed, void* out) {
    Draw draw = draw_at(random, k, feed);
    if (&type == &value::pose) put(out, draw.pose());
    else if (&type == &value::twist) {
        const Vec3 linear = draw.vector(1.0);
        put(out, Twist{linear, draw.vector(5.0)});
    } else if (&type == &value::wrench) {
        const Vec3 force = draw.vector(10.0);
        put(out, Wrench{force, draw.vector(0.5)});
    } else if (&type == &value::vector) put(out, draw.vector(1.0));
    else if (&type == &value::number) put(out, draw.number(10.0));
    else if (&type == &value::boolean) put(out, random.uniform(static_cast<std::uint64_t>(k)) < 0.5);
    else if (&type == &value::signal) {
        const double v = draw.number(1.0);
        // A conversion of what a float cannot hold is undefined; its own largest value stands in.
        const double largest = std::numeric_limits<float>::max();
        put(out, std::isfinite(v) && std::abs(v) > largest ? std::numeric_limits<float>::max() : static_cast<float>(v));
    } else if (&type == &value::event) {
        Events events;
        const auto n = random.bits(draw.at) % 40;
        for (std::uint64_t i = 0; i < (n < 18 ? n : 0); ++i)
            events.add(make_event(k, event_source("other"), static_cast<EventKind>(random.bits(draw.at + 9 + i) % 3),
                                  {draw.number(1.0), draw.number(1.0)}));
        put(out, events);
    } else if (type == value::snapshot<volume::BoneSnapshot>) put(out, sample_bone().current());
    else if (type == value::snapshot<carve::CutFront>) {
        carve::CutFront front;
        front.pose.position = draw.vector(0.05);
        front.kerf = 1e-3;
        front.pitch = 1.4e-3;
        front.count = 2;
        front.running = 1;
        front.seated = 3;
        front.version = k;
        front.place(0, front.pose.position);
        front.place(1, front.pose.position + Vec3(1.4e-3, 0.0, 0.0));
        put(out, front);
    } else if (type == value::snapshot<coupling::Body>) put(out, sample_scene().objects[0].body);
    else if (type == value::snapshot<coupling::Scene>) put(out, sample_scene());
    else type.make_default(out);  // of a plug-in: as before the first value
}

DeviceSample sample_device(const Random& random, std::int64_t k, Feed feed) {
    Draw draw = draw_at(random, k, feed);
    DeviceSample sample;
    sample.pose = draw.pose();
    sample.twist.linear = draw.vector(0.2);
    sample.twist.angular = draw.vector(1.0);
    for (FingerSample& finger : sample.fingers) finger = {draw.number(0.03), draw.number(5.0), 0};
    sample.buttons = static_cast<std::uint32_t>(random.bits(draw.at));
    sample.counter = k;
    sample.valid = feed == Feed::ordinary || random.uniform(draw.at + 1) < 0.8;
    return sample;
}

}  // namespace tactus::test
