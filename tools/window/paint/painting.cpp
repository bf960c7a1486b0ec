// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/painting.hpp"

#include "assets/bone/labels.hpp"
#include "assets/segmentation/erase_strokes.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

namespace tactus::window {

using segmentation::SeedLabel;

namespace {

constexpr std::size_t max_remembered = 500, max_points = 100'000;

std::string free_name(const Painting::Labels& labels) {
    for (std::size_t n = 1;; ++n) {
        const std::string name = fmt::format("fragment_{}", n);
        if (std::ranges::none_of(labels, [&](const SeedLabel& l) { return l.name == name; })) return name;
    }
}

/// Colours by place, as `segment` gives them to labels that have none.
Vec3 free_colour(const Painting::Labels& labels) {
    for (int n = 1; n <= 24; ++n) {
        const Vec3 colour = bone::label_colour(n);
        if (std::ranges::none_of(
                labels, [&](const SeedLabel& l) { return l.colour && glm::length(*l.colour - colour) < 0.02; }))
            return colour;
    }
    return bone::label_colour(static_cast<int>(labels.size()) + 1);
}

}  // namespace

Painting::Painting(std::filesystem::path file, Touches touches) : file_(std::move(file)), touches_(std::move(touches)) {
    if (std::filesystem::exists(file_)) labels_ = segmentation::read_seeds(file_, segmentation::SeedsUse::draft);
    for (SeedLabel& label : labels_)
        if (!label.colour) label.colour = free_colour(labels_);
    while (labels_.size() < 2) labels_.push_back({free_name(labels_), free_colour(labels_), {}});
}

void Painting::begin(double radius, const Vec3& point, bool erases) {
    const double filed = segmentation::as_filed(Vec3(radius)).x;
    is_open_ = filed > 0.0 && filed <= segmentation::widest_brush && segmentation::is_seed_place(point);
    if (!is_open_) return refuse("a stroke needs places within 100 m, and a brush of at most 100 mm");
    open_ = {filed, {segmentation::as_filed(point)}};
    erases_ = erases;
}

void Painting::extend(const Vec3& point) {
    if (!is_open_ || open_.points.size() >= max_points) return;
    if (!segmentation::is_seed_place(point)) {
        is_open_ = false;
        return refuse("a stroke needs places within 100 m");
    }
    if (!segmentation::is_apart(open_.points.back(), open_.radius, point)) return;
    open_.points.push_back(segmentation::as_filed(point));
}

bool Painting::end() {
    if (!std::exchange(is_open_, false)) return false;
    if (!erases_) return paint(active, open_);
    problem_.clear();
    Labels next = labels_;
    if (!segmentation::erase_strokes(next, open_)) {
        refuse("there is no stroke at that place: nothing was erased");
        return false;
    }
    drop_beside_bone(next);
    change(std::move(next));
    return true;
}

bool Painting::paint(std::size_t label, const segmentation::Stroke& stroke) {
    problem_.clear();
    if (label >= labels_.size()) return false;
    if (!touches_(stroke)) {
        refuse("there is no bone at that place: nothing was painted");
        return false;
    }
    Labels next = labels_;
    next[label].strokes.push_back(stroke);
    change(std::move(next));
    return true;
}

bool Painting::erase_of(std::size_t label, const segmentation::Stroke& eraser) {
    if (label >= labels_.size()) return false;
    Labels one{labels_[label]};
    if (!segmentation::erase_strokes(one, eraser)) return false;
    Labels next = labels_;
    next[label] = std::move(one.front());
    drop_beside_bone(next);
    change(std::move(next));
    return true;
}

/// What is left of a stroke beside the bone would make the file one that is refused.
void Painting::drop_beside_bone(Labels& next) const {
    for (std::size_t l = 0; l < next.size(); ++l)
        std::erase_if(next[l].strokes, [&](const segmentation::Stroke& stroke) {
            const auto is_same = [&](const segmentation::Stroke& old) { return old.points == stroke.points; };
            return std::ranges::none_of(labels_[l].strokes, is_same) && !touches_(stroke);
        });
}

bool Painting::add_label(const std::string& name) {
    if (labels_.size() >= segmentation::max_labels) {
        refuse(fmt::format("at most {} labels", segmentation::max_labels));
        return false;
    }
    if (!name.empty() && !may_be_named(name)) return false;
    Labels next = labels_;
    next.push_back({name.empty() ? free_name(labels_) : name, free_colour(labels_), {}});
    change(std::move(next));
    active = labels_.size() - 1;
    return true;
}

bool Painting::remove_label(std::size_t label) {
    if (label >= labels_.size()) return false;
    if (labels_.size() < 2) {
        refuse("the last label stays");
        return false;
    }
    Labels next = labels_;
    next.erase(next.begin() + static_cast<std::ptrdiff_t>(label));
    change(std::move(next));
    if (active > label) --active;
    active = std::min(active, labels_.size() - 1);
    return true;
}

bool Painting::merge(std::size_t label, std::size_t into) {
    if (label >= labels_.size() || into >= labels_.size() || label == into) {
        refuse("a fragment is merged into another one");
        return false;
    }
    Labels next = labels_;
    std::ranges::copy(labels_[label].strokes, std::back_inserter(next[into].strokes));
    next.erase(next.begin() + static_cast<std::ptrdiff_t>(label));
    change(std::move(next));
    active = into > label ? into - 1 : into;
    return true;
}

bool Painting::rename(std::size_t label, const std::string& name) {
    if (label >= labels_.size() || labels_[label].name == name) return false;
    if (!may_be_named(name)) return false;
    Labels next = labels_;
    next[label].name = name;
    change(std::move(next));
    return true;
}

bool Painting::may_be_named(const std::string& name) {
    if (!segmentation::is_label_name(name)) refuse("a name is one line of 1 to 200 bytes of UTF-8");
    else if (std::ranges::any_of(labels_, [&](const SeedLabel& l) { return l.name == name; }))
        refuse(fmt::format("another label is named '{}'", name));
    else return true;
    return false;
}

void Painting::recolour(std::size_t label, const Vec3& colour) {
    if (label >= labels_.size()) return;
    Labels next = labels_;
    next[label].colour = colour;
    change(std::move(next));
}

bool Painting::undo() {
    if (before_.empty()) return false;
    is_open_ = false;
    after_.push_back(std::exchange(labels_, std::move(before_.back())));
    before_.pop_back();
    active = std::min(active, labels_.size() - 1);
    ++version_;
    save();
    return true;
}

bool Painting::redo() {
    if (after_.empty()) return false;
    is_open_ = false;
    before_.push_back(std::exchange(labels_, std::move(after_.back())));
    after_.pop_back();
    active = std::min(active, labels_.size() - 1);
    ++version_;
    save();
    return true;
}

std::size_t Painting::labels_with_strokes() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(labels_, [](const SeedLabel& label) { return !label.strokes.empty(); }));
}

void Painting::change(Labels labels) {
    before_.push_back(std::exchange(labels_, std::move(labels)));
    if (before_.size() > max_remembered) before_.pop_front();
    after_.clear();
    problem_.clear();
    ++version_;
    save();
}

void Painting::refuse(std::string why) {
    problem_ = std::move(why);
    ++problems_;
}

/// What cannot be written stays in the window, and is written with the next edit.
bool Painting::save() {
    is_kept_ = false;
    try {
        segmentation::write_seeds(labels_, file_);
        is_kept_ = true;
    } catch (const std::exception& error) {
        refuse(error.what());
    }
    return is_kept_;
}

}  // namespace tactus::window
