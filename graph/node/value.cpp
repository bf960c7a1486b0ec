// SPDX-License-Identifier: Apache-2.0
#include "graph/node/value.hpp"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <new>
#include <vector>

namespace tactus::value {

namespace {

constexpr std::string_view pose_columns[] = {"px", "py", "pz", "qw", "qx", "qy", "qz"};
constexpr std::string_view twist_columns[] = {"vx", "vy", "vz", "wx", "wy", "wz"};
constexpr std::string_view wrench_columns[] = {"fx", "fy", "fz", "tx", "ty", "tz"};
constexpr std::string_view vector_columns[] = {"x", "y", "z"};
constexpr std::string_view number_columns[] = {"value"};
/// How many there are, how many were lost; the kind and the first number of the last one.
constexpr std::string_view event_columns[] = {"count", "lost", "kind", "value"};

template <class T>
const T& as(const void* p) {
    return *static_cast<const T*>(p);
}

template <class T>
void hash_words(Hash& hash, const void* p) {
    static_assert(sizeof(T) % 8 == 0);
    hash.add_bytes(p, sizeof(T));
}

template <class T>
void set_default(void* out) {
    new (out) T{};
}

void put(const Vec3& v, double* out) {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

Vec3 mix(const Vec3& a, const Vec3& b, double t) { return a + (b - a) * t; }

}  // namespace

const ValueType pose{
    .name = "pose",
    .size = sizeof(Pose),
    .columns = pose_columns,
    .hash = hash_words<Pose>,
    .interpolate =
        [](const void* a, const void* b, double t, void* out) {
            *static_cast<Pose*>(out) = {mix(as<Pose>(a).position, as<Pose>(b).position, t),
                                        glm::slerp(as<Pose>(a).orientation, as<Pose>(b).orientation, t)};
        },
    .to_columns =
        [](const void* p, double* out) {
            const Quat& q = as<Pose>(p).orientation;
            put(as<Pose>(p).position, out);
            out[3] = q.w;
            out[4] = q.x;
            out[5] = q.y;
            out[6] = q.z;
        },
    .make_default = set_default<Pose>,
};

const ValueType twist{
    .name = "twist",
    .size = sizeof(Twist),
    .columns = twist_columns,
    .hash = hash_words<Twist>,
    .interpolate =
        [](const void* a, const void* b, double t, void* out) {
            *static_cast<Twist*>(out) = {mix(as<Twist>(a).linear, as<Twist>(b).linear, t),
                                         mix(as<Twist>(a).angular, as<Twist>(b).angular, t)};
        },
    .to_columns =
        [](const void* p, double* out) {
            put(as<Twist>(p).linear, out);
            put(as<Twist>(p).angular, out + 3);
        },
    .make_default = set_default<Twist>,
};

const ValueType wrench{
    .name = "wrench",
    .size = sizeof(Wrench),
    .columns = wrench_columns,
    .hash = hash_words<Wrench>,
    .interpolate =
        [](const void* a, const void* b, double t, void* out) {
            *static_cast<Wrench*>(out) = {mix(as<Wrench>(a).force, as<Wrench>(b).force, t),
                                          mix(as<Wrench>(a).torque, as<Wrench>(b).torque, t)};
        },
    .to_columns =
        [](const void* p, double* out) {
            put(as<Wrench>(p).force, out);
            put(as<Wrench>(p).torque, out + 3);
        },
    .make_default = set_default<Wrench>,
};

const ValueType vector{
    .name = "vector",
    .size = sizeof(Vec3),
    .columns = vector_columns,
    .hash = hash_words<Vec3>,
    .interpolate = [](const void* a, const void* b, double t,
                      void* out) { *static_cast<Vec3*>(out) = mix(as<Vec3>(a), as<Vec3>(b), t); },
    .to_columns = [](const void* p, double* out) { put(as<Vec3>(p), out); },
    .make_default = [](void* out) { new (out) Vec3(0.0); },
};

const ValueType number{
    .name = "number",
    .size = sizeof(double),
    .columns = number_columns,
    .hash = hash_words<double>,
    .interpolate = [](const void* a, const void* b, double t,
                      void* out) { *static_cast<double*>(out) = as<double>(a) + (as<double>(b) - as<double>(a)) * t; },
    .to_columns = [](const void* p, double* out) { *out = as<double>(p); },
    .make_default = set_default<double>,
};

const ValueType boolean{
    .name = "bool",
    .size = sizeof(bool),
    .columns = number_columns,
    .hash = [](Hash& hash, const void* p) { hash.add_word(as<bool>(p) ? 1 : 0); },
    .to_columns = [](const void* p, double* out) { *out = as<bool>(p) ? 1.0 : 0.0; },
    .make_default = set_default<bool>,
};

const ValueType signal{
    .name = "signal",
    .size = sizeof(float),
    .columns = number_columns,
    .hash = [](Hash& hash, const void* p) { hash.add_word(std::bit_cast<std::uint32_t>(as<float>(p))); },
    .to_columns = [](const void* p, double* out) { *out = static_cast<double>(as<float>(p)); },
    .make_default = set_default<float>,
};

const ValueType event{
    .name = "event",
    .size = sizeof(Events),
    .columns = event_columns,
    .hash =
        [](Hash& hash, const void* p) {
            const auto& events = as<Events>(p);
            hash.add_bytes(&events, sizeof(EventList));
            hash.add_bytes(events.events(), static_cast<std::size_t>(events.count) * sizeof(Event));
        },
    .to_columns =
        [](const void* p, double* out) {
            const auto& events = as<Events>(p);
            const Event last = events.count > 0 ? events.all().back() : Event{};
            out[0] = events.count;
            out[1] = events.lost;
            out[2] = static_cast<double>(last.kind);
            out[3] = last.values[0];
        },
    .make_default = set_default<Events>,
};

const ValueType undecided{
    .name = "type of the input",
    .size = sizeof(double),
    .columns = {},
    .hash = hash_words<double>,
    .make_default = set_default<double>,
};

std::span<const ValueType* const> plain_types() {
    static constexpr std::array<const ValueType*, 7> types{&number, &boolean, &signal, &vector, &pose, &twist, &wrench};
    return types;
}

}  // namespace tactus::value

namespace tactus {

bool is_finite_value(const ValueType& type, const void* value) noexcept {
    constexpr std::size_t most = 8;
    std::array<double, most> numbers{};
    if (&type == &value::event || !type.to_columns || type.columns.size() > most) return true;
    type.to_columns(value, numbers.data());
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

ValueKinds kind_of(const ValueType& type) {
    unsigned bit = 1;
    for (const ValueType* plain : value::plain_types()) {
        if (plain == &type) return static_cast<ValueKinds>(bit);
        bit <<= 1;
    }
    return &type == &value::event ? ValueKinds{0} : kinds::snapshot;
}

std::string value::with_article(const ValueType& type) {
    const bool is_vowel = std::string_view("aeio").find(type.name.front()) != std::string_view::npos;
    return std::string(is_vowel ? "an " : "a ") + std::string(type.name);
}

std::string type_names(ValueKinds set) {
    std::vector<std::string_view> names;
    for (const ValueType* plain : value::plain_types())
        if (set & kind_of(*plain)) names.push_back(plain->name);
    if (set & kinds::snapshot) names.emplace_back("snapshot");
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
        text += names[i];
    }
    return text;
}

}  // namespace tactus
