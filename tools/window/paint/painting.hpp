// SPDX-License-Identifier: Apache-2.0
// What is painted on a scan: labels with strokes, their history, and their file. No user interface.
#pragma once

#include "assets/segmentation/seeds_file.hpp"

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::window {

/// The file is written after every finished edit, whole or not at all, so that a program that is killed loses at most
/// the stroke that is being drawn. It is the file that `tactus segment --seeds` takes, once two labels have strokes.
class Painting {
public:
    using Labels = std::vector<segmentation::SeedLabel>;
    using Touches = std::function<bool(const segmentation::Stroke&)>;

    /// Continues a file that exists; otherwise begins with two labels without strokes. `touches`: whether a stroke meets
    /// bone; others are refused, because the file would be. Throws Error for a file that cannot be read.
    Painting(std::filesystem::path file, Touches touches);

    const Labels& labels() const { return labels_; }
    const std::filesystem::path& file() const { return file_; }
    /// Increases with every finished edit.
    int version() const { return version_; }
    /// Why the last edit could not be made or kept; empty: it was.
    const std::string& problem() const { return problem_; }
    /// How often there was a problem.
    int problems() const { return problems_; }
    /// Whether the file holds every finished edit.
    bool is_kept() const { return is_kept_; }
    /// Tries again to write the file. Returns is_kept().
    bool save();

    std::size_t active = 0;  ///< the label that is painted

    /// A stroke of the active label: begins, follows the brush, and ends. `end` is false when it meets no bone; nothing has
    /// changed then. m.
    void begin(double radius, const Vec3& point, bool erases = false);
    /// A place that the file cannot hold ends the stroke without a change.
    void extend(const Vec3& point);
    bool end();
    void cancel() { is_open_ = false; }
    bool is_open() const { return is_open_; }
    bool is_erasing() const { return is_open_ && erases_; }
    const segmentation::Stroke& open_stroke() const { return open_; }

    /// A whole stroke of another hand; false when it meets no bone. A stroke that is open stays open.
    bool paint(std::size_t label, const segmentation::Stroke& stroke);
    /// Takes away what the eraser meets of this label alone. False: there is nothing of it.
    bool erase_of(std::size_t label, const segmentation::Stroke& eraser);

    /// A label with a colour that no other has; it becomes active. `name` empty: one that is free. False: there are too
    /// many, or as rename().
    bool add_label(const std::string& name = "");
    bool remove_label(std::size_t label);
    /// The strokes of `label` become those of `into`, which keeps its name and colour. False: they are one, or not there.
    bool merge(std::size_t label, std::size_t into);
    /// False for names that the file cannot hold, or that another label has.
    bool rename(std::size_t label, const std::string& name);
    void recolour(std::size_t label, const Vec3& colour);

    bool undo();
    bool redo();
    bool can_undo() const { return !before_.empty(); }
    bool can_redo() const { return !after_.empty(); }

    std::size_t labels_with_strokes() const;

private:
    void change(Labels labels);
    void drop_beside_bone(Labels& next) const;
    void refuse(std::string why);
    bool may_be_named(const std::string& name);

    std::filesystem::path file_;
    Touches touches_;
    Labels labels_;
    std::deque<Labels> before_, after_;
    segmentation::Stroke open_;
    bool is_open_ = false, erases_ = false;
    int version_ = 0, problems_ = 0;
    std::string problem_;
    bool is_kept_ = true;
};

}  // namespace tactus::window
