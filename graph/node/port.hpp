// SPDX-License-Identifier: Apache-2.0
// Ports: the members of a node through which wires reach it. The engine points them at the values before each call.
#pragma once

#include "dsp/core/time.hpp"
#include "graph/node/param.hpp"
#include "graph/node/value.hpp"

#include <cstddef>
#include <span>
#include <type_traits>

namespace tactus {

enum class InputKind : std::uint8_t {
    value,   ///< one value, constant within a call
    stream,  ///< one value per activation: signals and ramps
    batch,   ///< every value since the last call
    any,     ///< any type, decided by the wire
};

// What every call touches stands last in an input and first in an output and a parameter, and the rest between is small:
// the working part of a node with one input, one output and one parameter fits one cache line (see graph/node/node_memory).

/// What the engine sees of an input.
struct Input {
    const ValueType* type = nullptr;
    const char *about = "", *unit = "";
    InputKind kind = InputKind::value;
    bool is_optional = false;
    bool connected = false;
    ValueKinds takes = kinds::every;  ///< of an input of several types
    // A batch: `count` values at `data`, taken at logical times `times`.
    int count = 0;
    const Flicks* times = nullptr;
    Flicks period = 0;  ///< logical time between two values of the producer

    const std::byte* data = nullptr;  ///< first value of this call
    std::ptrdiff_t stride = 0;  ///< bytes from one activation to the next, 0 when constant
};

/// What the engine sees of an output.
struct Output {
    std::byte* data = nullptr;
    std::ptrdiff_t stride = 0;

    const ValueType* type = nullptr;
    const char *about = "", *unit = "";
};

/// An output of snapshots, and what the schedule says about earlier versions.
struct SnapshotOutput : Output {
    std::int64_t oldest_readable = 0;  ///< versions before this are read no more
    bool last_was_dropped = false;  ///< nobody took the last one
};

/// An input. In a call of several activations the value is constant: the engine cuts calls where it changes.
template <class T>
struct In : Input {
    In(const char* about_ = "", const char* unit_ = "") {
        type = &value_type<T>();
        kind = std::is_same_v<T, Signal> || std::is_same_v<T, Ramp> ? InputKind::stream : InputKind::value;
        about = about_;
        unit = unit_;
    }
    In(Optional, const char* about_ = "", const char* unit_ = "") : In(about_, unit_) { is_optional = true; }

    const Element<T>& get() const { return *reinterpret_cast<const Element<T>*>(data); }
    operator const Element<T>&() const { return get(); }
    const Element<T>* operator->() const { return &get(); }
    /// Value of the i-th activation of this call. The samples of a signal are always adjacent.
    const Element<T>& operator[](int i) const {
        if constexpr (std::is_same_v<T, Signal>) return reinterpret_cast<const float*>(data)[i];
        else return *reinterpret_cast<const Element<T>*>(data + i * stride);
    }
};

/// Every value a producer published since the last call, oldest first, with the logical time of each.
template <class T>
struct Batch : Input {
    Batch(const char* about_ = "", const char* unit_ = "") {
        type = &value_type<T>();
        kind = InputKind::batch;
        about = about_;
        unit = unit_;
    }
    Batch(Optional, const char* about_ = "", const char* unit_ = "") : Batch(about_, unit_) { is_optional = true; }
    std::span<const Element<T>> values() const {
        return {reinterpret_cast<const Element<T>*>(data), static_cast<std::size_t>(count)};
    }
    std::span<const Flicks> sample_times() const { return {times, static_cast<std::size_t>(count)}; }
};

/// An input of several types; `type` is that of the wire. In a node with an `AnyOut` all of them have one type.
struct AnyIn : Input {
    AnyIn(const char* about_ = "", ValueKinds takes_ = kinds::every) {
        takes = takes_;
        kind = InputKind::any;
        about = about_;
    }
    AnyIn(Optional, const char* about_ = "", ValueKinds takes_ = kinds::every) : AnyIn(about_, takes_) {
        is_optional = true;
    }

    /// The value of this call, of `type`; the samples of a signal are adjacent.
    template <class T>
    const T* as() const {
        return reinterpret_cast<const T*>(data);
    }
};

/// An output. A node in an audio group writes `out[i]` for every activation of the call; what a signal held before is
/// not there any more.
template <class T>
struct Out : std::conditional_t<SnapshotHandle<T>, SnapshotOutput, Output> {
    Out(const char* about_ = "", const char* unit_ = "") {
        this->type = &value_type<T>();
        this->about = about_;
        this->unit = unit_;
    }
    Element<T>& get() { return *reinterpret_cast<Element<T>*>(this->data); }
    Element<T>& operator[](int i) { return reinterpret_cast<Element<T>*>(this->data)[i]; }
    Out& operator=(const Element<T>& value) {
        get() = value;
        return *this;
    }
};

/// An output of the type that the wires give to the node's `AnyIn` inputs; `type` is known in `prepare`.
struct AnyOut : Output {
    AnyOut(const char* about_ = "") {
        type = &value::undecided;
        about = about_;
    }
    template <class T>
    T* as() {
        return reinterpret_cast<T*>(data);
    }
};

}  // namespace tactus
