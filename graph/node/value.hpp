// SPDX-License-Identifier: Apache-2.0
// The types of value that a wire can carry. The compiler and the engine access values only through run-time
// descriptors.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"
#include "dsp/volume/bricks.hpp"
#include "graph/node/event.hpp"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace tactus {

/// Tag of an audio wire: one float per activation.
struct Signal {};
/// Tag of a number that an audio node reads once per sample. A slower wire is interpolated to that rate.
struct Ramp {};

/// A small handle to an immutable version of a large value. `version` increases with each change.
template <class T>
concept SnapshotHandle = std::is_trivially_copyable_v<T> && requires(const T& t) {
    { t.version } -> std::convertible_to<std::int64_t>;
    { t.content_hash } -> std::convertible_to<std::uint64_t>;
};

/// Specialise this with a `load` for each `T` that a patch may wire from an asset. `load` puts the value in `out` and
/// returns its owner. Throws Error.
template <class T>
struct SnapshotFile {
    static constexpr std::shared_ptr<const void> (*load)(const std::string& path, void* out) = nullptr;
};

/// Loads a bone file as a bone that is never carved.
template <>
struct SnapshotFile<volume::BoneSnapshot> {
    static std::shared_ptr<const void> load(const std::string& path, void* out);
};

/// What the engine needs to know about a type of value. Plain types have one object each and may be compared by address;
/// of a snapshot each shared object may have its own: compare those by `==`.
struct ValueType {
    std::string_view name;  ///< as users see it: "pose", "signal"
    std::size_t size = 0;  ///< bytes of one value
    std::span<const std::string_view> columns;  ///< names of its doubles in a trace; empty: not traced
    void (*hash)(Hash&, const void*) = nullptr;
    /// Interpolates between `a` (t = 0) and `b` (t = 1); null if the type cannot be interpolated.
    void (*interpolate)(const void* a, const void* b, double t, void* out) = nullptr;
    void (*to_columns)(const void*, double* out) = nullptr;
    void (*make_default)(void* out) = nullptr;  ///< writes the default: zero, identity or empty
    std::int64_t (*version)(const void*) = nullptr;  ///< non-null for snapshots
    /// Loads a snapshot from a file: puts the handle in `out` and returns its owner. Throws Error. Null if the type
    /// cannot be loaded from a file.
    std::shared_ptr<const void> (*load_asset)(const std::string& path, void* out) = nullptr;
    std::uint64_t layout = 0;  ///< of a snapshot: `layout_of` its type in C++
};

/// Whether one wire may carry both: one object, or snapshots of one name and one layout.
inline bool operator==(const ValueType& a, const ValueType& b) noexcept {
    return &a == &b || (a.layout != 0 && a.layout == b.layout && a.name == b.name);
}

/// A hash over the name of a type in C++, its size and its alignment; never 0. A change of its members that keeps all three is
/// not seen: for types of Tactus, plug-ins compare the headers as well.
template <class T>
consteval std::uint64_t layout_of() {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    const auto add = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3ULL; };
    for (const char letter : std::string_view(__PRETTY_FUNCTION__)) add(static_cast<unsigned char>(letter));
    add(sizeof(T));
    add(alignof(T));
    return hash | 1;
}

/// All numbers of a plain value are finite; true for snapshots and events. Wait-free.
bool is_finite_value(const ValueType& type, const void* value) noexcept;

/// A set of value types, for inputs that take several: the bits of `kinds`.
using ValueKinds = std::uint8_t;

namespace kinds {
inline constexpr ValueKinds number = 1, boolean = 2, signal = 4, vector = 8, pose = 16, twist = 32, wrench = 64;
inline constexpr ValueKinds snapshot = 128;
/// Types whose values can be added.
inline constexpr ValueKinds addable = number | signal | vector | twist | wrench;
/// All types but snapshots and events.
inline constexpr ValueKinds plain = addable | boolean | pose;
inline constexpr ValueKinds every = plain | snapshot;
}  // namespace kinds

/// Returns the bit of a type in `kinds`; 0 for events, which no input of several types accepts.
ValueKinds kind_of(const ValueType& type);
/// Returns a list such as "number, vector or wrench".
std::string type_names(ValueKinds kinds);

namespace value {
extern const ValueType pose, twist, wrench, vector, number, boolean, signal;
/// The events of one activation, `Events`. They are never held and never interpolated.
extern const ValueType event;
/// Placeholder type of an output whose type is not decided by wires yet.
extern const ValueType undecided;
/// Returns "a number", "an event".
std::string with_article(const ValueType& type);
/// All plain types: those without snapshots, and no events.
std::span<const ValueType* const> plain_types();

template <SnapshotHandle T>
inline const ValueType snapshot{
    .name = T::wire_name,
    .size = sizeof(T),
    .columns = {},
    .hash = [](Hash& hash, const void* p) { hash.add_word(static_cast<const T*>(p)->content_hash); },
    .interpolate = nullptr,
    .to_columns = nullptr,
    .make_default = [](void* out) { new (out) T{}; },
    .version = [](const void* p) { return static_cast<std::int64_t>(static_cast<const T*>(p)->version); },
    .load_asset = SnapshotFile<T>::load,
    .layout = layout_of<T>(),
};
}  // namespace value

/// The descriptor of `T`.
template <class T>
constexpr const ValueType& value_type() {
    if constexpr (std::is_same_v<T, Pose>) return value::pose;
    else if constexpr (std::is_same_v<T, Twist>) return value::twist;
    else if constexpr (std::is_same_v<T, Wrench>) return value::wrench;
    else if constexpr (std::is_same_v<T, Vec3>) return value::vector;
    else if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Ramp>) return value::number;
    else if constexpr (std::is_same_v<T, bool>) return value::boolean;
    else if constexpr (std::is_same_v<T, Signal>) return value::signal;
    else if constexpr (std::is_same_v<T, Event>) return value::event;
    else return value::snapshot<T>;
}

/// The type in memory of a value of type `T` on a wire.
template <class T> struct ElementOf {
    using type = T;
};
template <> struct ElementOf<Signal> {
    using type = float;
};
template <> struct ElementOf<Ramp> {
    using type = double;
};
template <> struct ElementOf<Event> {
    using type = Events;
};
template <class T> using Element = typename ElementOf<T>::type;

}  // namespace tactus
