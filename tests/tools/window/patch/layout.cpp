// SPDX-License-Identifier: Apache-2.0
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tools/window/document/parameters.hpp"
#include "tools/window/document/patch_change.hpp"
#include "tools/window/document/patch_picture.hpp"
#include "tools/window/signal/axis.hpp"
#include "tools/window/signal/plot.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using namespace tactus::window;
using tactus::test::touch;

namespace {

compile::Schedule plan_of_text(const std::string& text) {
    patch::Problems problems;
    std::optional<compile::Schedule> plan =
        compile::compile(patch::read_patch(text, "p.toml", problems), nodes::catalogue(), problems);
    for (const Error& error : problems.list) FAIL(error.what());
    return std::move(*plan);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("what lies under the mouse stays there while it zooms, and all fits in the window") {
    Canvas canvas;
    canvas.fit({-50, -20, 950, 480}, 400, 300);
    for (const Point corner : {Point{-50, -20}, Point{950, 480}}) {
        const Point pixel = canvas.to_pixel(corner);
        CHECK((pixel.x >= 0.0 && pixel.x <= 400.0 && pixel.y >= 0.0 && pixel.y <= 300.0));
    }
    const Point mouse{123.0, 45.0}, under = canvas.to_world(mouse);
    for (int i = 0; i < 60; ++i) canvas.zoom_at(mouse, i % 7 == 0 ? 0.5 : 1.3);
    CHECK(canvas.to_world(mouse).x == Approx(under.x));
    CHECK(canvas.to_world(mouse).y == Approx(under.y));
    CHECK(canvas.zoom <= Canvas::max_zoom);
}

TEST_CASE("ticks are round, within the range and never too many, at any scale") {
    for (int e = -12; e <= 12; ++e)
        for (const double offset : {0.0, 1.0, -3.7}) {
            const double size = std::pow(10.0, e);
            const Range range{offset * size, (offset + 2.3) * size};
            const auto ticks = linear_ticks(range, 8);
            REQUIRE(ticks.size() >= 2);
            CHECK(ticks.size() <= 8);
            for (const double tick : ticks) {
                CHECK(tick >= range.low - 1e-6 * size);
                CHECK(tick <= range.high + 1e-6 * size);
            }
            CHECK(tick_label(ticks[0], ticks[1] - ticks[0]) != tick_label(ticks[1], ticks[1] - ticks[0]));
        }
    CHECK(linear_ticks({1.0, 1.0}, 8).empty());
    CHECK(linear_ticks({0.0, std::nan("")}, 8).empty());
    CHECK(linear_ticks({1e18, 1e18 + 1.0}, 8).size() <= 8);
    CHECK(decade_ticks({10.0, 1000.0}, 20) == std::vector<double>{10, 20, 50, 100, 200, 500, 1000});
    CHECK(decade_ticks({10.0, 1000.0}, 4) == std::vector<double>{10, 100, 1000});
    CHECK(decade_ticks({0.0, 1000.0}, 4).empty());
    CHECK(tick_label(0.25, 0.05) == "0.25");
    CHECK(tick_label(1e-17, 0.05) == "0");
}

TEST_CASE("an axis keeps its range while the values still fill it, and follows them when they do not") {
    const Range first = fitted({0.0, 0.0}, {-1.0, 3.0});
    CHECK((first.low < -1.0 && first.high > 3.0));
    CHECK(fitted(first, {-0.9, 2.9}) == first);
    CHECK(fitted(first, {-1.0, 5.0}).high > 5.0);
    CHECK(fitted(first, {0.0, 0.1}).span() < 0.2);
    CHECK(fitted(first, {2.0, 2.0}).span() > 0.0);
    CHECK(fitted({0.0, 0.0}, {0.0, 0.0}).span() > 0.0);
    CHECK(fitted(first, {1.0, -1.0}) == first);
}

TEST_CASE("an envelope keeps a single sample's peak however many samples a pixel has") {
    std::vector<double> times, values;
    for (int i = 0; i < 48000; ++i) {
        times.push_back(i / 48000.0);
        values.push_back(i == 24345 ? 7.0 : std::sin(0.3 * i));
    }
    const Envelope envelope = envelope_of(times, values, {0.0, 1.0}, 100);
    CHECK(*std::ranges::max_element(envelope.high) == 7.0);
    CHECK(std::ranges::max_element(envelope.high) - envelope.high.begin() == 50);
    const Envelope gap = envelope_of(times, values, {0.5, 1.5}, 10);
    CHECK(std::isnan(gap.high[9]));
    CHECK_FALSE(std::isnan(gap.high[0]));
}

TEST_CASE("in the picture of a patch no boxes overlap, lanes hold their nodes, wires end at their ports") {
    const PatchPicture picture = picture_of(plan_of_text(touch));
    REQUIRE(picture.nodes.size() == 6);
    REQUIRE(picture.wires.size() == 4);
    for (std::size_t a = 0; a < picture.nodes.size(); ++a) {
        const PictureNode& node = picture.nodes[a];
        const PictureLane& lane = picture.lanes[static_cast<std::size_t>(node.group)];
        CHECK((node.box.top > lane.top && node.box.bottom < lane.bottom));
        for (std::size_t b = 0; b < a; ++b) CHECK_FALSE(node.box.meets(picture.nodes[b].box));
    }
    // hand, ball and out from left to right
    CHECK(picture.nodes[0].box.right < picture.nodes[1].box.left);
    CHECK(picture.nodes[1].box.right < picture.nodes[2].box.left);
    for (const PictureWire& wire : picture.wires) {
        const Point end = on_curve(wire.way.back(), 1.0);
        const Point port =
            picture.nodes[static_cast<std::size_t>(wire.to)].inputs[static_cast<std::size_t>(wire.input)].at;
        CHECK((end.x == Approx(port.x) && end.y == Approx(port.y)));
        CHECK(wire.crosses == (wire.from == picture.find("level")));
    }
    CHECK(describe(picture.wires[0]) == "same tick");
    CHECK(describe(picture.wires[3]) == "linear, 16.67 ms");
    const auto& inputs = picture.nodes[static_cast<std::size_t>(picture.find("loud"))].inputs;
    const auto driven = std::ranges::find(inputs, "factor", &PicturePort::name);
    REQUIRE(driven != inputs.end());
    CHECK(driven->is_param);
}

TEST_CASE("pointing hits ports before nodes and nodes before wires, and nothing between them") {
    const PatchPicture picture = picture_of(plan_of_text(touch));
    const int ball = picture.find("ball");
    const PictureNode& node = picture.nodes[static_cast<std::size_t>(ball)];
    CHECK(hit(picture, node.inputs[0].at, 5.0) == Hit{Hit::What::input, ball, 0});
    CHECK(hit(picture, node.outputs[0].at, 5.0) == Hit{Hit::What::output, ball, 0});
    CHECK(hit(picture, node.box.middle(), 5.0) == Hit{Hit::What::node, ball, -1});
    CHECK(hit(picture, middle_of(picture.wires[1]), 5.0) == Hit{Hit::What::wire, 1, -1});
    CHECK(hit(picture, {-500.0, -500.0}, 5.0) == Hit{});
}

TEST_CASE("a patch of 10 000 nodes has its picture at once, and a window shows few of them") {
    std::string text = "wires = [\n";
    for (int i = 1; i < 10000; ++i)
        if (i % 40 != 0) text += fmt::format("\"n{}.out -> n{}.in\",\n", i - 1, i);
    for (int i = 0; i < 10000; i += 40) text += fmt::format("\"s.signal -> n{}.in\",\n", i);
    text += "]\n[nodes.s]\ntype = \"sine\"\nrate = \"48 kHz\"\n";
    for (int i = 0; i < 10000; ++i) text += fmt::format("[nodes.n{}]\ntype = \"gain\"\nrate = \"48 kHz\"\n", i);
    const PatchPicture picture = picture_of(plan_of_text(text));
    REQUIRE(picture.nodes.size() == 10001);
    Canvas canvas;
    canvas.zoom = 1.0;
    const Box visible = canvas.visible(1600, 1000);
    CHECK(std::ranges::count_if(picture.nodes, [&](const auto& n) { return n.box.meets(visible); }) < 200);
    canvas.fit(picture.bounds, 1600, 1000);
    CHECK(canvas.visible(1600, 1000).width() >= picture.bounds.width());
}

TEST_CASE("what is wider than a slider resolves is dragged, by shares of its value") {
    ParameterField field;
    field.least = -1e12;
    field.most = 1e12;
    REQUIRE(drag_speed(field));
    // From 0 to 1 in the width of a slider; and a thousand times as fast at a thousand times the value.
    CHECK(200.0 * *drag_speed(field) == Approx(1.0));
    field.value = -2500.0;
    CHECK(200.0 * *drag_speed(field) == Approx(2500.0));
    field.least = 0.01;
    field.most = 50.0;
    field.value = 20.0;
    CHECK_FALSE(drag_speed(field));
    field.least = -60.0;
    CHECK_FALSE(drag_speed(field));
}

TEST_CASE("a form shows every parameter with range, unit and default, and says which can be turned") {
    const compile::Schedule plan = plan_of_text(touch);
    const auto fields = parameters_of(plan, 1);
    const auto stiffness = std::ranges::find(fields, "stiffness", &ParameterField::name);
    REQUIRE(stiffness != fields.end());
    CHECK(stiffness->value == Approx(0.5));
    CHECK(stiffness->unit == "N/mm");
    CHECK(stiffness->is_set);
    CHECK(stiffness->is_live);
    CHECK(stiffness->least < stiffness->most);
    const auto gain = parameters_of(plan, 4);
    const auto factor = std::ranges::find(gain, "factor", &ParameterField::name);
    REQUIRE(factor != gain.end());
    CHECK(factor->is_driven);
    CHECK_FALSE(factor->is_set);
    CHECK(quantity_text(0.8, "N/mm") == "0.8 N/mm");
    CHECK(quantity_text(3.0, "") == "3");
}

TEST_CASE("a parameter that can be turned needs no new plan, all else does") {
    const compile::Schedule before = plan_of_text(touch);
    const auto change = [&](const std::string& text) { return change_between(before, plan_of_text(text)); };
    CHECK_FALSE(change(touch).needs_edit);
    CHECK(change(touch).settings.empty());
    const PatchChange softer = change(replaced(touch, "0.5 N/mm", "0.25 N/mm"));
    CHECK_FALSE(softer.needs_edit);
    CHECK(softer.settings == std::vector<PatchChange::Setting>{{"ball", "stiffness", "0.25 N/mm"}});
    const PatchChange back = change(replaced(touch, "stiffness = \"0.5 N/mm\"\n", ""));
    CHECK_FALSE(back.needs_edit);
    CHECK(back.settings.size() == 1);
    CHECK(change(replaced(touch, " as linear", "")).needs_edit);
    CHECK(change(replaced(touch, "rate = \"60 Hz\"", "rate = \"30 Hz\"")).needs_edit);
    CHECK(change(replaced(touch, "\"level.value -> loud.factor as linear\",\n", "")).needs_edit);
    CHECK(change(touch + "[nodes.more]\ntype = \"constant\"\nrate = \"60 Hz\"\n").needs_edit);
}

TEST_CASE("a tone is a line of its frequency in a scope's spectrum, and a reference is brought to its power") {
    Trace trace;
    trace.names = {"value"};
    trace.columns.resize(1);
    for (int i = 0; i < 48000; ++i) {
        trace.times.push_back(i / 48000.0);
        trace.columns[0].push_back(std::sin(2.0 * std::numbers::pi * 440.0 * i / 48000.0));
    }
    signal::WelchSettings settings;
    signal::Spectrum louder = signal::welch<double>(trace.columns[0], settings);
    for (double& power : louder.power) power *= 100.0;
    const Plot plot = spectrum_plot(trace, 0, {1.0, "V", 1}, 48000.0, 1.0, 1.0, louder);
    REQUIRE(plot.curves.size() == 2);
    CHECK(plot.curves[0].is_reference);
    const auto peak = [](const Curve& curve) { return *std::ranges::max_element(curve.points, {}, &Point::y); };
    CHECK(peak(plot.curves[1]).x == Approx(440.0).margin(6.0));
    CHECK(peak(plot.curves[0]).y == Approx(peak(plot.curves[1]).y).margin(6.0));
    CHECK(plot.value_at(plot.across(440.0)) == Approx(440.0));
    CHECK(plot.y_unit == "dB re (V)²/Hz");

    const Plot wave = time_plot(trace, {1.0, "V", 1}, 1.0, 0.5, 400);
    CHECK(wave.curves[0].points.size() == 800);
    CHECK((wave.y.low < -1.0 && wave.y.high > 1.0 && wave.y.span() < 3.0));
    CHECK(figure_of(plot).svg().find("reference") != std::string::npos);
}
