// SPDX-License-Identifier: Apache-2.0
// Hands a test every published value of one output.
#pragma once

#include "engine/run/engine.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace tactus::test {

/// For EngineOptions::tap: `see` is given each value of "node.port", in order.
template <class T>
run::TapMaker column_tap(std::string port, std::function<void(const T&)> see) {
    struct ColumnSink : io::Sink {
        ColumnSink(std::size_t offset_, std::size_t bytes_, std::function<void(const T&)> see_)
            : offset(offset_), bytes(bytes_), see(std::move(see_)) {}
        void take(std::int64_t, const std::byte* frames, std::size_t count) override {
            for (std::size_t i = 0; i < count; ++i) see(*reinterpret_cast<const T*>(frames + i * bytes + offset));
        }
        void finish() override {}
        std::size_t offset, bytes;
        std::function<void(const T&)> see;
    };
    return [port = std::move(port), see = std::move(see)](const io::FrameLayout& layout,
                                                          const run::GroupRuntime&) -> std::unique_ptr<io::Sink> {
        const auto column = std::ranges::find(layout.columns, port, &io::FrameColumn::port);
        if (column == layout.columns.end()) return nullptr;
        return std::make_unique<ColumnSink>(column->offset, layout.bytes, see);
    };
}

}  // namespace tactus::test
