// SPDX-License-Identifier: Apache-2.0
// Ports: the inputs and outputs of a node. Before each call of `process` the engine sets their pointers to the values.
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
    events,  ///< the events since the last activation; any number of wires
    any,     ///< any type, decided by the wire
};

// The members that every call uses are last in an input and first in an output and a parameter. In a node with one
// input, one output and one parameter they fit one cache line (graph/node/node_memory.hpp).

/// The part of an input that the engine uses, independent of its C++ type.
struct Input {
    const ValueType* type = nullptr;
    const char *about = "", *unit = "";
    InputKind kind = InputKind::value;
    bool is_optional : 1 = false;
    bool is_of_world : 1 = false;  ///< see OfWorld
    bool connected = false;
    ValueKinds takes = kinds::every;  ///< accepted types of an input of several types
    int count = 0;                    ///< for a batch: number of values at `data`
    const Flicks* times = nullptr;    ///< for a batch: logical time of each value
    Flicks period = 0;  ///< logical time between two values of the producer

    const std::byte* data = nullptr;  ///< first value of this call
    std::ptrdiff_t stride = 0;  ///< bytes from one activation to the next, 0 when constant
};

/// The part of an output that the engine uses, independent of its C++ type.
struct Output {
    std::byte* data = nullptr;  ///< first value of this call
    std::ptrdiff_t stride = 0;  ///< bytes from one activation to the next

    const ValueType* type = nullptr;
    const char *about = "", *unit = "";
};

/// An output of snapshots. The engine reports which earlier versions may still be read, so that a node can reuse
/// memory.
struct SnapshotOutput : Output {
    std::int64_t oldest_readable = 0;  ///< no reader uses a version before this one
    bool last_was_dropped = false;  ///< the last version was sent to no reader
};

/// An input of one value per call, or of one per activation for Signal and Ramp. The engine splits a call of several
/// activations where a value that is not a stream changes.
template <class T>
struct In : Input {
    In(const char* about_ = "", const char* unit_ = "") {
        type = &value_type<T>();
        kind = std::is_same_v<T, Event>                               ? InputKind::events
               : std::is_same_v<T, Signal> || std::is_same_v<T, Ramp> ? InputKind::stream
                                                                      : InputKind::value;
        about = about_;
        unit = unit_;
    }
    In(Optional, const char* about_ = "", const char* unit_ = "") : In(about_, unit_) { is_optional = true; }
    In(OfWorld, const char* about_ = "", const char* unit_ = "") : In(about_, unit_) { is_of_world = true; }
    In(Optional, OfWorld, const char* about_ = "", const char* unit_ = "") : In(of_world, about_, unit_) {
        is_optional = true;
    }

    const Element<T>& get() const { return *reinterpret_cast<const Element<T>*>(data); }
    operator const Element<T>&() const { return get(); }
    const Element<T>* operator->() const { return &get(); }
    /// For events: those that became visible at this activation, ordered by time, then by the name of their output.
    std::span<const Event> events() const
        requires std::is_same_v<T, Event>
    {
        const auto& list = *reinterpret_cast<const EventList*>(data);
        return {list.events(), static_cast<std::size_t>(list.count)};
    }
    /// For events: the number of further events, which were dropped.
    int lost() const
        requires std::is_same_v<T, Event>
    {
        return reinterpret_cast<const EventList*>(data)->lost;
    }
    /// Value of the i-th activation of this call. The samples of a signal are always adjacent.
    const Element<T>& operator[](int i) const {
        if constexpr (std::is_same_v<T, Signal>) return reinterpret_cast<const float*>(data)[i];
        else return *reinterpret_cast<const Element<T>*>(data + i * stride);
    }
};

/// An input of all values that the producer has published since the last call, oldest first, with the logical time of
/// each.
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

/// An input of several types; its wire sets `type`. In a node with an `AnyOut`, all of these inputs have one type.
struct AnyIn : Input {
    AnyIn(const char* about_ = "", ValueKinds takes_ = kinds::every) {
        takes = takes_;
        kind = InputKind::any;
        about = about_;
    }
    AnyIn(Optional, const char* about_ = "", ValueKinds takes_ = kinds::every) : AnyIn(about_, takes_) {
        is_optional = true;
    }

    /// Returns the value of this call, of `type`; the samples of a signal are adjacent.
    template <class T>
    const T* as() const {
        return reinterpret_cast<const T*>(data);
    }
};

/// An output. It keeps its value until the node writes another one, with two exceptions. For a signal, write `out[i]`
/// for every activation of the call. An output of events is emptied before each call, and the node adds to `out[i]`.
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

/// An output of the type of the node's `AnyIn` inputs; `type` is set before `prepare`.
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
