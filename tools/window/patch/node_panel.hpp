// SPDX-License-Identifier: Apache-2.0
// The parameters of the selected node, and the catalogue of node types.
#pragma once

#include "tools/window/document/parameters.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/files/file_chooser.hpp"
#include "tools/window/widgets/painter.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tactus::window {

class NodePanel {
public:
    explicit NodePanel(Workbench& bench) : bench_(bench) {}

    void draw_parameters(std::string& selected, const Fonts& fonts);
    void draw_catalogue(std::string& selected);
    /// Sets what is being typed or turned, as if its field had been left. `selected` follows a new name of the node.
    void end_typing(std::string& selected);
    bool has_begun_edit() const { return !turning_.empty() || is_renaming_; }

    /// Opens a dialog for a file; the window sets it.
    std::function<void(const std::string& title, FileChooser chooser,
                       std::function<void(const std::filesystem::path&)>)>
        ask_file;
    bool is_read_only = false;
    std::string search;  ///< of the catalogue
    bool wants_catalogue = false;  ///< show the catalogue

private:
    void field(const ParameterField& field, const std::string& node);
    void asset(const ParameterField& field, const std::string& node);
    void draw_device(const PictureNode& node);
    void draw_lane(const std::string& node, const std::string& lane);
    void read_fields(const PictureNode& node);
    /// Why a parameter cannot be set here; empty: it can.
    std::string refusal(const ParameterField& field, const std::string& node) const;
    void quantity(const ParameterField& field, const std::string& node);
    /// Sets what was turned. A value that is refused does not stay in the run.
    void set_turned(const ParameterField& field, const std::string& node);

    Workbench& bench_;
    std::vector<ParameterField> fields_;
    std::string shown_, typed_, renaming_;
    std::int64_t version_ = -1;
    std::string lane_;  ///< where new nodes go; empty: their usual one
    std::string typed_rate_;  ///< of the node
    std::string turning_;  ///< the parameter being dragged or typed, "node.param"
    std::string turned_;  ///< its value so far, as it would be set
    double turned_to_ = 0.0;
    bool is_renaming_ = false;
    std::string device_option_, device_value_;
};

}  // namespace tactus::window
